#include "store/sqlite_store.hpp"

#include <spdlog/fmt/chrono.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>

#include "store/private_file.hpp"
#include "store/secret.hpp"
#include "store/sqlite_salvage.hpp"
#include "store/sqlite_schema.hpp"

namespace oval4d::store {

namespace {

constexpr std::size_t kPageSize = 4096;
// The maximum number of free pages that one call of pollTakenOverSessions() returns to the file system.
constexpr std::int64_t kMaxReleasedPages = 1024;
constexpr std::size_t kMaxListedIds = 20;  // the maximum number of session ids in a log line

// Returns the maximum number of pages of the database file: three quarters of the quota. The rest of the quota is for
// the write-ahead log. The log may grow to the size that triggers a checkpoint, plus the pages of one transaction.
std::int64_t maxPagesFor(std::size_t quota) { return static_cast<std::int64_t>(quota / kPageSize * 3 / 4); }

/// Returns an upper bound of the number of pages that updates need. Short rows share pages that are at least half full,
/// and long values have pages of their own.
std::int64_t pagesNeededFor(std::span<const RecordUpdate> updates) {
    std::size_t pages = 8;  // room for the interior pages of tables and indices
    std::size_t small = 0;
    for (const RecordUpdate& update : updates) {
        const std::size_t bytes = estimateStoredSize(update);
        if (bytes < kPageSize / 4) {
            small += 2 * bytes;
        } else {
            pages += bytes / kPageSize + 2 + update.objects.size();
        }
    }
    return static_cast<std::int64_t>(pages + small / kPageSize);
}

std::string joinIds(const std::set<std::string>& ids) {
    std::string text;
    std::size_t count = 0;
    for (const std::string& id : ids) {
        if (count++ == kMaxListedIds) return text + ",…";
        text += (text.empty() ? "" : ",") + id;
    }
    return text;
}

/// Returns an unused path, to which the caller renames a damaged file.
std::string pathForDamagedFile(const std::string& path) {
    const auto seconds = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
    const std::string name =
        path + fmt::format(".damaged-{:%Y%m%dT%H%M%SZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(seconds)));
    for (int i = 1;; ++i) {
        std::string candidate = i == 1 ? name : name + "-" + std::to_string(i);
        if (!std::filesystem::exists(candidate)) return candidate;
    }
}

void renameIfExists(const std::string& from, const std::string& to) {
    std::error_code fault;
    if (!std::filesystem::exists(from, fault)) return;
    std::filesystem::rename(from, to, fault);
    if (fault) throw StoreError(from + " cannot be renamed to " + to + ": " + fault.message());
}

}  // namespace

SqliteStore::SqliteStore(std::string path, std::size_t quota, ClockFunction<Clock> now)
    : path_(std::move(path)), maxPages_(maxPagesFor(quota)), now_(std::move(now)) {
    open();
    spdlog::info("store opened store={} sessions={}", name(), size_);
}

/// Returns the current time in milliseconds since 1970, the unit of all times in records.
std::int64_t SqliteStore::nowMilliseconds() const {
    return std::chrono::duration_cast<Milliseconds>(now_().time_since_epoch()).count();
}

void SqliteStore::open() {
    for (const char* beside : {"", "-wal", "-shm", "-journal"}) requireOwnRegularFileIfExists(path_ + beside);
    refuseForeignFile(path_);
    ensurePrivateFile(path_);
    for (const char* beside : {"-wal", "-shm", "-journal"}) makePrivateIfExists(path_ + beside);
    const std::string identity = fileIdentity(path_);
    database_ = std::make_unique<Database>(path_);
    try {
        std::string damage;
        try {
            checkDatabase();
        } catch (const CorruptDatabase& fault) {
            damage = fault.what();
        }
        // Another server may have replaced the file after this server opened it.
        if (fileIdentity(path_) != identity) {
            throw StoreError(path_ + " is in use by another server; each server needs its own file");
        }
        if (damage.empty()) {
            setUp();
        } else {
            salvageDamagedFile(damage);
        }
    } catch (...) {
        database_.reset();
        throw;
    }
}

/// Throws CorruptDatabase if the file is damaged. Throws StoreError if the file belongs to another program or was
/// written by a later version. Does not change the file; after a StoreError, closing the database does not change it,
/// either.
void SqliteStore::checkDatabase() {
    const auto tables = database_->queryNumber("SELECT count(*) FROM sqlite_schema");
    const auto version = database_->queryNumber("PRAGMA user_version");
    const auto refuse = [&](const char* why) {
        // Without this call, closing the file would write the log of a killed server to the file.
        database_->keepWriteAheadLogOnClose();
        throw StoreError(path_ + why);
    };
    if (version > kSchemaVersion) refuse(" was written by a later version of oval4d");
    const auto ours =
        database_->queryNumber("SELECT count(*) FROM sqlite_schema WHERE name IN ('session', 'polytope')");
    if (tables > 0 && ours == 0) refuse(" is the database of another program; it was not changed: give another path");
    // Use integrity_check: unlike quick_check, it also compares the indices with the tables.
    Statement check(*database_, "PRAGMA integrity_check(1)");
    const std::string result = check.step() ? check.bytesAt(0) : "the integrity check returned nothing";
    if (result != "ok") throw CorruptDatabase(path_ + ": " + result);
    if (tables > 0 && ours < 2) throw CorruptDatabase(path_ + ": a table is missing");
}

void SqliteStore::setUp() {
    database_->execute("PRAGMA synchronous = NORMAL");
    if (database_->queryNumber("SELECT count(*) FROM sqlite_schema") == 0) {
        database_->execute("PRAGMA auto_vacuum = INCREMENTAL; PRAGMA journal_mode = WAL; BEGIN IMMEDIATE");
        database_->execute(kSchema);
        database_->execute("COMMIT");
    } else {
        database_->execute("PRAGMA journal_mode = WAL");
        migrate();
    }
    const std::int64_t logPages = std::clamp<std::int64_t>(maxPages_ / 8, 16, 1000);
    database_->execute(("PRAGMA wal_autocheckpoint = " + std::to_string(logPages)).c_str());
    database_->execute(("PRAGMA journal_size_limit = " + std::to_string(logPages * std::int64_t{kPageSize})).c_str());
    logDamagedRecords();
    {
        Statement statement(
            *database_,
            "UPDATE session SET touched = ?1 WHERE touched > ?1");  // a time in the future would delay the expiry
        statement.bindNumber(nowMilliseconds()).step();
    }
    if (const auto count = evictSessionsUntilFits(0, [](const std::string&) { return false; }); count > 0) {
        spdlog::warn("sessions evicted, the store exceeds its quota count={} store={}", count, name());
    }
    releasePages(std::max<std::int64_t>(kMaxReleasedPages, usedPages()));
    database_->execute("PRAGMA wal_checkpoint(TRUNCATE)");
    size_ = static_cast<std::size_t>(database_->queryNumber("SELECT count(*) FROM session"));
}

/// Converts a file of schema version 1, with tokens as plain text and records without digests, in one transaction. A
/// VACUUM follows. If the VACUUM fails, it runs again when the file is opened the next time.
void SqliteStore::migrate() {
    if (database_->queryNumber("PRAGMA user_version") < kSchemaVersion) {
        database_->execute("PRAGMA foreign_keys = OFF");
        {
            Transaction all(*database_);
            database_->execute(
                "ALTER TABLE session RENAME TO session_1; ALTER TABLE polytope RENAME TO polytope_1;"
                "DROP INDEX IF EXISTS session_touched");
            database_->execute(kSchema);
            database_->execute(
                "INSERT INTO session SELECT id, hash_of(token), fence, touched, 1, whole, head,"
                "  digest_of(id, hash_of(token), whole), digest_of(id, head) FROM session_1;"
                "INSERT INTO polytope SELECT session, key, bytes, digest_of(session, key, bytes) FROM polytope_1;"
                "DROP TABLE polytope_1; DROP TABLE session_1");
            all.commit();
        }
        database_->execute("PRAGMA foreign_keys = ON");
        spdlog::info("store migrated to version {} store={}", kSchemaVersion, name());
    }
    // Once for each file, VACUUM erases the plain-text tokens of schema version 1 from free pages and from the
    // write-ahead log. auto_vacuum becomes `incremental` only when VACUUM succeeds, so its value says whether this is
    // done.
    constexpr std::int64_t kIncremental = 2;
    if (database_->queryNumber("PRAGMA auto_vacuum") != kIncremental) {
        database_->execute("PRAGMA auto_vacuum = INCREMENTAL; VACUUM; PRAGMA wal_checkpoint(TRUNCATE)");
    }
}

/// Copies the intact sessions to a new file, which replaces the damaged file. `why` describes the damage for the log.
void SqliteStore::salvageDamagedFile(const std::string& why) {
    spdlog::error("store damaged store={} damage=\"{}\"", name(), why);
    const std::string fresh = path_ + ".salvaged";
    for (const char* beside : {"", "-wal", "-shm", "-journal"}) std::filesystem::remove(fresh + beside);
    ensurePrivateFile(fresh);
    SalvageResult salvaged;
    {
        Database to(fresh);
        to.execute("PRAGMA auto_vacuum = INCREMENTAL; PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL");
        to.execute(kSchema);
        salvaged = salvage(*database_, to);
    }
    // Rename the write-ahead log first. Otherwise, SQLite would apply it to the new file.
    const std::string aside = pathForDamagedFile(path_);
    database_->keepWriteAheadLogOnClose();
    std::error_code missing;
    if (std::filesystem::file_size(path_ + "-wal", missing) == 0 && !missing) std::filesystem::remove(path_ + "-wal");
    renameIfExists(path_ + "-wal", aside + "-wal");
    renameIfExists(path_, aside);
    renameIfExists(fresh, path_);
    database_.reset();  // releases the lock on the damaged file only after the renames
    spdlog::error("store salvaged store={} saved={} lost={}{} lost_sessions={} set_aside={}", name(), salvaged.saved,
                  salvaged.complete ? "" : "at least ", salvaged.lost.size(), joinIds(salvaged.lost), aside);
    damage_.clear();
    database_ = std::make_unique<Database>(path_);
    try {
        // Another server that started at the same time may have locked the new file. That server exits when it notices
        // the renames, so wait for the lock.
        database_->execute("PRAGMA busy_timeout = 30000");
        setUp();
        database_->execute("PRAGMA busy_timeout = 2000");
    } catch (...) {
        database_.reset();  // the next operation will open the file again
        throw;
    }
}

/// Logs the sessions whose records do not match their digests. checkDatabase() does not find them, because SQLite's
/// integrity check does not notice bit errors within a record. Damaged records are kept for inspection.
void SqliteStore::logDamagedRecords() {
    std::set<std::string> damaged;
    Statement statement(
        *database_,
        "SELECT id FROM session WHERE digest <> digest_of(id, token_hash, whole) OR head_digest <> digest_of(id, head)"
        " UNION SELECT session FROM polytope WHERE digest <> digest_of(session, key, bytes)");
    while (statement.step()) damaged.insert(statement.bytesAt(0));
    if (damaged.empty()) return;
    const auto all = static_cast<std::size_t>(database_->queryNumber("SELECT count(*) FROM session"));
    spdlog::error("sessions damaged, and lost store={} kept={} lost={} lost_sessions={}", name(),
                  all - std::min(all, damaged.size()), damaged.size(), joinIds(damaged));
}

/// Calls `work` and returns its result. If `work` finds damage in the file, this call throws, and the next call repairs
/// the file first. The repair may lose sessions, but WriteBehindStore saves all open sessions again after the
/// exception.
template <typename Work>
auto SqliteStore::runAfterPendingRepair(Work work) {
    if (!database_) {
        open();
    } else if (!damage_.empty()) {
        salvageDamagedFile(std::string(damage_));
    }
    try {
        return work();
    } catch (const CorruptDatabase& fault) {
        damage_ = fault.what();
        throw;
    }
}

std::optional<std::string> SqliteStore::tokenHash(const std::string& id) {
    return runAfterPendingRepair([&]() -> std::optional<std::string> {
        Statement statement(*database_, "SELECT token_hash FROM session WHERE id = ?");
        return statement.bindText(id).step() ? std::optional(statement.bytesAt(0)) : std::nullopt;
    });
}

bool SqliteStore::isDamaged(const std::string& id) {
    return runAfterPendingRepair([&] {
        Statement statement(*database_,
                            "SELECT 1 FROM session WHERE id = ? AND digest <> digest_of(id, token_hash, whole)");
        return statement.bindText(id).step();
    });
}

std::optional<SessionRecord> SqliteStore::claim(const std::string& id) {
    runAfterPendingRepair([&] {
        try {
            Statement statement(*database_, "UPDATE session SET fence = fence + 1, touched = ? WHERE id = ?");
            statement.bindNumber(nowMilliseconds()).bindText(id).step();
        } catch (const StoreNotWritable&) {
            // The record can still be read. The fence may stay the same, because no other server uses this file.
        }
    });
    return read(id);
}

std::optional<SessionRecord> SqliteStore::read(const std::string& id) {
    return runAfterPendingRepair([&]() -> std::optional<SessionRecord> {
        Statement statement(*database_,
                            "SELECT whole, head, fence, digest = digest_of(id, token_hash, whole) AND "
                            "head_digest = digest_of(id, head) FROM session WHERE id = ?");
        if (!statement.bindText(id).step()) return std::nullopt;
        SessionRecord record{
            statement.bytesAt(0), statement.bytesAt(1), {}, static_cast<FencingToken>(statement.numberAt(2)), {}};
        if (statement.numberAt(3) == 0) record.damage = "its record in the store is damaged";
        Statement polytopes(
            *database_, "SELECT key, bytes, digest = digest_of(session, key, bytes) FROM polytope WHERE session = ?");
        polytopes.bindText(id);
        while (polytopes.step()) {
            record.objects.emplace_back(polytopes.bytesAt(0), polytopes.bytesAt(1));
            if (polytopes.numberAt(2) == 0) record.damage = "one of its objects in the store is damaged";
        }
        return record;
    });
}

std::vector<SaveResult> SqliteStore::save(std::span<const RecordUpdate> updates) {
    return runAfterPendingRepair([&] {
        if (usedPages() + pagesNeededFor(updates) > maxPages_) {
            throw StoreNotWritable(path_ + ": open sessions use up the quota (--store-quota)");
        }
        std::vector<SaveResult> results;
        Transaction all(*database_);
        for (const RecordUpdate& update : updates) results.push_back(saveOne(update));
        all.commit();
        return results;
    });
}

SaveResult SqliteStore::saveOne(const RecordUpdate& update) {
    const std::string& id = update.credentials.id;
    const auto fence = static_cast<std::int64_t>(update.fence);
    const std::int64_t changed = update.changed ? 1 : 0;
    std::size_t written = 0;
    if (!update.whole.empty()) {
        const std::string hash = hashToken(update.credentials.token);
        Statement statement(
            *database_,
            "INSERT INTO session VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, digest_of(?1, ?2, ?6), digest_of(?1, ?7)) "
            "ON CONFLICT (id) DO UPDATE SET token_hash = ?2, fence = ?3, touched = ?4, changed = ?5, whole = ?6, "
            "head = ?7, digest = digest_of(?1, ?2, ?6), head_digest = digest_of(?1, ?7) WHERE fence <= ?3");
        statement.bindText(id)
            .bindText(hash)
            .bindNumber(fence)
            .bindNumber(nowMilliseconds())
            .bindNumber(changed)
            .blob(update.whole)
            .blob(update.head)
            .step();
        written = statement.changedRowCount();
    } else {
        Statement statement(
            *database_,
            "UPDATE session SET fence = ?1, touched = ?2, changed = ?3, head = ?4, head_digest = digest_of(id, ?4) "
            "WHERE id = ?5 AND fence <= ?1");
        statement.bindNumber(fence)
            .bindNumber(nowMilliseconds())
            .bindNumber(changed)
            .blob(update.head)
            .bindText(id)
            .step();
        written = statement.changedRowCount();
    }
    if (written == 0) {
        Statement statement(*database_, "SELECT 1 FROM session WHERE id = ?");
        return statement.bindText(id).step() ? SaveResult::claimed : SaveResult::missing;
    }
    for (const auto& [key, bytes] : update.objects) {
        Statement statement(*database_, "INSERT OR REPLACE INTO polytope VALUES (?1, ?2, ?3, digest_of(?1, ?2, ?3))");
        statement.bindText(id).bindText(key).blob(bytes).step();
    }
    for (const std::string& key : update.dropped) {
        Statement statement(*database_, "DELETE FROM polytope WHERE session = ? AND key = ?");
        statement.bindText(id).bindText(key).step();
    }
    return SaveResult::saved;
}

std::size_t SqliteStore::evict(std::span<const RecordUpdate> updates, const PinnedPredicate& isPinned) {
    return runAfterPendingRepair([&] { return evictSessionsUntilFits(pagesNeededFor(updates), isPinned); });
}

std::size_t SqliteStore::evictSessionsUntilFits(std::int64_t pagesNeeded, const PinnedPredicate& isPinned) {
    const auto fits = [&] { return usedPages() + pagesNeeded <= maxPages_; };
    if (fits() || pagesNeeded > maxPages_) return 0;
    std::vector<std::string> candidates;
    {
        Statement statement(*database_, "SELECT id FROM session ORDER BY changed, touched");
        while (statement.step()) candidates.push_back(statement.bytesAt(0));
    }
    std::size_t count = 0;
    Transaction all(*database_);
    for (const std::string& id : candidates) {
        if (isPinned(id)) continue;
        Statement statement(*database_, "DELETE FROM session WHERE id = ?");
        statement.bindText(id).step();
        ++count;
        if (fits()) break;
    }
    if (!fits()) return 0;  // no commit, so the transaction restores the deleted sessions
    all.commit();
    return count;
}

void SqliteStore::remove(std::span<const std::string> ids) {
    runAfterPendingRepair([&] {
        Transaction all(*database_);
        for (const std::string& id : ids) {
            Statement statement(*database_, "DELETE FROM session WHERE id = ?");
            statement.bindText(id).step();
        }
        all.commit();
    });
}

void SqliteStore::restartExpiry(std::span<const std::string> ids) {
    runAfterPendingRepair([&] {
        Transaction all(*database_);
        for (const std::string& id : ids) {
            Statement statement(*database_, "UPDATE session SET touched = ? WHERE id = ?");
            statement.bindNumber(nowMilliseconds()).bindText(id).step();
        }
        all.commit();
    });
}

std::size_t SqliteStore::expire(Milliseconds age) {
    return runAfterPendingRepair([&] {
        Statement statement(*database_, "DELETE FROM session WHERE touched < ?");
        statement.bindNumber(nowMilliseconds() - age.count()).step();
        return statement.changedRowCount();
    });
}

std::vector<TakenOverSession> SqliteStore::pollTakenOverSessions() {
    runAfterPendingRepair([&] {
        releasePages(kMaxReleasedPages);
        size_ = static_cast<std::size_t>(database_->queryNumber("SELECT count(*) FROM session"));
    });
    return {};
}

std::int64_t SqliteStore::usedPages() {
    return database_->queryNumber("PRAGMA page_count") - database_->queryNumber("PRAGMA freelist_count");
}

/// Returns at most `maxPages` free pages to the file system, but keeps kReservedPages free pages for the next updates.
void SqliteStore::releasePages(std::int64_t maxPages) {
    constexpr std::int64_t kReservedPages = 64;
    const std::int64_t free = database_->queryNumber("PRAGMA freelist_count");
    if (free <= kReservedPages) return;
    database_->execute(
        ("PRAGMA incremental_vacuum(" + std::to_string(std::min(maxPages, free - kReservedPages)) + ")").c_str());
}

}  // namespace oval4d::store
