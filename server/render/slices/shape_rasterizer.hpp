#pragma once
// Draws balls, bars, faces and surfaces into memory, without OpenGL.

#include <cstdint>
#include <memory>
#include <span>

#include <glm/vec2.hpp>

#include "parallel/fork_join.hpp"
#include "render/slices/shape_batch.hpp"
#include "render/slices/surface_rasterizer.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// A rectangle of a picture: the columns from.x … to.x − 1 and the rows from.y … to.y − 1, counted from the lower left
/// corner.
struct PixelArea {
    glm::ivec2 from, to;
};

/// Draws the patches of a ShapeBatch (flat polygons that represent shapes) as ShapeProgram draws them, but without
/// OpenGL. Drawing is several times faster than with llvmpipe, Mesa's rasterizer, for two reasons. Each patch is one
/// convex polygon, so that no pixel is shaded twice at the diagonal of a quad. And polygons are not sorted into bins.
/// Draws the surfaces of fields with a SurfaceRasterizer; surfaces and shapes share one depth buffer. Reuses its memory
/// for the next picture.
class ShapeRasterizer {
  public:
    /// The way in which shapes use the depth buffer.
    enum class DepthUse : std::uint8_t {
        unused,  ///< the depth buffer is neither read nor written
        /// The depth buffer is read, not written. A nearer shape that was drawn with `written`, or a nearer opaque
        /// surface, hides the new shape. The new shape then changes only the part of each pixel that the nearer one
        /// leaves uncovered. Faces count as closer to the eye by the size of a pixel.
        tested,
        written,  ///< the depth buffer is read as with `tested`, and written; faces have exactly their own depth
    };
    /// The minimum width of a picture, in pixels.
    static constexpr int kMinWidth = 8;

    /// Returns whether this processor has AVX2 and FMA. If it does not, only isSupported(), the constructor, the
    /// destructor and freeMemory() may be called.
    static bool isSupported();

    ShapeRasterizer();
    ~ShapeRasterizer();
    ShapeRasterizer(const ShapeRasterizer&) = delete;
    ShapeRasterizer& operator=(const ShapeRasterizer&) = delete;

    /// Starts a picture with the background of `style`. The picture will be drawn to `pixels`, which have the layout of
    /// image::Image, multiplied by alpha, and must remain valid until drawAdded() returns. The viewport must be at
    /// least kMinWidth wide.
    void begin(scene::Viewport viewport, const scene::PictureStyle& style, std::span<std::uint8_t> pixels);

    /// Starts a picture like begin(), but draws over the picture that is in `pixels`, instead of the background.
    void beginOverPicture(scene::Viewport viewport, const scene::PictureStyle& style, std::span<std::uint8_t> pixels);

    /// Adds the patches (flat polygons) of `shapes`, which must remain valid and unchanged until drawAdded() returns.
    /// The patches are drawn in their order, after everything that was added before.
    void add(const ShapeBatch& shapes, DepthUse depth);

    /// Adds triangles of surfaces, each given by three indices of vertices. SurfaceRasterizer::projectAndLight() must
    /// have prepared `surfaces` for this picture. `surfaces` and `indices` must remain valid until drawAdded() returns.
    /// The triangles are drawn in their order, after everything that was added before.
    void add(const SurfaceRasterizer& surfaces, std::span<const std::uint32_t> indices,
             SurfaceRasterizer::Blending blending);

    /// Sets the part of the picture in which the depth buffer is used. All surfaces, and all shapes with a DepthUse
    /// other than `unused`, must lie in this part. Must be called after begin(), which makes the part empty.
    void setDepthArea(const PixelArea& area);

    /// Adds a clearing of the depth buffer in the part `area` of the picture, after everything that was added before.
    /// What was added before then hides nothing that is added later.
    void addDepthClearing(const PixelArea& area);

    /// Draws everything that was added. If `forkJoin` is not null, draws the upper and the lower part of the picture in
    /// parallel, on two threads.
    void drawAdded(parallel::ForkJoin* forkJoin);

    /// Frees the memory that is kept for the next picture.
    void freeMemory();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace oval4d::render
