#pragma once
// The density strip of the parallel coordinates.

#include "render/program.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// Draws the scene's density, if it has one, as a texture from axis to axis, in colours that pass from the one's to the
/// other's. Needs a current context for all of its life.
class Strip {
  public:
    Strip();
    ~Strip();
    Strip(const Strip&) = delete;
    Strip& operator=(const Strip&) = delete;

    void draw(const scene::Scene& scene);

  private:
    Program program_;
    GLuint texture_ = 0;
};

}  // namespace oval4d::render
