#pragma once
// A session store in the memory of the server process.

#include <map>

#include "store/store.hpp"

namespace oval4d::store {

/// A session store in the memory of this process. All records are lost when the process ends.
class MemoryStore final : public Store {
  public:
    using Clock = std::chrono::steady_clock;

    /// Creates an empty store. `quota` is the maximum total size of all records, in bytes. `now` returns the current
    /// time.
    explicit MemoryStore(std::size_t quota = kDefaultQuota, ClockFunction<Clock> now = Clock::now)
        : quota_(quota), now_(std::move(now)) {}

    WriteTiming writeTiming() const override { return WriteTiming::at_close; }
    std::string name() const override { return "memory"; }
    std::optional<std::string> tokenHash(const std::string& id) override;
    std::optional<SessionRecord> read(const std::string& id) override;
    std::optional<SessionRecord> claim(const std::string& id) override;
    std::vector<SaveResult> save(std::span<const RecordUpdate> updates) override;
    std::size_t evict(std::span<const RecordUpdate> updates, const PinnedPredicate& isPinned) override;
    void remove(std::span<const std::string> ids) override;
    void restartExpiry(std::span<const std::string> ids) override;
    std::size_t expire(Milliseconds age) override;
    std::vector<TakenOverSession> pollTakenOverSessions() override { return {}; }
    std::size_t size() const override { return entries_.size(); }

  private:
    // The record of a session. `touched` is the time of the last claim, save or restartExpiry(). `changed` is the
    // RecordUpdate::changed of the last save.
    struct StoredSession {
        std::string tokenHash, whole, head;
        std::map<std::string, std::string> objects;
        FencingToken fence = 0;
        Clock::time_point touched;
        bool changed = true;

        std::size_t bytes() const;
    };
    using SessionsById = std::map<std::string, StoredSession>;

    std::size_t sizeBoundAfter(std::span<const RecordUpdate> updates) const;
    SessionsById::iterator erase(SessionsById::iterator entry);

    const std::size_t quota_;
    const ClockFunction<Clock> now_;
    std::size_t bytes_ = 0;  // total size of all records in bytes: the sum of StoredSession::bytes()
    SessionsById entries_;
};

}  // namespace oval4d::store
