#pragma once
// Converts balls, bars, faces and strokes to flat patches with one vertex format, so that one shader draws all of them
// in one call and in any order.

#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/projection.hpp"
#include "render/shader_program.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// A vertex of a shape. Every shape is drawn as flat patches (impostors) with coordinates (u, v). The normal at (u, v)
/// is X·u + Y·v + Z·sqrt(1 − u² − v²) for three unit vectors X, Y and Z:
/// - ball: the patch covers the unit disk of (u, v), and Z points to the eye;
/// - bar: u runs across the bar from −1 to 1, and v = 0;
/// - face: u = v = 0, so the normal is Z everywhere.
/// The vertices hold the dot products of X, Y and Z with the direction L to the light, and with the half vector H,
/// which points halfway between L and the direction to the eye. So the shader need not compute normals.
struct ShapeVertex {
    glm::vec3 clip;  ///< the clip coordinates x, y and, in clip.z, w
    /// u, v and r/2, where r is the radius of the shape in pixels. The shape covers the fraction (1 − u² − v²) · r/2 +
    /// ½ of the pixel, clamped to 0 … 1. A face has ½ instead of r/2, so that it covers whole pixels. At the outer edge
    /// of its soft rim, it has −½, so that it covers nothing. A stroke has half its width at its axis, and −½ at its
    /// outer edges.
    glm::vec3 place;
    glm::vec3 diffuse;    ///< the dot products X·L, Y·L and Z·L, times the diffuse intensity
    glm::vec3 specular;   ///< the dot products X·H, Y·H and Z·H
    std::uint32_t color;  ///< the color, as returned by rgba()
};

/// The distance of the near clipping plane from the eye, in view coordinates.
inline constexpr float kNearPlane = 1e-3F;

/// A flat convex polygon that represents a shape or a part of a shape. Its vertices follow one another in the batch.
/// They differ only in ShapeVertex::clip and, depending on the form, in a part of ShapeVertex::place.
struct Patch {
    /// The form of the patch, and the parts of ShapeVertex::place in which its vertices differ.
    enum class Form : std::uint8_t {
        face,   ///< a face; no part of ShapeVertex::place differs
        rim,    ///< a part of the soft edge of a face, or one side of a stroke; place.z differs
        strip,  ///< a bar without its foot (see ShapeBatch::addBarFromFarEnd()); place.x differs, and place.y is 0
        disk,   ///< a ball, or the foot of a bar; place.x and place.y differ
    };
    std::uint32_t first, count;  ///< the index of the patch's first vertex in the batch, and the number of its vertices
    Form form;
    /// The least and the greatest x and y of the vertices in the picture, which extends from −1 to 1. Infinite if a
    /// vertex is closer to the eye than kNearPlane.
    glm::vec2 least, greatest;
};

/// A list of shapes, converted to patches (flat polygons). The caller must add the shapes in drawing order. Positions
/// and radii are in view coordinates (see ViewProjection); opacities are from 0 to 1.
class ShapeBatch {
  public:
    /// Starts an empty list of shapes. The shapes are lit as `style` says.
    void begin(const scene::PictureStyle& style);

    /// Removes all shapes. Keeps the light and the projection.
    void clear();

    /// Sets the projection of the shapes that are added after this call.
    void setProjection(const ViewProjection& projection) { projection_ = projection; }

    /// Adds a ball. Does nothing if the ball is not entirely in front of the eye, or if it is almost transparent.
    void addBall(const glm::vec3& center, float radius, scene::Color color, float opacity = 1);

    /// Adds a bar: a cylinder. `from` must be the end that is farther from the eye. At this end, a bar that is thick
    /// enough has a round foot, which joins the bar to the ball there; the other end is flat. Does nothing if an end is
    /// behind the eye or closer to it than `radius`, if the line through `from` and `to` passes the eye within
    /// `radius`, or if the bar is almost transparent.
    void addBarFromFarEnd(const glm::vec3& from, const glm::vec3& to, float radius, scene::Color color,
                          float opacity = 1);

    /// Adds a flat convex polygon. `normal` is a unit normal; its sign does not matter. If `soft` is true, the edges
    /// are antialiased over one pixel. This is necessary if no bars cover the edges.
    void addFace(std::span<const glm::vec3> corners, const glm::vec3& normal, scene::Color color, float opacity,
                 bool soft);

    /// Adds a stroke: a straight line with flat ends and antialiased sides. The color of a stroke does not depend on
    /// the light. `from`, `to` and `width` are in pixels, counted from the lower left corner of the picture. Of the
    /// projection of this batch, only the size of the picture matters. Does nothing if `from` and `to` are equal.
    void addStroke(glm::vec2 from, glm::vec2 to, float width, scene::Color color, float opacity = 1);

    const ViewProjection& projection() const { return projection_; }
    std::span<const ShapeVertex> vertices() const { return vertices_; }
    std::span<const Patch> patches() const { return patches_; }

  private:
    void add(std::initializer_list<ShapeVertex> vertices, Patch::Form form);
    void addPatch(std::uint32_t first, Patch::Form form);
    void antialiasFace(std::uint32_t first, std::uint32_t count);

    ViewProjection projection_;
    glm::vec3 light_{0}, halfVector_{0};
    float ambient_ = 0, diffuse_ = 0;
    std::vector<ShapeVertex> vertices_;
    std::vector<Patch> patches_;
    std::vector<glm::vec2> pixels_;
};

/// A range of distances from the eye along the view axis, in view coordinates.
struct DepthRange {
    float from = 1, to = 2;

    /// Returns (a, b) such that the depth of a point at the distance d is a + b / d, from −1 at `from` to 1 at `to`. On
    /// every plane in space, this depth is a linear function of the position in the picture.
    glm::vec2 toDepth() const {
        const float b = 2 / (1 / to - 1 / from);
        return {1 - b / to, b};
    }
};

/// The shader program that draws a ShapeBatch. The shapes are lit as the style says.
class ShapeProgram {
  public:
    /// The depths that drawWithDepth() writes to the depth buffer.
    enum class DepthSource : std::uint8_t {
        patch,  ///< the depth of the flat patch
        /// The depth of the ball or bar that the patch (a flat polygon) represents. A face counts as closer to the eye
        /// by the size of a pixel.
        surface,
    };
    ShapeProgram(const scene::PictureStyle& style, DepthSource depth);

    /// Draws the shapes in their order. The depth test must be disabled, because all shapes get the same depth.
    void draw(const ShapeBatch& shapes);

    /// Draws the shapes in their order, with their depths. The depth test must be enabled. The depth buffer covers
    /// `range`, which must contain the depths of all shapes.
    void drawWithDepth(DepthRange range, const ShapeBatch& shapes);

  private:
    void draw(const ShapeBatch& shapes, float scale, float offset);

    ShaderProgram program_;
    GLint toDepth_;
    std::vector<std::uint32_t> indices_;
};

}  // namespace oval4d::render
