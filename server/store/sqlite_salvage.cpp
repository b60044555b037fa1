#include "store/sqlite_salvage.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace oval4d::store {

namespace {

/// A search for the ids of all sessions in a damaged file. A scan of a table stops at a damaged page, but a scan that
/// starts after this page may find further ids. So if the first scan fails, the constructor scans from many starting
/// points in both directions. It also scans an index and the table of objects, which are on other pages.
class SessionIdScan {
  public:
    explicit SessionIdScan(Database& from) : from_(from) {
        const bool all = collectIds("SELECT id FROM session ORDER BY id", {});
        if (all) return;
        collectIds("SELECT id FROM session ORDER BY id DESC", {});
        // All ids begin with two of these letters, because they are random names in base 32 (see randomName()).
        constexpr std::string_view kLetters = "234567abcdefghijklmnopqrstuvwxyz";
        for (const char first : kLetters) {
            for (const char second : kLetters) {
                const std::string start{first, second};
                const std::string end = start + "~";
                collectIds("SELECT id FROM session WHERE id >= ? AND id < ? ORDER BY id", {start, end});
                collectIds("SELECT id FROM session WHERE id >= ? AND id < ? ORDER BY id DESC", {start, end});
            }
        }
        const bool indexed = collectIds("SELECT id FROM session INDEXED BY session_touched ORDER BY touched", {});
        if (!indexed) collectIds("SELECT id FROM session INDEXED BY session_touched ORDER BY touched DESC", {});
        collectIds("SELECT DISTINCT session FROM polytope", {});
        complete = indexed;
    }

    std::set<std::string> found;
    bool complete = true;

  private:
    /// Adds to `found` the ids that a query returns. `bounds` are the values of the query's parameters. Returns false
    /// if an error ended the query early.
    bool collectIds(const char* sql, const std::vector<std::string>& bounds) {
        try {
            Statement statement(from_, sql);
            for (const std::string& bound : bounds) statement.bindText(bound);
            while (statement.step()) found.insert(statement.bytesAt(0));
            return true;
        } catch (const StoreError&) {
            return false;
        }
    }
    Database& from_;
};

struct SalvagedSession {
    std::string tokenHash, whole, head;
    std::int64_t fence = 0, touched = 0, changed = 1;
    std::vector<std::pair<std::string, std::string>> objects;
};

/// Reads a session. Returns an empty optional if the session is missing, or if its record or an object does not match
/// its digest. Throws StoreError if a page is damaged. `hashed` says whether the file has schema version 2, with hashed
/// tokens and digests.
std::optional<SalvagedSession> readSession(Database& from, bool hashed, const std::string& id) {
    Statement session(from, hashed
                                ? "SELECT token_hash, whole, head, fence, touched, changed FROM session WHERE id = ?1 "
                                  "AND digest = digest_of(id, token_hash, whole) AND head_digest = digest_of(id, head)"
                                : "SELECT hash_of(token), whole, head, fence, touched, 1 FROM session WHERE id = ?1");
    if (!session.bindText(id).step()) return std::nullopt;
    SalvagedSession salvaged{session.bytesAt(0),
                             session.bytesAt(1),
                             session.bytesAt(2),
                             session.numberAt(3),
                             session.numberAt(4),
                             session.numberAt(5),
                             {}};
    Statement polytopes(
        from, hashed ? "SELECT key, bytes, digest = digest_of(session, key, bytes) FROM polytope WHERE session = ?"
                     : "SELECT key, bytes, 1 FROM polytope WHERE session = ?");
    polytopes.bindText(id);
    while (polytopes.step()) {
        if (polytopes.numberAt(2) == 0) return std::nullopt;
        salvaged.objects.emplace_back(polytopes.bytesAt(0), polytopes.bytesAt(1));
    }
    return salvaged;
}

void insertSession(Database& to, const std::string& id, const SalvagedSession& salvaged) {
    Statement session(
        to, "INSERT INTO session VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, digest_of(?1, ?2, ?6), digest_of(?1, ?7))");
    session.bindText(id)
        .bindText(salvaged.tokenHash)
        .bindNumber(salvaged.fence)
        .bindNumber(salvaged.touched)
        .bindNumber(salvaged.changed);
    session.blob(salvaged.whole).blob(salvaged.head).step();
    for (const auto& [key, bytes] : salvaged.objects) {
        Statement polytope(to, "INSERT INTO polytope VALUES (?1, ?2, ?3, digest_of(?1, ?2, ?3))");
        polytope.bindText(id).bindText(key).blob(bytes).step();
    }
}

bool hasTokenHashes(Database& from) {
    try {
        const Statement statement(from, "SELECT token_hash FROM session");
        return true;
    } catch (const StoreError&) {
        return false;
    }
}

}  // namespace

SalvageResult salvage(Database& from, Database& to) {
    const SessionIdScan ids(from);
    const bool hashed = hasTokenHashes(from);
    SalvageResult result{0, {}, ids.complete};
    for (const std::string& id : ids.found) {
        std::optional<SalvagedSession> session;
        try {
            session = readSession(from, hashed, id);
        } catch (const StoreError&) {
            session.reset();  // the session is on a damaged page
        }
        if (!session) {
            result.lost.insert(id);
            continue;
        }
        Transaction one(to);
        insertSession(to, id, *session);
        one.commit();
        ++result.saved;
    }
    return result;
}

}  // namespace oval4d::store
