#pragma once
// Names of operations on regular polychora (4-D polytopes), such as "truncated tesseract". The source file also defines
// three notations of notations.hpp: these names, Schläfli symbols, and diagrams in linear notation.

#include <string>
#include <vector>

#include "polytopes/construction/diagram.hpp"

namespace oval4d::polytopes {

/// Returns the names that describe the diagram's polytope as an operation on a convex regular polychoron, such as
/// "truncated tesseract", "truncated 8-cell" or "bitruncated 16-cell". Returns an empty list if there are none.
std::vector<std::string> operationNames(const CoxeterDiagram& diagram);

}  // namespace oval4d::polytopes
