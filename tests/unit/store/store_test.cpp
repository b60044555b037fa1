// Tests that all session stores must pass, and tests of the order in which stores with a quota evict sessions.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "store/memory_store.hpp"
#include "store/secret.hpp"
#include "store/sqlite_store.hpp"
#include "unit/parallel/virtual_clock.hpp"
#include "unit/store/redis_server.hpp"
#include "unit/store/temporary_folder.hpp"

namespace oval4d::store {
namespace {

using namespace std::chrono_literals;

class AnyStore : public testing::TestWithParam<std::string> {
  protected:
    void SetUp() override {
        if (GetParam() == "memory")
            store = std::make_unique<MemoryStore>(kDefaultQuota, clock.now<MemoryStore::Clock>());
        if (GetParam() == "sqlite")
            store = std::make_unique<SqliteStore>(folder.path / "sessions.sqlite", kDefaultQuota,
                                                  clock.now<SqliteStore::Clock>());
        if (GetParam() == "redis") {
            redis = std::make_unique<Redis>();
            store = redis->connect();
        }
        ASSERT_TRUE(store) << "is redis-server installed?";
    }

    RecordUpdate whole(FencingToken fence, const std::string& bytes, const std::string& id = "one") const {
        return {{id, "secret of " + id}, fence, "", bytes, {}, {}, false};
    }
    RecordUpdate head(FencingToken fence, const std::string& bytes) const {
        return {{"one", "secret of one"}, fence, bytes, "", {}, {}, false};
    }
    SaveResult save(const RecordUpdate& update) { return store->save({&update, 1}).at(0); }

    support::VirtualClock clock;
    Folder folder;
    std::unique_ptr<Redis> redis;
    std::unique_ptr<Store> store;
};

INSTANTIATE_TEST_SUITE_P(Stores, AnyStore, testing::Values("memory", "sqlite", "redis"),
                         [](const auto& kind) { return kind.param; });

/// Tests of stores that must be asked to remove expired sessions.
class ExpiringStore : public AnyStore {};

INSTANTIATE_TEST_SUITE_P(Stores, ExpiringStore, testing::Values("memory", "sqlite"),
                         [](const auto& kind) { return kind.param; });

// Records that contain any bytes must be kept.
const std::string kBytes("a\0b\r\n\xff", 6);

TEST_P(AnyStore, ReturnsSavedRecords) {
    EXPECT_FALSE(store->tokenHash("one"));
    EXPECT_FALSE(store->claim("one"));
    EXPECT_EQ(save(whole(1, kBytes)), SaveResult::saved);
    EXPECT_EQ(store->tokenHash("one"), hashToken("secret of one"));
    auto record = store->claim("one");
    ASSERT_TRUE(record);
    EXPECT_EQ(record->whole, kBytes);
    EXPECT_EQ(record->head, "");
    EXPECT_EQ(record->fence, 2U);
    EXPECT_EQ(save(head(2, "newer")), SaveResult::saved);
    record = store->claim("one");
    EXPECT_EQ(record->whole + "|" + record->head, kBytes + "|newer");
    EXPECT_EQ(save(whole(3, "newest")), SaveResult::saved);
    record = store->claim("one");
    EXPECT_EQ(record->whole + "|" + record->head, "newest|") << "the head is replaced";
    store->pollTakenOverSessions();
    EXPECT_EQ(store->size(), 1U);
}

TEST_P(AnyStore, ReadingDoesNotClaim) {
    EXPECT_FALSE(store->read("one"));
    RecordUpdate update = whole(1, kBytes);
    update.objects = {{"p", "bytes"}};
    EXPECT_EQ(save(update), SaveResult::saved);
    for (int i = 0; i < 2; ++i) {
        const auto record = store->read("one");
        ASSERT_TRUE(record);
        EXPECT_EQ(record->whole, kBytes);
        EXPECT_EQ(record->head, "");
        EXPECT_EQ(record->objects, update.objects);
        EXPECT_EQ(record->fence, 1U);
    }
    EXPECT_EQ(save(head(1, "newer")), SaveResult::saved) << "the session is still that of its server";
    EXPECT_EQ(store->read("one")->head, "newer");
}

TEST_P(AnyStore, RefusesUpdatesWithAnOldFence) {
    EXPECT_EQ(save(whole(1, "first")), SaveResult::saved);
    EXPECT_EQ(store->claim("one")->fence, 2U);
    EXPECT_EQ(save(whole(1, "late")), SaveResult::claimed);
    EXPECT_EQ(save(head(1, "late")), SaveResult::claimed);
    EXPECT_EQ(save(head(2, "in time")), SaveResult::saved);
    const auto record = store->claim("one");
    EXPECT_EQ(record->whole + record->head, "firstin time");
}

TEST_P(AnyStore, SaveReturnsAResultForEachUpdate) {
    EXPECT_EQ(save(whole(1, "a")), SaveResult::saved);
    store->claim("one");
    RecordUpdate headless = head(1, "x");
    headless.credentials.id = "three";
    const std::vector<RecordUpdate> updates{whole(1, "late"), whole(1, "b", "two"), headless};
    EXPECT_EQ(store->save(updates), (std::vector{SaveResult::claimed, SaveResult::saved, SaveResult::missing}));
    EXPECT_EQ(store->claim("two")->whole, "b");
    EXPECT_FALSE(store->claim("three"));
}

TEST_P(AnyStore, StoresThePolytopesOfASession) {
    RecordUpdate update = whole(1, "s");
    update.objects = {{"p", kBytes}, {"q", "bytes of q"}};
    EXPECT_EQ(save(update), SaveResult::saved);
    EXPECT_EQ(save(whole(1, "other", "two")), SaveResult::saved);
    auto polytopes = store->claim("one")->objects;
    std::ranges::sort(polytopes);
    EXPECT_EQ(polytopes, update.objects);
    EXPECT_TRUE(store->claim("two")->objects.empty());
    update = whole(2, "s");
    update.objects = {{"r", "bytes of r"}};
    update.dropped = {"p", "q"};
    EXPECT_EQ(save(update), SaveResult::saved);
    EXPECT_EQ(store->claim("one")->objects, update.objects);
}

TEST_P(ExpiringStore, ExpiresUntouchedSessions) {
    save(whole(1, "old"));
    save(whole(1, "open", "two"));
    save(whole(1, "claimed", "three"));
    clock.advance(1h - 1ms);
    const std::vector<std::string> open{"two"};
    store->restartExpiry(open);
    store->claim("three");
    EXPECT_EQ(store->expire(1h), 0U);
    clock.advance(2ms);
    EXPECT_EQ(store->expire(1h), 1U);
    EXPECT_FALSE(store->tokenHash("one"));
    EXPECT_TRUE(store->tokenHash("two"));
    EXPECT_TRUE(store->tokenHash("three"));
    store->pollTakenOverSessions();
    EXPECT_EQ(store->size(), 2U);
    clock.advance(1h);
    EXPECT_EQ(store->expire(1h), 2U);
}

TEST_P(AnyStore, RemovesSessionsWithTheirPolytopes) {
    RecordUpdate update = whole(1, "s");
    update.objects = {{"p", "bytes of p"}};
    update.closed = true;
    save(update);
    save(whole(1, "other", "two"));
    const std::vector<std::string> ids{"one", "nobody"};
    store->remove(ids);
    EXPECT_FALSE(store->claim("one"));
    EXPECT_TRUE(store->claim("two"));
    EXPECT_EQ(save(whole(1, "again")), SaveResult::saved);
    EXPECT_TRUE(store->claim("one")->objects.empty());
}

/// Expects that a store with a quota of 1 MiB evicts sessions in the right order.
void expectEvictionOrder(Store& store, support::VirtualClock& clock, std::size_t bytes) {
    const auto saved = [&](const std::string& id, bool changed, std::size_t size) {
        const RecordUpdate update{{id, "secret"}, 1, "", std::string(size, 'x'), {}, {}, true, changed};
        store.save({&update, 1});
        clock.advance(1ms);
    };
    saved("changed, old", true, 100'000);
    saved("held", false, 100'000);
    saved("as created", false, 100'000);
    saved("changed, new", true, 100'000);
    const RecordUpdate large{{"large", "secret"}, 1, "", std::string(bytes, 'x'), {}, {}, false, true};
    const auto isPinned = [](const std::string& id) { return id == "held" || id == "large"; };
    for (int i = 0; i < 10; ++i) saved("filler " + std::to_string(i), i > 0, 20'000);
    EXPECT_THROW(store.save({&large, 1}), StoreNotWritable);
    EXPECT_FALSE(store.tokenHash("large"));
    EXPECT_GT(store.evict({&large, 1}, isPinned), 0U);
    EXPECT_TRUE(store.tokenHash("held"));
    EXPECT_FALSE(store.tokenHash("as created"));
    EXPECT_TRUE(store.tokenHash("changed, new"));
    EXPECT_TRUE(store.tokenHash("filler 9"));
    EXPECT_EQ(store.save({&large, 1}).at(0), SaveResult::saved);
    // An update with the first size does not fit beside the pinned sessions. An update with the second size does not
    // even fit into the empty store.
    for (const std::size_t size : {2 * bytes, std::size_t{2'000'000}}) {
        const RecordUpdate largest{{"largest", "secret"}, 1, "", std::string(size, 'x'), {}, {}, false, true};
        EXPECT_THROW(store.save({&largest, 1}), StoreNotWritable);
        EXPECT_EQ(store.evict({&largest, 1}, isPinned), 0U);
        EXPECT_THROW(store.save({&largest, 1}), StoreNotWritable);
        EXPECT_TRUE(store.tokenHash("held") && store.tokenHash("large"));
        EXPECT_TRUE(store.tokenHash("changed, new")) << "no session is evicted in vain";
    }
}

TEST(MemoryStore, EvictsInOrder) {
    support::VirtualClock clock;
    MemoryStore store(1U << 20U, clock.now<MemoryStore::Clock>());
    expectEvictionOrder(store, clock, 500'000);
}

TEST(SqliteStore, EvictsInOrder) {
    const Folder folder;
    support::VirtualClock clock;
    SqliteStore store(folder.path / "sessions", 1U << 20U, clock.now<SqliteStore::Clock>());
    expectEvictionOrder(store, clock, 250'000);
}

}  // namespace
}  // namespace oval4d::store
