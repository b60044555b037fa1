#pragma once
// The density strip of the parallel coordinates.

#include "render/program.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// Draws the scene's density, if it has one, as a texture whose color is interpolated between the colors of adjacent
/// axes. Requires a current GL context throughout its lifetime.
class DensityStrip {
  public:
    DensityStrip();
    ~DensityStrip();
    DensityStrip(const DensityStrip&) = delete;
    DensityStrip& operator=(const DensityStrip&) = delete;

    void draw(const scene::Scene& scene);

  private:
    Program program_;
    GLuint texture_ = 0;
};

}  // namespace oval4d::render
