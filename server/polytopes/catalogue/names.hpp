#pragma once
// Parses names of polytopes by rules, even of polytopes that the catalogue does not list. The names are operations on
// regular polychora (`truncated tesseract`), products, prisms, constructions (`hull of X and Y`), Coxeter–Dynkin
// diagrams and Schläfli symbols.

#include <cstddef>
#include <string_view>

#include "polytopes/construction/notations.hpp"

namespace oval4d::polytopes {

/// The maximum number of constructions (such as "dual of", "hull of") in a name.
inline constexpr std::size_t kMaxConstructions = 8;

/// Returns the design that a text describes in one of the notations. Returns an error if the text is in no notation, if
/// it is in a notation but describes no polytope, or if it has more than kMaxConstructions constructions. Ignores case;
/// blanks and hyphens between words are equivalent. Calls `lookup` for the name of another polytope in the text, as in
/// "dual of rectified 5-cell".
PolytopeDesignOrError designDescribedBy(std::string_view text, const DesignLookup& lookup);

}  // namespace oval4d::polytopes
