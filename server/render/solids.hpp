#pragma once
// Balls, bars and faces as triangles of one kind, so that one shader draws them in one call and in any order.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/lens.hpp"
#include "render/program.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// Every shape is a flat patch with coordinates (u, v) on it; its normal is X·u + Y·v + Z·sqrt(1 − u² − v²).
/// A ball fills the unit disc and Z points to the eye; on a bar v is 0 and u runs across; a face has u = v = 0.
/// Light enters through the axes' products with it, so no normal is ever made.
struct SolidVertex {
    glm::vec3 clip;      ///< x, y, w
    glm::vec3 place;     ///< u, v, and half the radius in pixels: coverage is (1 − u² − v²) times that, plus ½
    glm::vec3 diffuse;   ///< X·L, Y·L, Z·L, times the strength of diffuse light
    glm::vec3 specular;  ///< X·H, Y·H, Z·H
    std::uint32_t colour;
};

/// A list of shapes in view axes. The caller adds them from far to near.
class Solids {
  public:
    /// Starts an empty list of shapes in the light of `style`.
    void begin(const scene::Style& style);

    void clear();

    /// What is added from now on is seen through `lens`.
    void lookThrough(const Lens& lens) { lens_ = lens; }

    void ball(const glm::vec3& centre, float radius, scene::Colour colour, float opacity = 1);

    /// A round bar. It comes out of something at `from`, the end farther from the eye; at `to` it is cut straight.
    void bar(const glm::vec3& from, const glm::vec3& to, float radius, scene::Colour colour, float opacity = 1);

    /// A flat convex polygon with this unit normal, either way. With `soft` the edges fade over a pixel, for where no
    /// bar covers them.
    void face(std::span<const glm::vec3> corners, const glm::vec3& normal, scene::Colour colour, float opacity,
              bool soft);

    const Lens& lens() const { return lens_; }
    std::span<const SolidVertex> vertices() const { return vertices_; }
    std::span<const std::uint32_t> indices() const { return indices_; }

  private:
    void quad(const std::array<glm::vec3, 4>& corners, float u, float v, SolidVertex vertex);
    void soften(std::uint32_t first, std::uint32_t count);

    Lens lens_;
    glm::vec3 light_{0}, half_{0};
    float diffuse_ = 0;
    std::vector<SolidVertex> vertices_;
    std::vector<std::uint32_t> indices_;
    std::vector<glm::vec2> pixels_;
};

/// From the nearest to the farthest, along the view axis.
struct Range {
    float from = 1, to = 2;
};

/// A program that draws Solids, in the light of `style`.
class SolidProgram {
  public:
    /// Whose depth a pixel has: that of the flat patch, or of the ball or bar that the patch stands for (faces stand
    /// out by a pixel then).
    enum class Depth : std::uint8_t { flat, round };
    SolidProgram(const scene::Style& style, Depth depth);

    /// One over the other, in their order, whatever their depths.
    void draw(const Solids& solids);

    /// For a depth buffer, which takes in the depths `range`.
    void drawWithin(Range range, const Solids& solids);

  private:
    void draw(const Solids& solids, float scale, float offset);

    Program program_;
    GLint toDepth_;
};

}  // namespace oval4d::render
