#pragma once
// The catalogue of polytopes known by name.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "polytopes/construction/design.hpp"
#include "polytopes/construction/notation.hpp"

namespace oval4d::polytopes {

/// An entry of the catalogue. Its values are derived from the design, without building the polytope.
struct CatalogueEntry {
    std::string name;                  ///< "24-cell"
    std::string family;                ///< "regular", "star", "uniform A4" … "H4", "other", "prism", "antiprism prism",
                                       ///< "duoprism"
    std::vector<std::string> aliases;  ///< other names, lower case: "icositetrachoron", "ico", "rectified 16-cell"
    std::string diagram;               ///< Coxeter–Dynkin diagram in linear notation, "x3o4o3o", or empty
    std::string schlaefli;             ///< Schläfli symbol, "{3,4,3}", or empty
    std::uint32_t vertices, edges, faces, cells;  ///< the numbers of elements
    std::uint32_t symmetryOrder;                  ///< the order of the full symmetry group, which includes reflections
    Design design;
};

/// Returns all entries, in the order in which the keys n and N step through them: the convex regular polychora (4-D
/// polytopes), the regular stars, the uniform polychora by symmetry group, prisms, and some members of each infinite
/// family.
std::span<const CatalogueEntry> catalogue();

/// Returns the entry with this name, alias, diagram or Schläfli symbol, or the entry of the polytope that the text
/// describes (see names.hpp); nullptr if the catalogue does not contain it. Ignores case; blanks and hyphens are
/// equivalent.
const CatalogueEntry* findEntry(std::string_view text);

/// Returns the design of the polytope that a text names: an entry of the catalogue, or any other polytope that the text
/// describes (see names.hpp) and that has at most `maxVertices` vertices. Returns an error if there is none.
DesignOrError designNamed(std::string_view text, std::size_t maxVertices);

/// Returns the name or alias with the least edit distance from `text`, for suggestions ("did you mean").
std::string_view nearestName(std::string_view text);

/// Returns the names with the least edit distance from `text`: at most three, and at most one for each polytope.
std::vector<std::string_view> nearestNames(std::string_view text);

/// Returns the edit distance (Levenshtein) of two names. Ignores case, blanks, hyphens, and everything after the first
/// 64 bytes.
std::size_t editDistance(std::string_view one, std::string_view other);

}  // namespace oval4d::polytopes
