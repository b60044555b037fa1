#pragma once
// Draws the density strip of the parallel coordinates.

#include "render/shader_program.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// Draws the density strip of a scene as a texture. Its color is interpolated between the colors of adjacent axes.
/// Requires a current GL context throughout its lifetime.
class DensityStrip {
  public:
    DensityStrip();
    ~DensityStrip();
    DensityStrip(const DensityStrip&) = delete;
    DensityStrip& operator=(const DensityStrip&) = delete;

    /// Draws the strip; does nothing if the scene shows none.
    void draw(const scene::Scene& scene);

  private:
    ShaderProgram program_;
    GLuint texture_ = 0;
};

}  // namespace oval4d::render
