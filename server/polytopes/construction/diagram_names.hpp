#pragma once
// Texts that stand for Coxeter–Dynkin diagrams: diagrams in linear notation, Schläfli symbols, and names of operations
// on regular polychora, such as "truncated tesseract".

#include <string>
#include <vector>

#include "polytopes/construction/diagram.hpp"

namespace oval4d::polytopes {

/// Returns the names that describe the diagram's polytope as an operation on a convex regular polychoron, such as
/// "truncated tesseract", "truncated 8-cell" or "bitruncated 16-cell". Returns an empty list if there are none.
std::vector<std::string> operationNames(const CoxeterDiagram& diagram);

}  // namespace oval4d::polytopes
