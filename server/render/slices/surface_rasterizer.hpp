#pragma once
// Draws the triangles of the surfaces of fields into memory, without OpenGL.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/slices/surface_batch.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// The picture to which surfaces are drawn, with the rows that are drawn.
struct SurfaceCanvas {
    int width, height;      ///< the size of the whole picture, in pixels
    int beginRow, endRow;   ///< the rows beginRow … endRow − 1, counted from the bottom, are drawn
    std::uint32_t* pixels;  ///< the whole picture in RGBA, with the bottom row first
    float* nearness;        ///< the depth buffer of the whole picture (see kCoverageBits in depth_buffer.hpp)
};

/// Draws the triangles of a SurfaceBatch on the CPU, as SurfaceProgram (surface_batch.hpp) draws them with OpenGL.
/// Surfaces consist of many triangles with a few pixels each, so setting up the triangles takes most of the time.
/// Therefore eight triangles are set up at once, and triangles are not sorted into bins. Colors, opacities and 1 /
/// depth are interpolated linearly in the picture. Triangles with a common edge have no common pixels and leave no gap.
/// Reuses its memory for the next picture. Requires AVX2 and FMA.
class SurfaceRasterizer {
  public:
    /// The way in which triangles are drawn to the picture and to the depth buffer.
    enum class Blending : std::uint8_t {
        none,  ///< where no solid shape is nearer, the triangle replaces the pixel and its value in the depth buffer
        /// The triangle is blended with the pixel, and the depth buffer does not change. Where a solid shape is nearer,
        /// the triangle changes only the part of the pixel that this shape leaves uncovered.
        alpha,
    };

    /// Projects and lights the vertices of `surfaces`, which must not change until its triangles are drawn. The light
    /// is computed per vertex, as in SurfaceProgram: triangles are so small that the light is almost linear in each of
    /// them.
    void projectAndLight(scene::Viewport viewport, const scene::PictureStyle& style, const SurfaceBatch& surfaces);

    /// Draws triangles one after another, each given by three consecutive indices of vertices. Several threads may draw
    /// different rows at the same time.
    void draw(const SurfaceCanvas& canvas, std::span<const std::uint32_t> indices, Blending blending) const;

    /// Returns an estimate of the mean vertical position of the triangles: 0 is the lower edge of the picture, and 1
    /// the upper edge. Uses only the first corner of every 32nd triangle. Returns 0.5 if no such corner is between the
    /// lower and the upper edge.
    double estimateMeanScreenY(std::span<const std::uint32_t> indices) const;

    /// A projected and lit vertex. It fills one 256-bit register.
    struct alignas(32) LitVertex {
        float nearness;  ///< 1 / (the distance from the eye along the view axis)
        /// The position in pixels from the lower left corner; NaN if the vertex is behind the eye or too close to it.
        float x, y;
        float unused;
        float r, g, b, a;  ///< the lit color, multiplied by alpha, and alpha; all from 0 to 255
    };

  private:
    void drawClippedAtNearPlane(const SurfaceCanvas& canvas, const std::uint32_t* corners, Blending blending) const;

    const SurfaceBatch* surfaces_ = nullptr;
    scene::Viewport viewport_;
    std::vector<LitVertex> points_;  // one lit vertex for each vertex of surfaces_
};

}  // namespace oval4d::render
