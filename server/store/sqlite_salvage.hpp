#pragma once
// The database schema, and the recovery of intact sessions from a damaged database file.

#include <cstddef>
#include <set>
#include <string>
#include <string_view>

#include "store/sqlite_database.hpp"

namespace oval4d::store {

/// The version of the schema, which the file stores as user_version. Version 1 has no digests and stores tokens as
/// plain text.
inline constexpr int kSchemaVersion = 2;
inline constexpr const char* kSchema = R"(
    CREATE TABLE session (
        id TEXT PRIMARY KEY, token_hash TEXT NOT NULL, fence INTEGER NOT NULL,
        touched INTEGER NOT NULL,  -- milliseconds since 1970
        changed INTEGER NOT NULL,  -- 0: as it was created
        whole BLOB NOT NULL, head BLOB NOT NULL,
        digest BLOB NOT NULL,      -- of id, token_hash, whole
        head_digest BLOB NOT NULL  -- of id, head
        ) WITHOUT ROWID;
    CREATE INDEX session_touched ON session (touched);
    CREATE INDEX session_changed ON session (changed, touched);
    CREATE TABLE polytope (    -- objects of every kind, not polytopes alone
        session TEXT NOT NULL REFERENCES session ON DELETE CASCADE, key TEXT NOT NULL, bytes BLOB NOT NULL,
        digest BLOB NOT NULL,      -- of session, key, bytes
        PRIMARY KEY (session, key));
    PRAGMA application_id = 1870017636;
    PRAGMA user_version = 2;)";

/// The bytes of application_id in the file's header, and their offset in bytes.
inline constexpr std::string_view kApplicationId = "ov4d";
inline constexpr std::size_t kApplicationIdAt = 68;

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
