#pragma once
// Draws scenes. In pictures without fog, the slices, the projection of the whole object, the axes symbol, and what
// marks a highlighted element in the parallel coordinates are drawn without OpenGL if the processor has AVX2 and FMA;
// everything else is drawn with OSMesa.

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "image/image.hpp"
#include "parallel/fork_join.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// Returns the path of the default font file: the value of the environment variable OVAL4D_FONT or, if that is unset or
/// empty, the path set at build time.
std::string fontFile();

/// How the slices, the projection of the whole object and the axes symbol are drawn. In pictures with fog, or narrower
/// than ShapeRasterizer::kMinWidth, they are always drawn with OpenGL.
enum class ShapeBackend : std::uint8_t {
    fastest,  ///< by a ShapeRasterizer if this processor has AVX2 and FMA, else with OpenGL
    open_gl,  ///< always with OpenGL
};

/// Draws scenes with its own GL context. Only the thread that created a renderer may use and destroy it. Several
/// renderers may exist in one process, each on its own thread, but only one of them draws at a time; the others wait.
class Renderer {
  public:
    /// Creates the context and compiles all shaders. `font` is the path of a font file in any format that FreeType
    /// reads. If `forkJoin` is not null, two threads draw the shapes that are drawn without OpenGL. The values 0 and 1
    /// of the environment variable LP_NUM_THREADS (the number of threads of llvmpipe, the rasterizer of Mesa) forbid
    /// the second thread. `forkJoin` must outlive this object. Throws std::runtime_error if no context can be created,
    /// a shader does not compile, or the font cannot be read.
    explicit Renderer(const std::string& font = fontFile(), ShapeBackend drawing = ShapeBackend::fastest,
                      parallel::ForkJoin* forkJoin = nullptr);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Draws the scene. Overwrites `pixels`, which have the layout of image::Image. Throws std::invalid_argument if
    /// `pixels` does not have the size of the viewport of the scene, and std::runtime_error if the driver does not
    /// support pictures of this size.
    void draw(const scene::Scene& scene, std::span<std::uint8_t> pixels);

    /// Draws the scene to `out`, which is resized to the viewport. Throws std::runtime_error if the driver does not
    /// support pictures of this size.
    void draw(const scene::Scene& scene, image::Image& out);

    /// Frees the memory that is kept for the next picture, except the context, the shader programs, the glyphs and the
    /// textures.
    void freeMemory();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace oval4d::render
