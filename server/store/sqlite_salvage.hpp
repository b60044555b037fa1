#pragma once
// The recovery of intact sessions from a damaged database file.

#include <cstddef>
#include <set>
#include <string>

#include "store/sqlite_database.hpp"

namespace oval4d::store {

/// The result of a salvage.
struct SalvageResult {
    std::size_t saved = 0;       ///< number of sessions copied
    std::set<std::string> lost;  ///< ids of sessions whose record is damaged
    bool complete = true;        ///< whether all ids were found; if false, there may be further sessions
};

/// Copies every intact session and its objects from a damaged file of schema version 1 or 2 into `to`, which must have
/// the schema kSchema and empty tables. Throws StoreError if `to` cannot be written.
SalvageResult salvage(Database& from, Database& to);

}  // namespace oval4d::store
