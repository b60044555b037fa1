#pragma once
// Notations, that is, systems of names and symbols for polytopes. This file lists all notations; each is defined in the
// source file of its family of polytopes.

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "polytopes/construction/diagram_text.hpp"
#include "polytopes/construction/recipe.hpp"
#include "text/words.hpp"

namespace oval4d::polytopes {

/// The design that a text denotes, or the reason why it denotes none.
using PolytopeDesignOrError = std::variant<PolytopeDesign, PolytopeNameError>;

/// A function that returns the design that a text in any notation denotes. A notation calls this function if its own
/// text contains the name of another polytope, as in "dual of rectified 5-cell".
using DesignLookup = std::function<PolytopeDesignOrError(std::string_view text)>;

/// A text that may name a polytope, split into at least one lower-case word, and the function that looks up the names
/// of other polytopes in the text. The words and the function must outlive this object.
struct PolytopeNameWords {
    const std::vector<std::string>& words;
    const DesignLookup& lookup;

    /// Returns the words from index `first` on, joined by spaces.
    std::string joinedFrom(std::size_t first) const { return text::joined(words, first, words.size()); }
    /// Returns all words except the last one.
    std::vector<std::string> withoutLast() const { return {words.begin(), words.end() - 1}; }
};

/// A notation for a family of polytopes. `polytopes`, `examples` and `edges` are Markdown texts, from which `tests/lint
/// --fix` makes a row of a table in protocol/README.md.
struct PolytopeNotation {
    std::string_view polytopes;  ///< the polytopes that have names in the notation, such as "a duoprism"
    std::string_view examples;   ///< examples of names in backquotes, such as "`5,7-duoprism`, `5/2,5-duoprism`"
    std::string_view edges;      ///< the lengths of edges; "2" if all edges of all polytopes of the family have the
                                 ///< length 2
    /// The words with which the names of constructions begin, such as "hull" of "hull of X and Y", separated by commas.
    std::string_view constructions = {};
    /// Parses a text. Returns the design, an error if the text is in this notation but denotes no polytope, or an empty
    /// optional if the text is not in this notation.
    std::optional<PolytopeDesignOrError> (*parse)(const PolytopeNameWords& text);
};

extern const PolytopeNotation kDualNotation;                       // defined in dual.cpp
extern const PolytopeNotation kOverPolyhedronNotation;             // defined in over_polyhedra.cpp
extern const PolytopeNotation kTruncationOrRectificationNotation;  // defined in truncation_or_rectification.cpp
extern const PolytopeNotation kCombinationNotation;                // defined in combination.cpp
extern const PolytopeNotation kSchlaefliNotation;                  // defined in diagram_names.cpp
extern const PolytopeNotation kDiagramNotation;                    // defined in diagram_names.cpp
extern const PolytopeNotation kSnubPrismDiagramNotation;           // defined in prism_names.cpp
extern const PolytopeNotation kDuoprismNotation;                   // defined in prism_names.cpp
extern const PolytopeNotation kDuoantiprismNotation;               // defined in duoantiprism.cpp
extern const PolytopeNotation kCyclicPolytopeNotation;             // defined in cyclic_polytope.cpp
extern const PolytopeNotation kPrismNotation;                      // defined in prism_names.cpp
extern const PolytopeNotation kOperationNotation;                  // defined in diagram_names.cpp

/// All notations, in the order in which a text is tried. The first notation that returns a design or an error decides.
/// However, an error with PolytopeNameError::Reason::unknown and an empty message does not end the search.
inline constexpr auto kNotations = std::to_array<const PolytopeNotation*>({
    &kDualNotation,
    &kOverPolyhedronNotation,
    &kTruncationOrRectificationNotation,
    &kCombinationNotation,
    &kSchlaefliNotation,
    &kDiagramNotation,
    &kSnubPrismDiagramNotation,
    &kDuoprismNotation,
    &kDuoantiprismNotation,
    &kCyclicPolytopeNotation,
    &kPrismNotation,
    &kOperationNotation,
});

}  // namespace oval4d::polytopes
