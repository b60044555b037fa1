#pragma once
// The polytopes that oval4d knows by name.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/polytope.hpp"

namespace oval4d::geometry {

/// One line of the catalogue. Counts are stated from theory and checked against the built polytope by the tests.
struct CatalogueEntry {
    std::string_view name;                  ///< "24-cell"
    std::vector<std::string_view> aliases;  ///< other names, lower case: "icositetrachoron", "ico", "{3,4,3}"
    std::string_view schlaefli;             ///< "{3,4,3}"
    std::uint32_t vertices, edges, faces, cells;
    std::uint32_t symmetryOrder;  ///< order of the full symmetry group, reflections included
};

/// All entries, in the order in which the keys n and N walk them.
std::span<const CatalogueEntry> catalogue();

/// The entry with this name or alias (case does not matter, blanks and hyphens are alike), or nullptr.
const CatalogueEntry* findEntry(std::string_view nameOrAlias);

/// The name nearest to `text` by edit distance, for "did you mean".
std::string_view nearestName(std::string_view text);

/// The polytope of this entry, built at first use and shared from then on. Safe from any thread.
std::shared_ptr<const Polytope> polytopeOf(const CatalogueEntry& entry);

}  // namespace oval4d::geometry
