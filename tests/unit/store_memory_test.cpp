#include <gtest/gtest.h>

#include <set>

#include "store/memory_store.hpp"
#include "store/secret.hpp"

namespace oval4d::store {
namespace {

using namespace std::chrono_literals;
using protocol::ErrorCode;

constexpr Time kStart{};

TEST(Secret, NamesAreLongAndDifferent) {
    std::set<std::string> seen;
    for (int i = 0; i < 1000; ++i) {
        const std::string name = randomName(10);
        EXPECT_EQ(name.size(), 16U);
        EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz234567"), std::string::npos);
        EXPECT_TRUE(seen.insert(name).second);
    }
}

TEST(Secret, SameOnlyIfEqual) {
    EXPECT_TRUE(sameSecret("abc", "abc"));
    EXPECT_TRUE(sameSecret("", ""));
    for (const char* other : {"", "ab", "abd", "abcabc", "abcd"}) EXPECT_FALSE(sameSecret(other, "abc")) << other;
    EXPECT_FALSE(sameSecret("abc", ""));
}

TEST(MemoryStore, GivesBackWhatItKept) {
    MemoryStore store(10);
    const auto ticket = store.create();
    ASSERT_TRUE(ticket);
    EXPECT_TRUE(store.admit(*ticket));
    session::Session session;
    session.revision = 42;
    store.close(ticket->id, session, kStart);
    const auto again = store.open(ticket->id);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->revision, 42U);
    EXPECT_EQ(store.open(ticket->id).error().code, ErrorCode::not_found) << "it is in use";
}

TEST(MemoryStore, AdmitsByTokenOnly) {
    MemoryStore store(10);
    const auto one = store.create(), two = store.create();
    EXPECT_EQ(store.admit({one->id, two->token}).error().code, ErrorCode::bad_token);
    EXPECT_EQ(store.admit({one->id, ""}).error().code, ErrorCode::bad_token);
    EXPECT_EQ(store.admit({"none", one->token}).error().code, ErrorCode::not_found);
}

TEST(MemoryStore, ExpiresWhatNobodyUses) {
    MemoryStore store(10);
    const auto used = store.create(), old = store.create(), fresh = store.create();
    store.close(old->id, {}, kStart);
    store.close(fresh->id, {}, kStart + 10s);
    EXPECT_EQ(store.expire(kStart + 5s), 1U);
    EXPECT_TRUE(store.admit(*used));
    EXPECT_TRUE(store.admit(*fresh));
    EXPECT_EQ(store.admit(*old).error().code, ErrorCode::not_found);
    store.close(old->id, {}, kStart);
    EXPECT_EQ(store.size(), 2U);
}

TEST(MemoryStore, IsFullAtItsCapacity) {
    MemoryStore store(2);
    const auto one = store.create(), two = store.create();
    EXPECT_EQ(store.create().error().code, ErrorCode::too_many);
    store.close(one->id, {}, kStart);
    EXPECT_EQ(store.expire(kStart + 1s), 1U);
    EXPECT_TRUE(store.create());
    EXPECT_TRUE(store.admit(*two));
}

}  // namespace
}  // namespace oval4d::store
