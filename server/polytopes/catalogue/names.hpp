#pragma once
// Parses names of polytopes by rules, whether or not the catalogue lists the polytopes: names of operations on regular
// polychora (`truncated tesseract`), of products, of prisms and of constructions (`hull of X and Y`); Coxeter–Dynkin
// diagrams; and Schläfli symbols.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "polytopes/construction/notation.hpp"

namespace oval4d::polytopes {

/// A notation. The first three texts are Markdown, of which tests/lint --fix makes a row of protocol/README.md.
struct NotationRow {
    std::string_view polytopes;  ///< the polytopes with names in the notation: "a duoprism"
    std::string_view examples;   ///< names in backquotes: "`5,7-duoprism`, `5/2,5-duoprism`"
    std::string_view edges;      ///< the lengths of edges; "2" if all edges of all these polytopes have the length 2
    /// The words with which constructions begin, separated by commas. A construction is a name such as "hull of X and
    /// Y".
    std::string_view constructions = {};
    Notation parse;
};

/// Returns all notations, in the order in which describedBy() tries them.
std::span<const NotationRow> notations();

/// The maximum number of constructions in a name.
inline constexpr std::size_t kMaxConstructions = 8;

/// Returns the design that a text describes in one of the notations. Returns an error if the text is in no notation, if
/// it is in a notation but describes no polytope, or if it has more than kMaxConstructions constructions. Ignores case;
/// blanks and hyphens between words are equivalent. Calls `lookup` for the name of another polytope within the text, as
/// in "dual of rectified 5-cell".
DesignOrError describedBy(std::string_view text, const DesignLookup& lookup);

/// Returns the names that describe the polytope of a diagram as an operation on a convex regular polychoron, such as
/// "truncated tesseract", "truncated 8-cell" or "bitruncated 16-cell"; an empty list if there are none.
std::vector<std::string> operationNames(const Diagram& diagram);

}  // namespace oval4d::polytopes
