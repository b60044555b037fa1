#pragma once
// Draws scenes (complete descriptions of pictures) into memory. In pictures without fog, some parts are drawn without
// OpenGL if the processor has AVX2 and FMA: the slices, the projection of the whole object, the axes symbol, and the
// marks of a highlighted element in the parallel coordinates. Everything else is drawn with OSMesa (OpenGL in memory).

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "image/image.hpp"
#include "parallel/fork_join.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// Returns the path of the default font file. This is the value of the environment variable OVAL4D_FONT or, if the
/// variable is unset or empty, the path that was set at build time.
std::string defaultFontPath();

/// The way in which the slices, the projection of the whole object and the axes symbol are drawn. In pictures with fog,
/// and in pictures narrower than ShapeRasterizer::kMinWidth, they are always drawn with OpenGL.
enum class ShapeBackend : std::uint8_t {
    fastest,  ///< draw with a ShapeRasterizer if this processor has AVX2 and FMA, else with OpenGL
    open_gl,  ///< always draw with OpenGL
};

/// Draws scenes with its own GL context. Only the thread that created a renderer may use and destroy it. Several
/// renderers may exist in one process, each on its own thread. However, only one of them draws at a time; the others
/// wait.
class Renderer {
  public:
    /// Creates the GL context and compiles all shaders. `font` is the path of a font file in any format that FreeType
    /// reads. If `forkJoin` is not null, two threads draw the shapes that are drawn without OpenGL; `forkJoin` must
    /// outlive this object. However, only one thread draws if the environment variable LP_NUM_THREADS (the number of
    /// threads of llvmpipe, Mesa's rasterizer) is 0 or 1. Throws std::runtime_error if no context can be created, a
    /// shader does not compile, or the font cannot be read.
    explicit Renderer(const std::string& font = defaultFontPath(), ShapeBackend drawing = ShapeBackend::fastest,
                      parallel::ForkJoin* forkJoin = nullptr);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Draws the scene into `pixels`, which have the layout of image::Image. Throws std::invalid_argument if `pixels`
    /// does not have the size of the viewport of the scene, and std::runtime_error if the driver does not support
    /// pictures of this size.
    void draw(const scene::Scene& scene, std::span<std::uint8_t> pixels);

    /// Draws the scene into `out`, which is resized to the viewport of the scene. Throws std::runtime_error if the
    /// driver does not support pictures of this size.
    void draw(const scene::Scene& scene, image::Image& out);

    /// Frees the memory that is kept for the next picture. Keeps the GL context, the shader programs, the glyphs and
    /// the textures.
    void freeMemory();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace oval4d::render
