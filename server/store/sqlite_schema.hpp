#pragma once
// The schema of a session store's database file, and a check that a file is such a store.

#include <string>

namespace oval4d::store {

/// The version of the schema, which each file contains as its user_version. Version 1 has no digests, and stores tokens
/// as plain text.
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

/// Throws StoreError if the file `path` exists and is not a session store of oval4d. The server must neither change nor
/// rename such a file. The first page of a store contains the application_id of kSchema; in version 1, it contains the
/// text of `CREATE TABLE session` instead. An empty file is accepted. A database without tables is accepted, too,
/// because its tables may still be in the write-ahead log.
void refuseForeignFile(const std::string& path);

}  // namespace oval4d::store
