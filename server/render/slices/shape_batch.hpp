#pragma once
// Converts balls, bars and faces to triangles in one vertex format, so that one shader draws them in one call and in
// any order.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/projection.hpp"
#include "render/shader_program.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// A vertex of a shape. Every shape is drawn as a flat patch (an impostor) with coordinates (u, v). The normal at (u,
/// v) is X·u + Y·v + Z·sqrt(1 − u² − v²) for three unit vectors X, Y and Z:
/// - ball: the patch is the unit disk in (u, v), and Z points to the eye;
/// - bar: u runs across the bar from −1 to 1, and v = 0;
/// - face: u = v = 0, so the normal is Z everywhere.
/// The vertices hold the dot products of X, Y and Z with the light direction L and the half vector H, so the shader
/// need not compute normals.
struct ShapeVertex {
    glm::vec3 clip;       ///< clip coordinates x, y, w
    glm::vec3 place;      ///< u, v and r/2, for the radius r in pixels; coverage = (1 − u² − v²) · r/2 + ½
    glm::vec3 diffuse;    ///< X·L, Y·L, Z·L, times the diffuse intensity
    glm::vec3 specular;   ///< X·H, Y·H, Z·H
    std::uint32_t color;  ///< as returned by rgba()
};

/// A list of shapes, converted to triangles. The caller adds them in drawing order. Positions and radii are in view
/// coordinates (see Projection); opacities are from 0 to 1.
class ShapeBatch {
  public:
    /// Starts an empty list of shapes, lit as `style` specifies.
    void begin(const scene::Style& style);

    /// Removes all shapes.
    void clear();

    /// Sets the projection for the shapes that are added from now on.
    void setProjection(const Projection& projection) { projection_ = projection; }

    /// Adds a ball. Does nothing if it contains the eye, is behind the eye, or is almost transparent.
    void addBall(const glm::vec3& center, float radius, scene::Color color, float opacity = 1);

    /// Adds a cylinder. `from` must be the end that is farther from the eye. The cylinder has a round foot at `from`,
    /// which joins it to the ball at this end, and is flat at `to`.
    void addBar(const glm::vec3& from, const glm::vec3& to, float radius, scene::Color color, float opacity = 1);

    /// Adds a flat convex polygon. `normal` is its unit normal, with either sign. `soft`: whether its edges are
    /// antialiased over one pixel; this is necessary if no bars cover the edges.
    void addFace(std::span<const glm::vec3> corners, const glm::vec3& normal, scene::Color color, float opacity,
                 bool soft);

    const Projection& projection() const { return projection_; }
    std::span<const ShapeVertex> vertices() const { return vertices_; }
    std::span<const std::uint32_t> indices() const { return indices_; }

  private:
    void quad(const std::array<glm::vec3, 4>& corners, float u, float v, ShapeVertex vertex);
    void soften(std::uint32_t first, std::uint32_t count);

    Projection projection_;
    glm::vec3 light_{0}, half_{0};
    float diffuse_ = 0;
    std::vector<ShapeVertex> vertices_;
    std::vector<std::uint32_t> indices_;
    std::vector<glm::vec2> pixels_;
};

/// A range of distances from the eye along the view axis, in view coordinates.
struct DepthRange {
    float from = 1, to = 2;
};

/// The shader program that draws a ShapeBatch, lit as `style` specifies.
class ShapeProgram {
  public:
    /// The depths that are written to the depth buffer.
    enum class DepthSource : std::uint8_t {
        patch,    ///< the depth of the flat patch
        surface,  ///< the depth of the ball or bar that the patch represents; faces are one pixel closer to the eye
    };
    ShapeProgram(const scene::Style& style, DepthSource depth);

    /// Draws the shapes in order. The depth test must be off, because all shapes get the same depth.
    void draw(const ShapeBatch& shapes);

    /// Draws the shapes in order with their depths. The depth buffer covers `range`, which must contain all shapes.
    void drawWithDepth(DepthRange range, const ShapeBatch& shapes);

  private:
    void draw(const ShapeBatch& shapes, float scale, float offset);

    ShaderProgram program_;
    GLint toDepth_;
};

}  // namespace oval4d::render
