#pragma once
// Names of polytopes that need not be in the catalogue: operations on regular polychora, products, prisms,
// Coxeter–Dynkin diagrams and Schläfli symbols.

#include <string>
#include <string_view>
#include <vector>

#include "polytopes/construction/notation.hpp"

namespace oval4d::polytopes {

/// Returns the design that a text describes in one of the notations; kNotations in names.cpp lists them with examples.
/// Returns an error if the text is in no notation, if it is in a notation but describes no polytope, or if it has more
/// than kMaxConstructions constructions (combination.hpp). Ignores case; blanks and hyphens between words are
/// equivalent. Calls `lookup` for the name of another polytope within the text, as in "dual of rectified 5-cell".
DesignOrError describedBy(std::string_view text, const DesignLookup& lookup);

/// Returns the names that describe the polytope of a diagram as an operation on a convex regular polychoron, such as
/// "truncated tesseract", "truncated 8-cell" or "bitruncated 16-cell"; an empty list if there are none.
std::vector<std::string> operationNames(const Diagram& diagram);

}  // namespace oval4d::polytopes
