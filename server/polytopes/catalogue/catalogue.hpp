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
#include "polytopes/construction/notations.hpp"

namespace oval4d::polytopes {

/// An entry of the catalogue. Its numbers and symbols are computed without building the polytope.
struct CatalogueEntry {
    std::string name;                  ///< the canonical name, such as "24-cell"
    std::string family;                ///< the group of entries: "regular", "star", "uniform A4" (or B4, F4, H4),
                                       ///< "other", "prism", "antiprism prism" or "duoprism"
    std::vector<std::string> aliases;  ///< other names in lower case, such as "ico" and "rectified 16-cell"
    std::string diagram;               ///< the diagram in linear notation, such as "x3o4o3o"; empty if there is none
    std::string schlaefli;             ///< the Schläfli symbol, such as "{3,4,3}"; empty if there is none
    std::uint32_t vertices, edges, faces, cells;  ///< the numbers of elements
    std::uint32_t symmetryOrder;                  ///< the order of the full symmetry group, which includes reflections
    PolytopeDesign design;
};

/// Returns all entries, in the order in which the keys n and N of the page step through them: the convex regular
/// polychora (4-D polytopes), the regular star polychora, the other convex uniform polychora, prisms over uniform
/// polyhedra, and some antiprism prisms and duoprisms. The first call builds the catalogue; it exists until the process
/// ends. Thread-safe.
std::span<const CatalogueEntry> catalogue();

/// The maximum size in bytes of a canonical name (PolytopeDesign::name). Messages and stored sessions contain such
/// names.
inline constexpr std::size_t kMaxNameBytes = 256;

/// Returns the entry of the polytope that `text` denotes. The text may be a name, an alias, a diagram, a Schläfli
/// symbol, or in another notation (see designDescribedBy() in names.hpp). Returns nullptr if the catalogue has no such
/// polytope. Ignores case; blanks and hyphens are equivalent.
const CatalogueEntry* findEntry(std::string_view text);

/// Returns the design of the polytope that a text names. The text may name an entry of the catalogue, or any other
/// polytope in one of the notations (see designDescribedBy() in names.hpp). Returns an error if the text names no
/// polytope.
///
/// For a polytope that is not in the catalogue, also returns an error if it has more than `maxVertices` vertices, if
/// its canonical name has more than kMaxNameBytes, or if the convex hulls from which it is built have more than
/// kMaxHullPoints points in total (see convex_hull.hpp).
PolytopeDesignOrError designNamed(std::string_view text, std::size_t maxVertices);

/// Returns the name or alias with the least edit distance from `text`, for suggestions ("did you mean"). If several
/// names have this distance, prefers one whose length is nearest to that of `text`. Returns an empty text if the
/// distance is more than a third of the length of `text`.
std::string_view nearestName(std::string_view text);

/// Returns the names and aliases to which nearestName() gives equal preference: at most three, and at most one for each
/// polytope. Returns an empty list if nearestName() returns an empty text.
std::vector<std::string_view> equallyNearestNames(std::string_view text);

/// Returns the edit distance (Levenshtein) of two names. Cuts both names to kMaxNameBytes and converts them by
/// text::normalizedName() before the comparison.
std::size_t editDistanceOfNames(std::string_view one, std::string_view other);

}  // namespace oval4d::polytopes
