#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "polytopes/construction/recipe.hpp"
#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// Returns the pole of each cell. The pole of a cell is the point p with p · x = 1 for all points x in the cell's
/// hyperplane. Throws std::invalid_argument if the hyperplane of a cell passes through the origin.
std::vector<glm::dvec4> polesOf(const Polytope& polytope);

/// Returns a polytope with the incidences of the dual of `base`. The result has a vertex for each cell of `base`, a
/// 2-face for each edge (the loop of the cells around the edge), and a cell for each vertex. `vertices` holds, for each
/// cell of `base`, the position of the corresponding vertex of the result. Throws InvalidPolytope if these elements do
/// not form a valid polytope.
Polytope dualWithVertices(const Polytope& base, std::string name, std::vector<glm::dvec4> vertices);

/// Returns the diagram of a regular polytope: a chain whose only ringed mirror is the first one, with the branches in
/// the order of the Schläfli symbol. Returns an empty optional for other polytopes.
std::optional<CoxeterDiagram> diagramIfRegular(const PolytopeDesign& design);

}  // namespace oval4d::polytopes
