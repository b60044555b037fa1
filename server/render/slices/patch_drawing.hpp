#pragma once
// Draws patches (flat convex polygons that represent shapes) into a picture in memory, eight pixels at a time. Needs a
// processor with AVX2 and FMA.

#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "render/slices/avx2.hpp"
#include "render/slices/shape_batch.hpp"
#include "render/slices/shape_rasterizer.hpp"

namespace oval4d::render {

#if defined(__x86_64__)

/// A vertex of a patch (a flat polygon), projected to the picture.
struct PatchCorner {
    float x, y;       ///< the position, in pixels from the lower left corner
    float nearness;   ///< 1 / (the distance from the eye along the view axis)
    int row;          ///< the first drawn row whose center is not below the vertex, or the end of the drawn rows
    glm::vec3 place;  ///< the same as ShapeVertex::place: u, v and half the radius of the shape
};

/// A range of rows of the picture: begin … end − 1, counted from the bottom.
struct RowRange {
    int begin, end;
};

/// The picture to which patches (flat polygons) are drawn, with the rows that are drawn and the properties of the
/// light.
struct PatchCanvas {
    static constexpr int kLanes = 8;  ///< the number of pixels or rows that are computed at a time

    int width = 0, height = 0;
    RowRange rows{0, 0};              ///< the range of rows that are drawn
    std::uint32_t* pixels = nullptr;  ///< the whole picture in RGBA, with the bottom row first
    float* nearness = nullptr;        ///< the depth buffer of the whole picture (see kCoverageBits in depth_buffer.hpp)
    /// In row y, the current patch covers the pixels left[y] … right[y] − 1. The arrays have kLanes more entries than
    /// there are rows, because rows are computed kLanes at a time.
    int *left = nullptr, *right = nullptr;
    float ambient = 0, gloss = 0;  ///< the intensities of ambient light, 0 … 1, and of specular light, 0 … 255
    unsigned shininess = 1;
    bool opaque = true;  ///< whether the background is opaque; if so, every pixel stays opaque
};

/// Draws a patch of the form `form`, a convex polygon. All vertices must be in front of the eye. `corners` is working
/// memory that must have as many entries as `vertices`. `pixelSize` is the size of a pixel, in view coordinates, at the
/// distance 1 from the eye.
OVAL4D_AVX2 void drawPatch(const PatchCanvas& canvas, std::span<const ShapeVertex> vertices,
                           std::span<PatchCorner> corners, Patch::Form form, ShapeRasterizer::DepthUse depth,
                           float pixelSize);

#endif

}  // namespace oval4d::render
