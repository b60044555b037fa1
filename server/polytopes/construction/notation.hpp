#pragma once
// The interface of a notation for polytopes.

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

/// Finds the design for any text; for notations that contain the name of another polytope.
using DesignLookup = std::function<DesignOrError(std::string_view text)>;

/// A text that may name a polytope, in lower case and split into words, of which there is at least one.
struct NamedText {
    const std::vector<std::string>& words;
    const DesignLookup& lookup;

    /// The words from index `first` on, joined by spaces.
    std::string from(std::size_t first) const { return text::joined(words, first, words.size()); }
    std::vector<std::string> withoutLast() const { return {words.begin(), words.end() - 1}; }
};

/// A parser for one notation. Returns nothing if the text is not in this notation.
using Notation = std::optional<DesignOrError> (*)(const NamedText& text);

}  // namespace oval4d::polytopes
