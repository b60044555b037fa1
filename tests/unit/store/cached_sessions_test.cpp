#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "store/cached_sessions.hpp"

namespace oval4d::store {
namespace {

/// An old id in the queue does not queue a session that was added again. Otherwise, an update without changes would
/// overwrite the newest state in the store.
TEST(CachedSessions, AnIdLeftInTheQueueDoesNotQueueTheSessionWhenItIsAddedAgain) {
    CachedSessions sessions;
    sessions.addNew({"id", "secret"});
    sessions.enqueue("id", *sessions.find("id"));
    EXPECT_TRUE(sessions.remove("id"));
    sessions.addStored({"id", "secret"}, 2);
    EXPECT_FALSE(sessions.takeFirstQueued());
    sessions.enqueue("id", *sessions.find("id"));
    EXPECT_EQ(sessions.takeFirstQueued(), "id");
    EXPECT_FALSE(sessions.takeFirstQueued());
}

TEST(CachedSessions, ASessionWithAnIdLeftInTheQueueIsTakenOnce) {
    CachedSessions sessions;
    sessions.addNew({"id", "secret"});
    sessions.enqueue("id", *sessions.find("id"));
    EXPECT_TRUE(sessions.remove("id"));
    sessions.addStored({"id", "secret"}, 2);
    sessions.enqueue("id", *sessions.find("id"));
    EXPECT_EQ(sessions.takeFirstQueued(), "id");
    EXPECT_FALSE(sessions.takeFirstQueued());
}

TEST(CachedSessions, EvictedSessionsLeaveTheQueue) {
    CachedSessions sessions;
    for (const char* const id : {"open", "closed"}) {
        sessions.addNew({id, "secret"});
        CachedSession& cached = *sessions.find(id);
        cached.pending.whole = std::make_shared<const session::Session>();
        sessions.enqueue(id, cached);
    }
    CachedSession& closed = *sessions.find("closed");
    closed.closed = true;
    closed.bytes = 1;
    EXPECT_EQ(sessions.evictClosed(0).size(), 1U);
    EXPECT_EQ(sessions.queueLength(), 1U);
}

/// A session that alone exceeds the quota is evicted first, because it must be evicted in any case. The other sessions
/// can then stay.
TEST(CachedSessions, EvictsSessionsBeyondTheWholeQuotaFirst) {
    CachedSessions sessions;
    CachedSession::Clock::time_point time;
    for (const auto& [id, bytes] : {std::pair("small", 40U), std::pair("large", 200U), std::pair("last", 40U)}) {
        sessions.addNew({id, "secret"});
        CachedSession& cached = *sessions.find(id);
        cached.pending.whole = std::make_shared<const session::Session>();
        cached.closed = true;
        cached.closedAt = time += std::chrono::seconds(1);
        cached.bytes = bytes;
    }
    const auto evicted = sessions.evictClosed(100);
    ASSERT_EQ(evicted.size(), 1U);
    EXPECT_EQ(evicted[0].first, "large");
}

}  // namespace
}  // namespace oval4d::store
