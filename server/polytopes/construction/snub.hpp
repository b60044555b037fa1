#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "geometry/jagged_array.hpp"
#include "polytopes/construction/diagram.hpp"

namespace oval4d::polytopes {

/// A polyhedron whose faces are grouped into orbits of its symmetry group. snubOf() returns a snub polyhedron in this
/// form; prismOver() accepts any polyhedron in this form.
struct PolyhedronWithFaceOrbits {
    std::vector<glm::dvec3> vertices;
    geometry::JaggedArray faces;        ///< the vertex loop of each face
    std::vector<std::uint32_t> orbits;  ///< the orbit of each face; in a snub of {p, q}: 0 for the p-gons, 1 for the
                                        ///< q-gons, 2 for the other triangles
};

/// Builds the snub of {p, q}, with edge length 2: the snub cube for {4, 3}, the snub dodecahedron for {5, 3}, the
/// n-antiprism for {n, 2}. The vertices are the images of one point under the rotation group of {p, q}. The faces are
/// the p-gons and q-gons around the rotation axes (none around a twofold axis), and the triangles between them
/// (Coxeter, Regular Polytopes, §8.6). The caller must ensure that p and q are integers with 1/p + 1/q > 1/2.
PolyhedronWithFaceOrbits snubOf(DiagramBranch p, DiagramBranch q);

}  // namespace oval4d::polytopes
