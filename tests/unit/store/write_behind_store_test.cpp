#include <future>
#include <utility>

#include "hang_limit.hpp"
#include "store/memory_store.hpp"
#include "store/write_behind_store.hpp"
#include "unit/store/faulty_store.hpp"
#include "unit/store/support.hpp"

namespace oval4d::store {
namespace {

using namespace std::chrono_literals;
using session::Session;

/// Tests in virtual time: the thread of the cache reads only the clock of the test.
class WriteBehindStoreTest : public testing::Test {
  protected:
    /// `quota` is the quota of the cache, and `storeQuota` the quota of the store behind the cache, in bytes.
    explicit WriteBehindStoreTest(std::size_t quota = kDefaultQuota, std::size_t storeQuota = kDefaultQuota)
        : control(std::make_shared<StoreControl>(storeQuota)), settings{1h, 100, quota} {}

    WriteBehindStore::FetchResult fetch(const SessionCredentials& credentials) {
        std::promise<WriteBehindStore::FetchResult> promise;
        writeBehind.claimAndFetch(credentials,
                                  [&](WriteBehindStore::FetchResult fetch) { promise.set_value(std::move(fetch)); });
        return promise.get_future().get();
    }
    bool save(const std::string& id, const Session& session,
              WriteBehindStore::SaveScope scope = WriteBehindStore::SaveScope::whole,
              FencingToken fence = kFirstFence) {
        std::promise<bool> promise;
        writeBehind.save(id, fence, session, scope, [&](bool ours) { promise.set_value(ours); });
        return promise.get_future().get();
    }
    /// Waits until `happened` returns true. The clock stands still.
    void atOnce(const std::function<bool()>& happened) {
        EXPECT_TRUE(support::eventually(happened, [&] { wake(); }));
    }
    /// Waits until `happened` returns true. The clock advances.
    void eventually(const std::function<bool()>& happened) {
        EXPECT_TRUE(support::eventually(happened, [&] {
            control->clock.advance(10ms);
            wake();
        }));
    }
    /// Makes the thread of the cache read the clock. Saving an unknown session has no other effect.
    void wake() { writeBehind.save("nobody", kFirstFence, {}, WriteBehindStore::SaveScope::head); }
    Session at(std::uint64_t revision) const {
        Session session;
        session.revision = revision;
        return session;
    }
    std::uint64_t kept(const std::string& id) {
        const std::lock_guard lock(control->mutex);
        const auto record = control->kept.claim(id);
        return record
                   ? decodeSession(
                         record->whole, record->head, [](const std::string&) { return std::nullopt; }, support::cache())
                         .revision
                   : 0;
    }

    const std::shared_ptr<StoreControl> control;
    std::atomic<int> taken = 0, wanted = 0, back = 0;
    const WriteBehindStore::WriteBehindSettings settings;
    WriteBehindStore writeBehind{std::make_unique<FaultyStore>(control),
                                 settings,
                                 {[this](const std::string&) { ++taken; }, [this](const std::string&) { ++wanted; },
                                  [this] { ++back; }, [](const char*, double, bool) {}},
                                 control->clock.now<WriteBehindStore::Clock>()};
};

TEST_F(WriteBehindStoreTest, SavedSessionsAreInTheStore) {
    const SessionCredentials credentials = writeBehind.createSession();
    EXPECT_EQ(writeBehind.sessionCount(), 1U);
    EXPECT_TRUE(save(credentials.id, at(5)));
    EXPECT_EQ(writeBehind.unsaved(), 0U);
    EXPECT_EQ(kept(credentials.id), 5U);
}

TEST_F(WriteBehindStoreTest, FetchRequiresTheToken) {
    const SessionCredentials credentials = writeBehind.createSession();
    writeBehind.closeSession(credentials.id, at(3));
    eventually([&] { return writeBehind.unsaved() == 0; });
    EXPECT_EQ(fetch({credentials.id, "wrong"}).error().code, ErrorCode::bad_token);
    EXPECT_EQ(fetch({"nobody", credentials.token}).error().code, ErrorCode::not_found);
    const auto fetched = fetch(credentials);
    ASSERT_TRUE(fetched);
    EXPECT_FALSE(fetched->record.whole.empty());
}

TEST_F(WriteBehindStoreTest, AFailingStoreDoesNotDelayCallers) {
    const SessionCredentials credentials = writeBehind.createSession();
    control->fails = true;
    EXPECT_TRUE(save(credentials.id, at(1)));
    eventually([&] { return !writeBehind.lastError().empty(); });
    EXPECT_TRUE(save(credentials.id, at(2)));
    EXPECT_EQ(fetch({"other", "x"}).error().code, ErrorCode::internal) << "not not_found";
    const SessionCredentials closed = writeBehind.createSession();
    writeBehind.closeSession(closed.id, at(9));
    EXPECT_EQ(fetch({closed.id, "wrong"}).error().code, ErrorCode::bad_token);
    const auto again = fetch(closed);
    ASSERT_TRUE(again && again->session) << "it is still in memory";
    EXPECT_EQ(again->session->revision, 9U);
    EXPECT_EQ(again->record.fence, kFirstFence);
    EXPECT_EQ(writeBehind.unsaved(), 2U);
    control->fails = false;
    eventually([&] { return writeBehind.unsaved() == 0; });
    eventually([&] { return back == 1; });
    EXPECT_EQ(writeBehind.lastError(), "");
    EXPECT_EQ(kept(credentials.id), 2U);
    EXPECT_EQ(kept(closed.id), 9U);
}

TEST_F(WriteBehindStoreTest, DoesNotWriteSessionsClaimedByOthers) {
    const SessionCredentials credentials = writeBehind.createSession();
    EXPECT_TRUE(save(credentials.id, at(1)));
    {
        const std::lock_guard lock(control->mutex);
        control->kept.claim(credentials.id);
    }
    EXPECT_FALSE(save(credentials.id, at(2)));
    EXPECT_EQ(taken, 1);
    EXPECT_FALSE(save(credentials.id, at(3))) << "nor later";
    EXPECT_EQ(kept(credentials.id), 1U);
}

/// A session stays open if another server has claimed it and this server has claimed it back before the next poll.
TEST_F(WriteBehindStoreTest, KeepsSessionsThatItHasClaimedBack) {
    const SessionCredentials credentials = writeBehind.createSession();
    writeBehind.closeSession(credentials.id, at(1));
    eventually([&] { return writeBehind.unsaved() == 0; });
    const auto fetched = fetch(credentials);
    ASSERT_TRUE(fetched);
    const FencingToken own = fetched->record.fence;
    const auto poll = [&](FencingToken fence) {
        {
            const std::lock_guard lock(control->mutex);
            control->lost.push_back({credentials.id, fence});
        }
        eventually([&] {
            const std::lock_guard lock(control->mutex);
            return control->lost.empty();
        });
    };
    poll(own - 1);
    poll(own);
    EXPECT_TRUE(save(credentials.id, at(2), WriteBehindStore::SaveScope::whole, own));
    EXPECT_EQ(taken, 0);
    poll(own + 1);
    eventually([&] { return taken == 1; });
    EXPECT_FALSE(save(credentials.id, at(3), WriteBehindStore::SaveScope::whole, own));
}

TEST_F(WriteBehindStoreTest, CountsChangesThatWillSoonBeSaved) {
    const SessionCredentials credentials = writeBehind.createSession();
    EXPECT_TRUE(save(credentials.id, at(1)));
    EXPECT_EQ(writeBehind.unsaved(), 0U);
    writeBehind.recordUnsavedChange(credentials.id, kFirstFence + 1);
    writeBehind.recordUnsavedChange("nobody", kFirstFence);
    EXPECT_EQ(writeBehind.unsaved(), 0U);
    writeBehind.recordUnsavedChange(credentials.id, kFirstFence);
    EXPECT_EQ(writeBehind.unsaved(), 1U);
    EXPECT_TRUE(save(credentials.id, at(2), WriteBehindStore::SaveScope::head));
    EXPECT_EQ(writeBehind.unsaved(), 0U);
    writeBehind.recordUnsavedChange(credentials.id, kFirstFence);
    writeBehind.closeSession(credentials.id, at(3));
    eventually([&] { return writeBehind.unsaved() == 0; });
}

/// The cache knows whether it still owns a fetched session. So the server does not serve a session that another server
/// has claimed while the record was decoded.
TEST_F(WriteBehindStoreTest, KnowsWhetherItStillOwnsAFetchedSession) {
    const SessionCredentials credentials = writeBehind.createSession();
    EXPECT_TRUE(writeBehind.ownsSession(credentials.id, kFirstFence));
    writeBehind.closeSession(credentials.id, at(1));
    eventually([&] { return writeBehind.unsaved() == 0; });
    EXPECT_FALSE(writeBehind.ownsSession(credentials.id, kFirstFence));
    const auto fetched = fetch(credentials);
    ASSERT_TRUE(fetched);
    const FencingToken own = fetched->record.fence;
    EXPECT_TRUE(writeBehind.ownsSession(credentials.id, own));
    EXPECT_FALSE(writeBehind.ownsSession(credentials.id, kFirstFence));
    {
        const std::lock_guard lock(control->mutex);
        control->lost.push_back({credentials.id, own + 1});
    }
    eventually([&] { return !writeBehind.ownsSession(credentials.id, own); });
    writeBehind.setStoredKeys(credentials.id, {});
    EXPECT_FALSE(writeBehind.ownsSession(credentials.id, own));
}

/// A save with the fence of an earlier fetch is refused. A command may end after another server has claimed the session
/// and this server has fetched it again.
TEST_F(WriteBehindStoreTest, DoesNotSaveAnEarlierFetchOfASession) {
    const SessionCredentials credentials = writeBehind.createSession();
    EXPECT_TRUE(save(credentials.id, at(1)));
    {
        const std::lock_guard lock(control->mutex);
        control->kept.claim(credentials.id);
    }
    EXPECT_FALSE(save(credentials.id, at(2)));
    const auto fetched = fetch(credentials);
    ASSERT_TRUE(fetched);
    const FencingToken own = fetched->record.fence;
    EXPECT_TRUE(save(credentials.id, at(3), WriteBehindStore::SaveScope::head, own));
    EXPECT_FALSE(save(credentials.id, at(9)));
    EXPECT_TRUE(save(credentials.id, at(4), WriteBehindStore::SaveScope::head, own));
    EXPECT_EQ(kept(credentials.id), 4U);
}

TEST_F(WriteBehindStoreTest, RequestsSessionsThatTheStoreLacks) {
    const SessionCredentials credentials = writeBehind.createSession();
    writeBehind.save(credentials.id, kFirstFence, at(1), WriteBehindStore::SaveScope::head);
    eventually([&] { return wanted == 1; });
    EXPECT_TRUE(save(credentials.id, at(2)));
    EXPECT_EQ(kept(credentials.id), 2U);
}

TEST_F(WriteBehindStoreTest, WritesTheNewestOfManyChanges) {
    const SessionCredentials credentials = writeBehind.createSession();
    EXPECT_TRUE(save(credentials.id, at(1)));
    for (std::uint64_t i = 2; i < 5000; ++i)
        writeBehind.save(credentials.id, kFirstFence, at(i), WriteBehindStore::SaveScope::head);
    EXPECT_TRUE(save(credentials.id, at(5000), WriteBehindStore::SaveScope::head));
    EXPECT_EQ(kept(credentials.id), 5000U);
    EXPECT_LT(control->saves, 5000);
}

/// Changes are written even if requests always wait. Here, each fetch requests the next fetch.
TEST_F(WriteBehindStoreTest, WritesBetweenFetches) {
    constexpr int kMost = 1000;
    const SessionCredentials credentials = writeBehind.createSession();
    std::atomic<bool> saved = false;
    int fetches = 0;  // used only on the cache's thread
    std::promise<int> ended;
    const std::function<void(WriteBehindStore::FetchResult)> next = [&](const WriteBehindStore::FetchResult&) {
        if (fetches == 0)
            writeBehind.save(credentials.id, kFirstFence, at(1), WriteBehindStore::SaveScope::whole,
                             [&](bool) { saved = true; });
        if (saved || ++fetches == kMost) return ended.set_value(fetches);
        writeBehind.claimAndFetch({"nobody", ""}, next);
    };
    writeBehind.claimAndFetch({"nobody", ""}, next);
    EXPECT_LT(ended.get_future().get(), kMost);
    EXPECT_EQ(kept(credentials.id), 1U);
}

TEST_F(WriteBehindStoreTest, ForgetsClosedSessionsOnly) {
    const SessionCredentials open = writeBehind.createSession(), closed = writeBehind.createSession(),
                             waiting = writeBehind.createSession();
    EXPECT_TRUE(save(open.id, at(1)));
    writeBehind.closeSession(closed.id, at(2));
    eventually([&] { return writeBehind.unsaved() == 0; });
    writeBehind.remove(open.id);
    writeBehind.remove(closed.id);
    EXPECT_EQ(fetch(closed).error().code, ErrorCode::not_found);
    EXPECT_TRUE(save(open.id, at(3))) << "it is still open";
    EXPECT_EQ(kept(open.id), 3U);
    EXPECT_EQ(kept(closed.id), 0U);
    control->fails = true;
    writeBehind.closeSession(waiting.id, at(4));
    eventually([&] { return !writeBehind.lastError().empty(); });
    writeBehind.remove(waiting.id);
    EXPECT_EQ(fetch(waiting).error().code, ErrorCode::not_found);
    control->fails = false;
    eventually([&] { return writeBehind.lastError().empty(); });
    EXPECT_EQ(kept(waiting.id), 0U);
    writeBehind.remove("nobody");
    EXPECT_EQ(writeBehind.unsaved(), 0U);
}

/// Objects are written again after a failure, because the store may have lost them. Otherwise, an object is written
/// only once.
TEST_F(WriteBehindStoreTest, WritesPolytopesAgainAfterAFailure) {
    const SessionCredentials credentials = writeBehind.createSession();
    Session session;
    ASSERT_TRUE(session::apply(session, ownObject("own", 1)));
    EXPECT_TRUE(save(credentials.id, session));
    control->fails = true;
    writeBehind.save(credentials.id, kFirstFence, session, WriteBehindStore::SaveScope::whole);
    eventually([&] { return !writeBehind.lastError().empty(); });
    {
        const std::lock_guard lock(control->mutex);
        const std::vector<std::string> ids{credentials.id};
        control->kept.remove(ids);
    }
    control->fails = false;
    eventually([&] { return writeBehind.unsaved() == 0 && writeBehind.lastError().empty(); });
    const std::lock_guard lock(control->mutex);
    const auto record = control->kept.claim(credentials.id);
    ASSERT_TRUE(record);
    EXPECT_EQ(record->objects.size(), 1U);
}

class SmallWriteBehindStoreTest : public WriteBehindStoreTest {
  protected:
    SmallWriteBehindStoreTest() : WriteBehindStoreTest(100'000) {}
};

/// While the store is unavailable, the quota limits the closed sessions in memory. Sessions that were never changed are
/// evicted first, and then the oldest.
TEST_F(SmallWriteBehindStoreTest, EvictsClosedSessionsBeyondTheQuota) {
    control->fails = true;
    eventually([&] { return !writeBehind.lastError().empty(); });
    const SessionCredentials open = writeBehind.createSession();
    writeBehind.save(open.id, kFirstFence, at(1), WriteBehindStore::SaveScope::whole);
    std::vector<SessionCredentials> credentialsList;
    for (int i = 0; i < 2000; ++i) {
        credentialsList.push_back(writeBehind.createSession());
        writeBehind.closeSession(credentialsList.back().id, at(i == 1999 ? 1 : 0));
        control->clock.advance(1us);
    }
    writeBehind.closeSession(writeBehind.createSession().id, Session{});
    EXPECT_LT(writeBehind.unsaved(), 300U);
    EXPECT_GT(writeBehind.unsaved(), 10U);
    EXPECT_EQ(writeBehind.sessionCount(), writeBehind.unsaved());
    control->fails = false;
    eventually([&] { return writeBehind.unsaved() == 0; });
    const std::lock_guard lock(control->mutex);
    EXPECT_TRUE(control->kept.tokenHash(open.id)) << "it is open";
    EXPECT_TRUE(control->kept.tokenHash(credentialsList[1999].id));
    EXPECT_FALSE(control->kept.tokenHash(credentialsList[0].id));
}

class FullStoreTest : public WriteBehindStoreTest {
  protected:
    FullStoreTest() : WriteBehindStoreTest(kDefaultQuota, 15'000) {}
};

/// If a session would not fit into the store even after all evictions, no other session is evicted.
TEST_F(FullStoreTest, EvictsNoSessionsInVain) {
    const auto stored = [&] {
        const std::lock_guard lock(control->mutex);
        return control->kept.size();
    };
    for (int i = 0; i < 30; ++i) {
        writeBehind.closeSession(writeBehind.createSession().id, at(1));
        atOnce([&] { return writeBehind.unsaved() == 0; });
        control->clock.advance(1us);
    }
    const std::size_t before = stored();
    ASSERT_GT(before, 3U);
    ASSERT_LT(before, 30U) << "the store is full";
    std::string points = "CLOUD\n";
    for (int i = 0; i < 3000; ++i) {
        for (const int period : {3000, 3, 5, 7}) points += std::to_string(0.1 * (i % period)) + " ";
        points += "\n";
    }
    Session large;
    ASSERT_TRUE(session::apply(large, session::LoadObject{"cloud", "cloud", points}));
    const SessionCredentials tooLarge = writeBehind.createSession(), small = writeBehind.createSession();
    writeBehind.save(tooLarge.id, kFirstFence, large, WriteBehindStore::SaveScope::whole);
    atOnce([&] { return !writeBehind.lastError().empty(); });
    EXPECT_EQ(stored(), before);
    writeBehind.save(small.id, kFirstFence, at(1), WriteBehindStore::SaveScope::whole);
    const auto isStored = [&](const SessionCredentials& credentials) {
        const std::lock_guard lock(control->mutex);
        return control->kept.tokenHash(credentials.id).has_value();
    };
    eventually([&] { return isStored(small); });
    EXPECT_FALSE(isStored(tooLarge));
    EXPECT_GE(stored(), before - 1) << "only as many are evicted as the small session needs";
}

TEST_F(WriteBehindStoreTest, RetriesAfterLongerAndLongerPauses) {
    control->fails = true;
    const SessionCredentials credentials = writeBehind.createSession();
    writeBehind.save(credentials.id, kFirstFence, at(1), WriteBehindStore::SaveScope::whole);
    atOnce([&] { return !writeBehind.lastError().empty(); });
    for (const Milliseconds longest : {100ms, 200ms, 400ms, 800ms, 1600ms, 3200ms, 5000ms, 5000ms}) {
        const int attempts = control->attempts;
        const std::string error = writeBehind.lastError();
        control->clock.advance(longest / 2 - 1ms);
        EXPECT_EQ(fetch({"nobody", ""}).error().code, ErrorCode::internal);
        EXPECT_EQ(control->attempts, attempts) << "the pause has at least half of its greatest length";
        control->clock.advance(longest / 2 + 1ms);
        atOnce([&] { return writeBehind.lastError() != error; });
        EXPECT_EQ(control->attempts, attempts + 1);
    }
}

TEST_F(WriteBehindStoreTest, ClosedSessionsExpireAndOpenOnesDoNot) {
    const SessionCredentials open = writeBehind.createSession(), closed = writeBehind.createSession();
    EXPECT_TRUE(save(open.id, at(1)));
    writeBehind.closeSession(closed.id, at(1));
    eventually([&] { return writeBehind.unsaved() == 0; });
    const auto isStored = [&](const SessionCredentials& credentials) {
        const std::lock_guard lock(control->mutex);
        return control->kept.tokenHash(credentials.id).has_value();
    };
    EXPECT_TRUE(isStored(closed));
    for (int quarter = 0; quarter < 5; ++quarter) {
        const int refreshes = control->refreshes;
        control->clock.advance(15min);
        atOnce([&] { return control->refreshes > refreshes; });
    }
    EXPECT_TRUE(isStored(open));
    EXPECT_FALSE(isStored(closed));
}

TEST_F(WriteBehindStoreTest, WritesAPolytopeOnce) {
    const SessionCredentials credentials = writeBehind.createSession();
    Session session;
    ASSERT_TRUE(session::apply(session, ownObject("own", 1)));
    const auto polytopes = [&] {
        const std::lock_guard lock(control->mutex);
        return control->kept.claim(credentials.id)->objects;
    };
    writeBehind.save(credentials.id, kFirstFence, Session{}, WriteBehindStore::SaveScope::whole);
    writeBehind.save(credentials.id, kFirstFence, session, WriteBehindStore::SaveScope::head);
    EXPECT_TRUE(save(credentials.id, session));
    const auto first = writeBehind.unsaved() == 0 ? polytopes() : decltype(polytopes()){};
    ASSERT_EQ(first.size(), 1U);
    EXPECT_EQ(first[0].second, encodeObjectRecord(session.loaded.at("own")));
}

TEST_F(WriteBehindStoreTest, StopWritesPendingChanges) {
    std::vector<SessionCredentials> credentialsList;
    for (std::uint64_t i = 1; i <= 600; ++i) {
        credentialsList.push_back(writeBehind.createSession());
        writeBehind.closeSession(credentialsList.back().id, at(i));
    }
    writeBehind.stop(support::hangLimit());
    for (std::uint64_t i = 1; i <= 600; ++i) EXPECT_EQ(kept(credentialsList[i - 1].id), i);
}

}  // namespace
}  // namespace oval4d::store
