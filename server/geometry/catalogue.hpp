#pragma once
// The polytopes that oval4d knows by name.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "geometry/design.hpp"
#include "geometry/polytope.hpp"

namespace oval4d::geometry {

/// One line of the catalogue: all from theory, nothing is built for it.
struct CatalogueEntry {
    std::string name;                  ///< "24-cell"
    std::string family;                ///< "regular", "star", "uniform A4" … "H4", "other", "prism", "antiprism prism",
                                       ///< "duoprism"
    std::vector<std::string> aliases;  ///< other names, lower case: "icositetrachoron", "ico", "rectified 16-cell"
    std::string diagram;               ///< Coxeter–Dynkin diagram in linear notation, "x3o4o3o"; or empty
    std::string schlaefli;             ///< "{3,4,3}"; or empty
    std::uint32_t vertices, edges, faces, cells;
    std::uint32_t symmetryOrder;  ///< order of the full symmetry group, reflections included
    Design design;
};

/// All entries, in the order in which the keys n and N walk them: the regular polychora, their stars, the uniform ones
/// by group, prisms, and some of each family of products.
std::span<const CatalogueEntry> catalogue();

/// The entry with this name or alias, or of the polytope that the text describes (case does not matter, blanks and
/// hyphens are alike), or nullptr.
const CatalogueEntry* findEntry(std::string_view text);

/// What a text names: an entry of the catalogue, or any polytope that it describes (names.hpp) if that has at most
/// `maxVertices` vertices.
std::variant<Design, NameError> designNamed(std::string_view text, std::size_t maxVertices);

/// The name or alias nearest to `text` by edit distance, for "did you mean".
std::string_view nearestName(std::string_view text);

/// The names nearest to `text`, equally near and of different polytopes, three at most.
std::vector<std::string_view> nearestNames(std::string_view text);

/// The polytope of this design or entry, built at first use. It is kept while it is in use, and the latest ones beyond
/// that, up to a bound on their memory. Safe from any thread; one polytope is built once only. Throws
/// std::invalid_argument as `build` does.
std::shared_ptr<const Polytope> polytopeOf(const Design& design);
std::shared_ptr<const Polytope> polytopeOf(const CatalogueEntry& entry);

/// The polytope of this design if it is built and kept, else nullptr; never waits for one that is being built.
std::shared_ptr<const Polytope> polytopeIfBuilt(const Design& design);

/// How alike two names are: letters to change, put in or take out (Levenshtein). Case, blanks and hyphens do not
/// count, nor what is beyond 64 letters.
std::size_t likeness(std::string_view one, std::string_view other);

/// The bound on the memory of polytopes kept without being in use, in bytes; 64 MiB at the start.
void keepPolytopes(std::size_t bytes);

/// The memory of the polytopes used last, in bytes: never more than that bound.
std::size_t polytopesKept();

}  // namespace oval4d::geometry
