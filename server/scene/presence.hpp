#pragma once
// Which elements of a polytope are seen where kinds of its cells are hidden or faded.

#include "scene/scene.hpp"

namespace oval4d::scene {

/// Finds the presence of all elements; `out` is overwritten. Kinds that the polytope does not have count for nothing.
void findPresences(const geometry::Polytope& polytope, const Kinds& kinds, Presences& out);

}  // namespace oval4d::scene
