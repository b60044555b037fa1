#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec4.hpp>

#include "polytopes/construction/notation.hpp"
#include "polytopes/construction/recipe.hpp"
#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// Parses a text such as "dual of rectified 5-cell". Returns the design of the dual, an error if the rest of the text
/// names no polytope, or std::nullopt if the text does not begin with "dual".
///
/// The dual is the polar reciprocal of the named polytope (Coxeter, Regular Polytopes, §7.5): a vertex v of the dual
/// corresponds to the cell of the polytope in the hyperplane v · x = r², where r² is the circumradius times the least
/// distance of a cell's hyperplane from the center. With this r, the dual has the circumradius of the named polytope.
/// The dual of a dual has the design of the original polytope. The dual of a regular polytope has the design, and
/// therefore the size, of a regular polytope: the dual of the 8-cell is the 16-cell with edge length 2. If the
/// hyperplane of a cell passes through the center, the dual does not exist, and Recipe::build throws
/// std::invalid_argument.
std::optional<DesignOrError> dualNamed(const NameWords& text);

/// Returns the pole of each cell: the point p with p · x = 1 for all points x in the cell's hyperplane. Throws
/// std::invalid_argument if the hyperplane of a cell passes through the origin.
std::vector<glm::dvec4> polesOf(const Polytope& polytope);

/// Returns a polytope with the incidences of the dual of `base`: a vertex for each cell, a 2-face for each edge (the
/// loop of the cells around the edge), and a cell for each vertex. `vertices` holds the position of the new vertex for
/// each cell of `base`. Throws InvalidPolytope if these elements do not form a valid polytope.
Polytope dualWithVertices(const Polytope& base, std::string name, std::vector<glm::dvec4> vertices);

/// Returns the diagram of a regular polytope: a chain whose only ringed mirror is the first one, with the branches in
/// the order of the Schläfli symbol. Returns std::nullopt for other polytopes.
std::optional<Diagram> regularDiagram(const Design& design);

}  // namespace oval4d::polytopes
