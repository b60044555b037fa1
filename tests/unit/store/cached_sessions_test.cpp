#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "store/cached_sessions.hpp"

namespace oval4d::store {
namespace {

/// An update without changes would overwrite the newest state in the store with nothing.
TEST(CachedSessions, AnIdLeftInTheQueueDoesNotQueueTheSessionWhenItIsAddedAgain) {
    CachedSessions sessions;
    sessions.add({"id", "secret"});
    sessions.enqueue("id", *sessions.find("id"));
    EXPECT_TRUE(sessions.remove("id"));
    sessions.addStored({"id", "secret"}, 2);
    EXPECT_FALSE(sessions.takeQueued());
    sessions.enqueue("id", *sessions.find("id"));
    EXPECT_EQ(sessions.takeQueued(), "id");
    EXPECT_FALSE(sessions.takeQueued());
}

TEST(CachedSessions, ASessionWithAnIdLeftInTheQueueIsTakenOnce) {
    CachedSessions sessions;
    sessions.add({"id", "secret"});
    sessions.enqueue("id", *sessions.find("id"));
    EXPECT_TRUE(sessions.remove("id"));
    sessions.addStored({"id", "secret"}, 2);
    sessions.enqueue("id", *sessions.find("id"));
    EXPECT_EQ(sessions.takeQueued(), "id");
    EXPECT_FALSE(sessions.takeQueued());
}

TEST(CachedSessions, EvictedSessionsLeaveTheQueue) {
    CachedSessions sessions;
    for (const char* const id : {"open", "closed"}) {
        sessions.add({id, "secret"});
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

}  // namespace
}  // namespace oval4d::store
