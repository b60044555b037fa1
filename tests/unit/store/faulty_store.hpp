#pragma once
// A session store that tests can observe and make fail.

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "store/memory_store.hpp"
#include "store/store.hpp"
#include "unit/parallel/virtual_clock.hpp"

namespace oval4d::store {

/// The controls of a FaultyStore, and what a test observes of it.
struct StoreControl {
    explicit StoreControl(std::size_t quota = kDefaultQuota,
                          Store::WriteTiming writeTiming = Store::WriteTiming::at_once)
        : policy(writeTiming), kept(quota, clock.now<MemoryStore::Clock>()) {}

    const Store::WriteTiming policy;
    support::VirtualClock clock;
    std::atomic<bool> fails = false;
    // The numbers of all operations, of saved updates, and of calls of expire().
    std::atomic<int> attempts = 0, saves = 0, refreshes = 0;
    std::mutex mutex;
    MemoryStore kept;  // guarded by mutex
    // The updates of all successful calls of save(), in order. Guarded by mutex.
    std::vector<RecordUpdate> updates;
    std::vector<TakenOverSession> lost;  // result of the next poll; guarded by mutex
};

/// A session store in memory that a test controls. The test chooses its write policy, and whether its operations fail.
class FaultyStore final : public Store {
  public:
    explicit FaultyStore(std::shared_ptr<StoreControl> control) : control_(std::move(control)) {}
    WriteTiming writeTiming() const override { return control_->policy; }
    std::string name() const override { return "faulty"; }
    std::optional<std::string> tokenHash(const std::string& id) override {
        return attempt([&](MemoryStore& kept) { return kept.tokenHash(id); });
    }
    std::optional<SessionRecord> read(const std::string& id) override {
        return attempt([&](MemoryStore& kept) { return kept.read(id); });
    }
    std::optional<SessionRecord> claim(const std::string& id) override {
        return attempt([&](MemoryStore& kept) { return kept.claim(id); });
    }
    std::vector<SaveResult> save(std::span<const RecordUpdate> updates) override {
        return attempt([&](MemoryStore& kept) {
            control_->saves += static_cast<int>(updates.size());
            auto results = kept.save(updates);
            control_->updates.insert(control_->updates.end(), updates.begin(), updates.end());
            return results;
        });
    }
    std::size_t evict(std::span<const RecordUpdate> updates, const PinnedPredicate& isPinned) override {
        return attempt([&](MemoryStore& kept) { return kept.evict(updates, isPinned); });
    }
    void remove(std::span<const std::string> ids) override {
        attempt([&](MemoryStore& kept) { kept.remove(ids); });
    }
    void restartExpiry(std::span<const std::string> ids) override {
        attempt([&](MemoryStore& kept) { kept.restartExpiry(ids); });
    }
    std::size_t expire(Milliseconds age) override {
        return attempt([&](MemoryStore& kept) {
            ++control_->refreshes;
            return kept.expire(age);
        });
    }
    std::vector<TakenOverSession> pollTakenOverSessions() override {
        return attempt([&](MemoryStore& /*kept*/) { return std::exchange(control_->lost, {}); });
    }
    std::size_t size() const override {
        const std::lock_guard lock(control_->mutex);
        return control_->kept.size();
    }

  private:
    template <typename Operation>
    std::invoke_result_t<Operation, MemoryStore&> attempt(Operation operation) {
        const std::lock_guard lock(control_->mutex);
        ++control_->attempts;
        if (control_->fails) throw StoreError("failure requested by the test: " + std::to_string(control_->attempts));
        return operation(control_->kept);
    }
    const std::shared_ptr<StoreControl> control_;
};

}  // namespace oval4d::store
