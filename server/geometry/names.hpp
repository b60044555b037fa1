#pragma once
// Polytopes by what they are called, beyond the list of the catalogue: operations on regular ones, products, prisms,
// and the notations of Coxeter and Schläfli.

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "geometry/design.hpp"

namespace oval4d::geometry {

/// The design that a text describes:
/// - a diagram, "x5o3o3x", "x3o3o *b3o", "x5o x7o", snub prisms as "s4s3s x"; a Schläfli symbol, "{5,5/2,5}",
/// "t0,1{3,3,5}";
/// - an operation on a regular polychoron: "omnitruncated 120-cell", "rectified hexacosichoron";
/// - "5,7-duoprism", "5-7 duoprism", "triangular-square duoprism", "pentagonal duoprism" (twice the same);
/// - "pentagonal antiprism prism", "6-gonal prism prism", "snub cube prism", "truncated cubic prism".
/// Case does not matter, nor whether blanks or hyphens stand between words.
std::variant<Design, NameError> describedBy(std::string_view text);

/// What a diagram of the regular groups is called as operations on regular polychora: "truncated tesseract",
/// "truncated 8-cell", "bitruncated 16-cell" …
std::vector<std::string> operationNames(const Diagram& diagram);

}  // namespace oval4d::geometry
