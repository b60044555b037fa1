#pragma once
// Names of polytopes beyond the catalogue: operations on regular polychora, products, prisms, and the notations of
// Coxeter and Schläfli.

#include <string>
#include <string_view>
#include <vector>

#include "polytopes/construction/notation.hpp"

namespace oval4d::polytopes {

/// Returns the design that a text describes in one of the notations, which kNotations in names.cpp lists with examples.
/// Ignores case; blanks and hyphens between words are equivalent. `lookup` finds the design for the name of another
/// polytope within the text, as in "dual of rectified 5-cell".
DesignOrError describedBy(std::string_view text, const DesignLookup& lookup);

/// Returns the names that describe the polytope of a diagram as an operation on a convex regular polychoron, such as
/// "truncated tesseract", "truncated 8-cell" or "bitruncated 16-cell"; empty if there are none.
std::vector<std::string> operationNames(const Diagram& diagram);

}  // namespace oval4d::polytopes
