// When sessions without clients expire, in virtual time.

#include "net/live/session_manager.hpp"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <future>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "errors/error.hpp"
#include "hang_limit.hpp"
#include "store/memory_store.hpp"
#include "unit/net/virtual_server.hpp"

namespace oval4d::net {
namespace {

namespace asio = boost::asio;
using namespace std::chrono_literals;

ServerOptions optionsWithTwoSessionsOfAClient() {
    ServerOptions options;
    options.sessionExpiry = 1h;
    options.client.sessions = 2;
    return options;
}

class SessionManagerTest : public testing::Test {
  protected:
    using JoinResult = SessionManager::JoinResult;

    void TearDown() override { manager->stop(support::hangLimit()); }

    JoinResult create() {
        JoinResult result = kInternalError;
        manager->createSession(server.account, [&result](JoinResult created) { result = std::move(created); });
        return result;
    }
    JoinResult join(const store::SessionCredentials& credentials) {
        std::promise<JoinResult> joined;
        manager->join(credentials, server.account,
                      [&joined](JoinResult result) { joined.set_value(std::move(result)); });
        return joined.get_future().get();
    }
    /// Changes a session. A changed session is not evicted to make room for a new one.
    void change(const std::shared_ptr<LiveSession>& session) {
        asio::co_spawn(server.io, session->apply(server.account, session::KeyPress{"y", false, false}), asio::detached);
        server.settle();
    }
    /// Removes the only client of a session, and waits until the session is in the store.
    void leave(const std::shared_ptr<LiveSession>& session) {
        manager->leave(session, nullptr);
        server.settle();
        EXPECT_TRUE(server.eventually([&] { return manager->writeBehind().unsaved() == 0; }));
    }
    /// Waits until there are `count` sessions. No virtual time passes.
    void waitForSessionCount(std::size_t count) {
        EXPECT_TRUE(server.eventually([&] {
            static_cast<void>(join({"nobody", ""}));  // wakes the store's thread
            return manager->writeBehind().sessionCount() == count;
        })) << count;
    }

    VirtualServer server{optionsWithTwoSessionsOfAClient()};
    const std::shared_ptr<SessionManager> manager = std::make_shared<SessionManager>(
        server.services,
        std::make_unique<store::MemoryStore>(store::kDefaultQuota, [this] { return server.clock.now(); }));
};

TEST_F(SessionManagerTest, SessionsWithoutClientsExpireAndOthersDoNot) {
    const JoinResult staying = create(), leaving = create();
    ASSERT_TRUE(staying && leaving);
    const store::SessionCredentials credentials = (*leaving)->credentials();
    change(*leaving);
    leave(*leaving);
    waitForSessionCount(2);
    server.advance(59min);
    const JoinResult returned = join(credentials);
    ASSERT_TRUE(returned) << "it has not expired yet";
    leave(*returned);
    server.advance(61min);
    waitForSessionCount(1);
    const JoinResult late = join(credentials);
    ASSERT_FALSE(late);
    EXPECT_EQ(late.error().code, ErrorCode::not_found);
    const JoinResult second = join((*staying)->credentials());
    ASSERT_TRUE(second);
    EXPECT_EQ(*second, *staying);
}

TEST_F(SessionManagerTest, ExpiredSessionsDoNotCountTowardTheLimitOfTheirClient) {
    for (int i = 0; i < 2; ++i) {
        const JoinResult created = create();
        ASSERT_TRUE(created);
        change(*created);
        leave(*created);
    }
    const auto refused = [&] {
        const JoinResult created = create();
        return !created && created.error().code == ErrorCode::too_many;
    };
    EXPECT_TRUE(refused());
    server.advance(1h - 1ns);
    EXPECT_TRUE(refused());
    server.advance(1ns);
    EXPECT_TRUE(create());
}

}  // namespace
}  // namespace oval4d::net
