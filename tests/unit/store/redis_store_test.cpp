#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "store/redis_store.hpp"
#include "store/secret.hpp"
#include "unit/parallel/virtual_clock.hpp"
#include "unit/store/redis_server.hpp"

namespace oval4d::store {
namespace {

using namespace std::chrono_literals;

TEST(RedisStore, ExpiresUntouchedSessions) {
    const Redis redis;
    const auto brief = redis.connect(1h), lasting = redis.connect(3h);
    ASSERT_TRUE(brief && lasting);
    const auto expectExpiry = [&](Milliseconds longest) {
        for (const char* key : {"oval4d:{id}", "oval4d:{id}:polytopes"}) {
            EXPECT_GT(redis.expiryOf(key), longest - 1h) << key;
            EXPECT_LE(redis.expiryOf(key), longest) << key;
        }
    };
    const RecordUpdate update{{"id", "secret"}, 1, "", "whole", {{"p", "bytes"}}, {}, false};
    EXPECT_EQ(brief->save({&update, 1}).at(0), SaveResult::saved);
    expectExpiry(1h);
    const std::vector<std::string> ids{"id"};
    lasting->restartExpiry(ids);
    expectExpiry(3h);
    EXPECT_TRUE(brief->read("id"));
    expectExpiry(3h);
    brief->claim("id");
    expectExpiry(1h);
    EXPECT_TRUE(lasting->claim("id"));
    expectExpiry(3h);
}

TEST(RedisStore, PollReturnsSessionsClaimedByOthers) {
    const Redis redis;
    const auto one = redis.connect(), two = redis.connect();
    ASSERT_TRUE(one && two);
    const RecordUpdate update{{"id", "secret"}, 1, "", "whole", {}, {}, false};
    EXPECT_EQ(one->save({&update, 1}).at(0), SaveResult::saved);
    EXPECT_TRUE(two->read("id"));
    EXPECT_TRUE(one->pollTakenOverSessions().empty()) << "a session that is only read is not taken over";
    EXPECT_EQ(two->claim("id")->fence, 2U);
    EXPECT_EQ(one->pollTakenOverSessions(), (std::vector<TakenOverSession>{{"id", 2}}));
    EXPECT_TRUE(one->pollTakenOverSessions().empty()) << "returned only once";
    EXPECT_EQ(one->save({&update, 1}).at(0), SaveResult::claimed);
    const RecordUpdate last{{"id", "secret"}, 2, "", "whole", {}, {}, true};
    EXPECT_EQ(two->save({&last, 1}).at(0), SaveResult::saved);
    EXPECT_EQ(one->claim("id")->fence, 3U);
    EXPECT_TRUE(two->pollTakenOverSessions().empty()) << "the server had closed the session itself";
}

TEST(RedisStore, PollTellsTheFenceOfSessionsThatTheServerHasClaimedBack) {
    const Redis redis;
    const auto one = redis.connect(), two = redis.connect();
    ASSERT_TRUE(one && two);
    const RecordUpdate update{{"id", "secret"}, 1, "", "whole", {}, {}, false};
    EXPECT_EQ(one->save({&update, 1}).at(0), SaveResult::saved);
    EXPECT_EQ(two->claim("id")->fence, 2U);
    EXPECT_EQ(one->claim("id")->fence, 3U);
    EXPECT_EQ(one->pollTakenOverSessions(), (std::vector<TakenOverSession>{{"id", 3}}));
    EXPECT_EQ(two->pollTakenOverSessions(), (std::vector<TakenOverSession>{{"id", 3}}));
    EXPECT_EQ(two->claim("id")->fence, 4U);
    const std::vector<std::string> ids{"id"};
    two->remove(ids);
    EXPECT_EQ(one->pollTakenOverSessions(), (std::vector<TakenOverSession>{{"id", 0}}));
}

// The Lua script with which servers of version 0.1.0 save sessions.
constexpr const char* kSaveScriptOfFirstVersion = R"(
local fence, owner = unpack(redis.call('HMGET', KEYS[1], 'fence', 'owner'))
local mine = tonumber(ARGV[3])
if fence then
  fence = tonumber(fence)
  if fence > mine or (fence == mine and owner and owner ~= '' and owner ~= ARGV[1]) then return 1 end
elseif ARGV[6] == '' then return 2 end
local keeper = ARGV[1]
if ARGV[7] == '1' then keeper = '' end
redis.call('HSET', KEYS[1], 'fence', mine, 'owner', keeper, 'head', ARGV[5])
if ARGV[6] ~= '' then
  redis.call('HSET', KEYS[1], 'token', ARGV[4], 'whole', ARGV[6])
  redis.call('PEXPIRE', KEYS[1], ARGV[2])
  redis.call('PEXPIRE', KEYS[2], ARGV[2])
end
local last = 8 + 2 * tonumber(ARGV[8])
for i = 9, last, 2 do redis.call('HSET', KEYS[2], ARGV[i], ARGV[i + 1]) end
if last > 8 then redis.call('PEXPIRE', KEYS[2], ARGV[2]) end
for i = last + 1, #ARGV do redis.call('HDEL', KEYS[2], ARGV[i]) end
return 0)";

TEST(RedisStore, StoresPlainTokensUntilTheSessionsOfOlderServersHaveExpired) {
    const Redis redis;
    ASSERT_TRUE(redis.connect()) << "Redis answers";
    redis.loadScript(kSaveScriptOfFirstVersion);
    support::VirtualClock clock;
    const auto store = redis.connect(1h, clock.now<RedisStore::Clock>());
    ASSERT_TRUE(store);
    const RecordUpdate update{{"id", "secret"}, 1, "", "whole", {}, {}, false};
    const std::vector<std::string> ids{"id"};
    EXPECT_EQ(store->save({&update, 1}).at(0), SaveResult::saved);
    EXPECT_TRUE(redis.hasField("oval4d:{id}", "token"));
    clock.advance(59min);
    store->restartExpiry(ids);
    EXPECT_TRUE(redis.hasField("oval4d:{id}", "token"));
    clock.advance(2min);
    store->restartExpiry(ids);
    EXPECT_FALSE(redis.hasField("oval4d:{id}", "token"));
    EXPECT_EQ(store->tokenHash("id"), hashToken("secret"));
}

TEST(RedisStore, RemovesOnlyItsOwnSessions) {
    const Redis redis;
    const auto one = redis.connect(), two = redis.connect();
    ASSERT_TRUE(one && two);
    const RecordUpdate update{{"id", "secret"}, 1, "", "whole", {{"p", "q"}}, {}, false, true};
    one->save({&update, 1});
    const std::vector<std::string> ids{"id"};
    two->remove(ids);
    EXPECT_TRUE(one->tokenHash("id"));
    one->remove(ids);
    EXPECT_FALSE(one->tokenHash("id"));
}

TEST(RedisStore, SavesTheOtherSessionsOfABatchIfRedisRefusesOne) {
    const Redis redis;
    const auto store = redis.connect();
    ASSERT_TRUE(store);
    redis.execute("SET oval4d:{first} text");
    const std::vector<RecordUpdate> updates{{{"first", "secret"}, 1, "", "whole", {}, {}, false},
                                            {{"second", "secret"}, 1, "", "whole", {}, {}, false}};
    EXPECT_THROW(store->save(updates), StoreNotWritable);
    EXPECT_TRUE(store->tokenHash("second"));
    EXPECT_EQ(store->save({&updates[1], 1}).at(0), SaveResult::saved);
}

TEST(RedisStore, OpensSessionsWhileRedisIsFull) {
    const Redis redis;
    const auto store = redis.connect();
    ASSERT_TRUE(store);
    const RecordUpdate update{{"id", "secret"}, 1, "", "whole", {}, {}, false};
    EXPECT_EQ(store->save({&update, 1}).at(0), SaveResult::saved);
    redis.execute("CONFIG SET maxmemory 1");
    EXPECT_THROW(store->save({&update, 1}), StoreNotWritable);
    EXPECT_EQ(store->claim("id")->whole, "whole");
}

TEST(RedisStore, RecoversWhenRedisHasLostAllData) {
    Redis redis;
    const auto one = redis.connect(), two = redis.connect();
    ASSERT_TRUE(one && two);
    const RecordUpdate first{{"id", "secret"}, 1, "", "whole", {}, {}, false};
    EXPECT_EQ(one->save({&first, 1}).at(0), SaveResult::saved);
    redis.stop();
    EXPECT_THROW(one->save({&first, 1}), StoreError);
    EXPECT_THROW(one->pollTakenOverSessions(), StoreError);
    EXPECT_THROW(two->pollTakenOverSessions(), StoreError);
    redis.start();
    ASSERT_TRUE(redis.connect());
    const RecordUpdate head{{"id", "secret"}, 1, "head", "", {}, {}, false};
    EXPECT_EQ(one->save({&head, 1}).at(0), SaveResult::missing);
    EXPECT_EQ(one->save({&first, 1}).at(0), SaveResult::saved);
    // Another server may have the same fence from a claim before Redis lost its data.
    EXPECT_EQ(two->save({&first, 1}).at(0), SaveResult::claimed);
}

}  // namespace
}  // namespace oval4d::store
