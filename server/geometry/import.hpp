#pragma once
// Polytopes from files.

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>

#include "geometry/polytope.hpp"

namespace oval4d::geometry {

/// Why a file was refused.
struct ImportError {
    std::size_t line = 0;  ///< counted from 1; 0 where the fault is not in one line
    std::string reason;
    bool tooLarge = false;  ///< it has more vertices than allowed
};

/// Reads 4OFF: "4OFF", then the numbers of vertices, 2-faces, edges and cells, a line x y z w for each vertex, a line
/// "n i …" of vertices for each 2-face and of 2-faces for each cell, counted from 0. The number of edges is not
/// trusted; comments (#) and what follows a record in its line (colours) are passed over; vertices that no 2-face uses
/// are dropped. Coordinates are kept as they are. The 2-faces must be flat and each cell must lie in a hyperplane,
/// within the rounding of a file with three decimals; makePolytope's conditions apply. Memory stays in proportion to
/// the text, whatever counts it claims.
std::variant<Polytope, ImportError> importOff4(std::string_view text, std::string name, std::size_t maxVertices);

}  // namespace oval4d::geometry
