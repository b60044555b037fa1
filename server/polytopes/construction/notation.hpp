#pragma once
// The interface of parsers for notations, that is, systems of names and symbols for polytopes.

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
using DesignOrError = std::variant<Design, NameError>;

/// A function that returns the design that a text in any notation denotes. A Notation calls it for the name of another
/// polytope within its own text, as in "dual of rectified 5-cell".
using DesignLookup = std::function<DesignOrError(std::string_view text)>;

/// A text that may name a polytope, split into lower-case words (at least one), and the function that looks up names of
/// other polytopes within the text. The referenced objects must outlive it.
struct NameWords {
    const std::vector<std::string>& words;
    const DesignLookup& lookup;

    /// Returns the words from index `first` on, joined by spaces.
    std::string joinedFrom(std::size_t first) const { return text::joined(words, first, words.size()); }
    /// Returns all words except the last one.
    std::vector<std::string> withoutLast() const { return {words.begin(), words.end() - 1}; }
};

/// A parser for one notation. Returns the design; an error if the text is in this notation but denotes no polytope;
/// std::nullopt if the text is not in this notation.
using Notation = std::optional<DesignOrError> (*)(const NameWords& text);

}  // namespace oval4d::polytopes
