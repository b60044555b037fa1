#pragma once
// Draws a scene with OSMesa.

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "image/image.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// The default font file for labels: that of the environment variable OVAL4D_FONT, else the one set at build time.
std::string fontFile();

/// Owns a GL context, which is bound to the thread that constructs the renderer. The constructor compiles all shaders,
/// and throws std::runtime_error if no context can be created. Several renderers may live in one process, each on its
/// own thread; they draw one at a time.
class Renderer {
  public:
    /// `font` is a font file in any format that FreeType reads.
    explicit Renderer(const std::string& font = fontFile());
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Draws the scene. Overwrites `pixels`, which have the layout of image::Image and the size of the scene's
    /// viewport.
    void draw(const scene::Scene& scene, std::span<std::uint8_t> pixels);

    /// Draws the scene into `out`, which is resized to the viewport.
    void draw(const scene::Scene& scene, image::Image& out);

    /// Frees the memory kept between pictures, but not the context and its programs.
    void freeMemory();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace oval4d::render
