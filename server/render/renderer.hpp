#pragma once
// Draws a scene with OSMesa.

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "image/image.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// Returns the path of the default font file for labels: the value of the environment variable OVAL4D_FONT or, if that
/// is unset or empty, the path set at build time.
std::string fontFile();

/// Draws scenes in its own GL context. A renderer may be used only by the thread that created it. Several renderers may
/// exist in one process, each on its own thread; they draw one at a time.
class Renderer {
  public:
    /// Compiles all shaders. `font` is the path of a font file in any format that FreeType reads. Throws
    /// std::runtime_error if no context can be created or the font cannot be read.
    explicit Renderer(const std::string& font = fontFile());
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Draws the scene and overwrites `pixels`, which have the layout of image::Image. Throws std::invalid_argument if
    /// `pixels` does not have the size of the scene's viewport, and std::runtime_error if the driver does not support
    /// pictures of this size.
    void draw(const scene::Scene& scene, std::span<std::uint8_t> pixels);

    /// Draws the scene into `out`, which is resized to the viewport.
    void draw(const scene::Scene& scene, image::Image& out);

    /// Frees the memory that is reused from picture to picture, but not the context and the shader programs.
    void freeMemory();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace oval4d::render
