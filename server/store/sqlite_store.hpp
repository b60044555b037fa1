#pragma once
// A session store in an SQLite file.

#include <memory>
#include <string>

#include "store/sqlite_database.hpp"
#include "store/store.hpp"

namespace oval4d::store {

/// A session store in an SQLite file, which outlives the server. Only one server can use the file, and no other user of
/// the system can read it. Each commit is in the write-ahead log, so saved records survive if the process is killed at
/// any time. The log is not flushed to the disk at each commit (synchronous = NORMAL): a power failure may lose the
/// latest commits, but does not damage the file.
///
/// The whole file is checked when it is opened. If damaged pages are found, then or later, the intact sessions are
/// copied to a new file, and the damaged file is renamed to PATH.damaged-TIME. A record on an intact page may also be
/// damaged: it then does not match its digest, which is stored with it. Such a record is left unchanged. Both kinds of
/// damage are logged.
class SqliteStore final : public Store {
  public:
    using Clock = std::chrono::system_clock;  ///< the wall clock, because times in records must outlive the process

    /// Opens or creates the file. `quota` is the maximum size, in bytes, of the file and its write-ahead log together.
    /// Only while an update larger than an eighth of the quota is saved, the two files may exceed the quota. Throws
    /// StoreError if another server uses the file, or if the file is not a session store of oval4d, is not a regular
    /// file, or is not owned by the user of this process.
    explicit SqliteStore(std::string path, std::size_t quota = kDefaultQuota, ClockFunction<Clock> now = Clock::now);

    WriteTiming writeTiming() const override { return WriteTiming::soon; }
    std::string name() const override { return "sqlite:" + path_; }
    std::optional<std::string> tokenHash(const std::string& id) override;
    bool isDamaged(const std::string& id) override;
    std::optional<SessionRecord> read(const std::string& id) override;
    std::optional<SessionRecord> claim(const std::string& id) override;
    std::vector<SaveResult> save(std::span<const RecordUpdate> updates) override;
    std::size_t evict(std::span<const RecordUpdate> updates, const PinnedPredicate& isPinned) override;
    void remove(std::span<const std::string> ids) override;
    void restartExpiry(std::span<const std::string> ids) override;
    std::size_t expire(Milliseconds age) override;
    std::vector<TakenOverSession> pollTakenOverSessions() override;
    std::size_t size() const override { return size_; }

  private:
    template <typename Work>
    auto runAfterPendingRepair(Work work);
    std::int64_t nowMilliseconds() const;
    void open();
    void checkDatabase();
    void setUp();
    void migrate();
    void salvageDamagedFile(const std::string& why);
    void logDamagedRecords();
    SaveResult saveOne(const RecordUpdate& update);
    std::size_t evictSessionsUntilFits(std::int64_t pagesNeeded, const PinnedPredicate& isPinned);
    std::int64_t usedPages();
    void releasePages(std::int64_t maxPages);

    const std::string path_;
    const std::int64_t maxPages_;
    const ClockFunction<Clock> now_;
    // The open database. Null after a failed repair: the next operation then opens the file again.
    std::unique_ptr<Database> database_;
    std::string damage_;  // the damage that the next operation must repair; empty if there is none
    std::size_t size_ = 0;
};

}  // namespace oval4d::store
