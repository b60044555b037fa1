#include "scene/scene.hpp"

namespace oval4d::scene {

void fill(const geometry::Polytope& polytope, const geometry::SliceSet& slices, Scene& scene) {
    if (polytope.convex || !scene.look.parts.faces) {
        scene.fill.clear();
    } else {
        scene.filler.fill(slices, polytope.circumradius, scene.fill);
    }
}

}  // namespace oval4d::scene
