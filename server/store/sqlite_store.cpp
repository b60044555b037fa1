#include "store/sqlite_store.hpp"

#include <sqlite3.h>

#include <filesystem>

namespace oval4d::store {

namespace {

// Version 1 of the tables; PRAGMA user_version tells.
constexpr const char* kTables = R"(
    CREATE TABLE IF NOT EXISTS session (
        id TEXT PRIMARY KEY, token TEXT NOT NULL, fence INTEGER NOT NULL,
        touched INTEGER NOT NULL,  -- milliseconds since 1970
        whole BLOB NOT NULL, head BLOB NOT NULL) WITHOUT ROWID;
    CREATE INDEX IF NOT EXISTS session_touched ON session (touched);
    CREATE TABLE IF NOT EXISTS polytope (
        session TEXT NOT NULL REFERENCES session ON DELETE CASCADE, key TEXT NOT NULL, bytes BLOB NOT NULL,
        PRIMARY KEY (session, key));
    PRAGMA user_version = 1;)";

}  // namespace

/// One statement, carried out once.
class SqliteStore::Query {
  public:
    Query(const SqliteStore& store, const char* sql) : store_(store) {
        if (sqlite3_prepare_v2(store.database_, sql, -1, &statement_, nullptr) != SQLITE_OK) store_.fail(sql);
    }
    Query(const Query&) = delete;
    Query& operator=(const Query&) = delete;
    ~Query() { sqlite3_finalize(statement_); }

    Query& text(std::string_view value) {
        return bound(sqlite3_bind_text64(statement_, ++bound_, value.data(), value.size(), SQLITE_STATIC, SQLITE_UTF8));
    }
    Query& blob(std::string_view value) {
        // Of an empty blob SQLite wants an address, too.
        return bound(
            sqlite3_bind_blob64(statement_, ++bound_, value.empty() ? "" : value.data(), value.size(), SQLITE_STATIC));
    }
    Query& number(std::int64_t value) { return bound(sqlite3_bind_int64(statement_, ++bound_, value)); }

    /// Whether there is a (further) row.
    bool row() {
        const int said = sqlite3_step(statement_);
        if (said != SQLITE_ROW && said != SQLITE_DONE) store_.fail(sqlite3_sql(statement_));
        return said == SQLITE_ROW;
    }
    std::string bytesAt(int column) const {
        const void* bytes = sqlite3_column_blob(statement_, column);
        const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, column));
        return bytes == nullptr ? std::string() : std::string(static_cast<const char*>(bytes), size);
    }
    std::int64_t numberAt(int column) const { return sqlite3_column_int64(statement_, column); }

  private:
    Query& bound(int said) {
        if (said != SQLITE_OK) store_.fail("binding a value");
        return *this;
    }

    const SqliteStore& store_;
    sqlite3_stmt* statement_ = nullptr;
    int bound_ = 0;
};

/// Undone unless committed.
class SqliteStore::Transaction {
  public:
    explicit Transaction(SqliteStore& store) : store_(store) { store_.run("BEGIN IMMEDIATE"); }
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    ~Transaction() {
        if (!committed_) sqlite3_exec(store_.database_, "ROLLBACK", nullptr, nullptr, nullptr);
    }
    void commit() {
        store_.run("COMMIT");
        committed_ = true;
    }

  private:
    SqliteStore& store_;
    bool committed_ = false;
};

SqliteStore::SqliteStore(std::string path) : path_(std::move(path)) {
    std::error_code ignored;
    const auto folder = std::filesystem::path(path_).parent_path();
    if (!folder.empty()) std::filesystem::create_directories(folder, ignored);
    try {
        if (sqlite3_open(path_.c_str(), &database_) != SQLITE_OK) fail("opening it");
        sqlite3_extended_result_codes(database_, 1);
        sqlite3_busy_timeout(database_, 2000);  // one that has just been killed may still be going
        run("PRAGMA locking_mode = EXCLUSIVE; PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL;"
            "PRAGMA foreign_keys = ON; PRAGMA journal_size_limit = 16777216;");
        Query version(*this, "PRAGMA user_version");
        if (version.row() && version.numberAt(0) > 1) {
            throw Outage(path_ + " was written by a later version of oval4d");
        }
    } catch (...) {
        sqlite3_close(database_);
        throw;
    }
    try {
        run(kTables);
        pulse();
    } catch (...) {
        sqlite3_close(database_);
        throw;
    }
}

SqliteStore::~SqliteStore() { sqlite3_close(database_); }

void SqliteStore::fail(const std::string& what) const {
    const int code = sqlite3_errcode(database_) & 0xFF;
    if (code == SQLITE_BUSY || code == SQLITE_LOCKED) {
        throw Outage(path_ + " is in use by another server; each needs a file of its own");
    }
    throw Outage(path_ + ": " + sqlite3_errmsg(database_) + " (" + what + ")");
}

void SqliteStore::run(const char* sql) {
    if (sqlite3_exec(database_, sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail(sql);
}

std::int64_t SqliteStore::now() const {
    return std::chrono::duration_cast<Milliseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::optional<std::string> SqliteStore::token(const std::string& id) {
    Query query(*this, "SELECT token FROM session WHERE id = ?");
    return query.text(id).row() ? std::optional(query.bytesAt(0)) : std::nullopt;
}

std::optional<Record> SqliteStore::claim(const std::string& id) {
    Query query(*this, "UPDATE session SET fence = fence + 1, touched = ? WHERE id = ? RETURNING whole, head, fence");
    if (!query.number(now()).text(id).row()) return std::nullopt;
    Record record{query.bytesAt(0), query.bytesAt(1), {}, static_cast<Fence>(query.numberAt(2))};
    query.row();  // to its end
    Query polytopes(*this, "SELECT key, bytes FROM polytope WHERE session = ?");
    polytopes.text(id);
    while (polytopes.row()) record.polytopes.emplace_back(polytopes.bytesAt(0), polytopes.bytesAt(1));
    return record;
}

std::vector<Saved> SqliteStore::save(std::span<const Saving> savings) {
    std::vector<Saved> said;
    Transaction all(*this);
    for (const Saving& saving : savings) said.push_back(saveOne(saving));
    all.commit();
    return said;
}

Saved SqliteStore::saveOne(const Saving& saving) {
    const auto fence = static_cast<std::int64_t>(saving.fence);
    if (!saving.whole.empty()) {
        Query query(*this,
                    "INSERT INTO session (id, token, fence, touched, whole, head) VALUES (?1, ?2, ?3, ?4, ?5, ?6) "
                    "ON CONFLICT (id) DO UPDATE SET fence = ?3, touched = ?4, whole = ?5, head = ?6 WHERE fence <= ?3");
        query.text(saving.ticket.id).text(saving.ticket.token).number(fence).number(now());
        query.blob(saving.whole).blob(saving.head).row();
    } else {
        Query query(*this, "UPDATE session SET fence = ?1, touched = ?2, head = ?3 WHERE id = ?4 AND fence <= ?1");
        query.number(fence).number(now()).blob(saving.head).text(saving.ticket.id).row();
    }
    if (sqlite3_changes(database_) == 0) return token(saving.ticket.id) ? Saved::taken : Saved::missing;
    for (const auto& [key, bytes] : saving.polytopes) {
        Query query(*this, "INSERT OR REPLACE INTO polytope (session, key, bytes) VALUES (?, ?, ?)");
        query.text(saving.ticket.id).text(key).blob(bytes).row();
    }
    for (const std::string& key : saving.dropped) {
        Query query(*this, "DELETE FROM polytope WHERE session = ? AND key = ?");
        query.text(saving.ticket.id).text(key).row();
    }
    return Saved::yes;
}

void SqliteStore::touch(std::span<const std::string> ids) {
    Transaction all(*this);
    for (const std::string& id : ids) {
        Query query(*this, "UPDATE session SET touched = ? WHERE id = ?");
        query.number(now()).text(id).row();
    }
    all.commit();
}

std::size_t SqliteStore::expire(Milliseconds age) {
    Query query(*this, "DELETE FROM session WHERE touched < ?");
    query.number(now() - age.count()).row();
    return static_cast<std::size_t>(sqlite3_changes(database_));
}

std::vector<std::string> SqliteStore::pulse() {
    Query query(*this, "SELECT count(*) FROM session");
    if (query.row()) size_ = static_cast<std::size_t>(query.numberAt(0));
    return {};
}

}  // namespace oval4d::store
