#include "scene/scene.hpp"

namespace oval4d::scene {

void fill(const geometry::Polytope& polytope, const geometry::SliceSet& slices, Scene& scene, std::size_t steps) {
    if (polytope.convex || !scene.look.parts.faces) {
        scene.fill.clear();
    } else {
        scene.filler.fill(slices, polytope.circumradius, scene.fill, steps);
    }
}

}  // namespace oval4d::scene
