#pragma once
// Draws a scene with OSMesa.

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "geometry/slice_set.hpp"
#include "render/image.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// The font that labels are set in unless told otherwise: the file that the environment variable OVAL4D_FONT names,
/// else the one that the program was built with.
std::string fontFile();

/// Owns one GL context, which is bound to the thread that made the renderer. Warm after construction: the shaders are
/// compiled. Throws std::runtime_error if no context can be had.
class Renderer {
  public:
    /// `font` is a file of the kinds that FreeType reads.
    explicit Renderer(const std::string& font = fontFile());
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Draws `slices` as `scene` places them. `pixels` is overwritten: as in an Image of the scene's viewport.
    void draw(const geometry::Polytope& polytope, const geometry::SliceSet& slices, const scene::Scene& scene,
              std::span<std::uint8_t> pixels);

    /// The same; `out` is resized.
    void draw(const geometry::Polytope& polytope, const geometry::SliceSet& slices, const scene::Scene& scene,
              Image& out);

    /// Lets go of what is kept from one picture to the next, but the context and its programs.
    void forget();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace oval4d::render
