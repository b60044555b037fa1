#pragma once
// Copies the intact sessions out of a damaged database file.

#include <cstddef>
#include <set>
#include <string>

#include "store/sqlite_database.hpp"

namespace oval4d::store {

/// The result of salvage().
struct SalvageResult {
    std::size_t saved = 0;       ///< the number of copied sessions
    std::set<std::string> lost;  ///< the ids of the sessions that were not copied, because they are damaged
    bool complete = true;        ///< whether all ids were found; if false, more sessions may be lost
};

/// Copies every intact session and its objects from the damaged file `from` to the database `to`. The damaged file has
/// schema version 1 or 2. `to` must have the schema kSchema and empty tables. Throws StoreError if `to` cannot be
/// written.
SalvageResult salvage(Database& from, Database& to);

}  // namespace oval4d::store
