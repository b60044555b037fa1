#pragma once
// Prisms over polyhedra.

#include <string>

#include "polytopes/construction/snub.hpp"
#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// Builds the prism of height 2 over any polyhedron, with its two bases in the hyperplanes w = ±1. The two bases have
/// one cell type; the other cells have one type for each orbit of faces of `base`.
Polytope prismOver(std::string name, const SnubPolyhedron& base);

}  // namespace oval4d::polytopes
