// When HTTP connections end, in virtual time. The sockets are real.

#include "net/http/http_connection.hpp"

#include <boost/asio/ip/address.hpp>
#include <chrono>
#include <utility>

#include <gtest/gtest.h>

#include "unit/net/connection_test.hpp"

namespace oval4d::net {
namespace {

using namespace std::chrono_literals;

ServerOptions optionsWithDeadlines() {
    ServerOptions options;
    options.helloTimeout = 10s;
    options.idleTimeout = 30s;
    return options;
}

class HttpConnectionTest : public ConnectionTest {
  protected:
    HttpConnectionTest() : ConnectionTest(optionsWithDeadlines()) {}
    void SetUp() override {
        boost::asio::ip::tcp::socket accepted = connect();
        const auto executor = accepted.get_executor();
        const ServerContext context{server.services, access, routes, manager, connections};
        serve(executor, serveHttp(std::move(accepted), context));
        read();
        server.settle();
    }
    void TearDown() override {
        client.close();
        ConnectionTest::TearDown();
    }

    /// Waits for the reply to a request, checks it, and discards it.
    void waitForReply() {
        EXPECT_TRUE(server.eventually([&] { return received.ends_with("ok\n"); })) << received;
        EXPECT_TRUE(received.starts_with("HTTP/1.1 200 OK\r\n")) << received;
        received.clear();
        server.settle();  // now the server waits for the next request
    }
    /// Expects that the server closes the connection when this much virtual time has passed, and not earlier.
    void expectEndAfter(TimerClock::Clock::duration time) {
        server.advance(time - 1ns);
        EXPECT_FALSE(ended);
        server.advance(1ns);
        EXPECT_TRUE(server.eventually([&] { return ended; }));
        EXPECT_EQ(received, "");
    }

    static constexpr const char* kRequest = "GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n";

    const WebFiles files{"/nonexistent"};
    Readiness readiness{1};
    const AccessControl access{{}, {}, "", true};
    Routes routes{server.services, files, readiness, *manager};
    ConnectionRegistry connections{10, 10};
};

TEST_F(HttpConnectionTest, AConnectionWithoutAWholeHeaderIsClosedInTime) {
    send("GET /healthz HTTP/1.1\r\nHost: local");
    expectEndAfter(10s);
}

TEST_F(HttpConnectionTest, AnIdleConnectionIsClosedInTimeAfterTheLastReply) {
    send(kRequest);
    waitForReply();
    server.advance(30s - 1ns);
    send(kRequest);
    waitForReply();
    expectEndAfter(30s);
}

TEST_F(HttpConnectionTest, RequestsAboveTheRateAreDelayed) {
    // Uses up what the client's address may send in the next hour. The request is therefore delayed by an hour.
    const auto account = server.clients.findOrCreate(boost::asio::ip::make_address("127.0.0.1"), server.clock.now());
    static_cast<void>(account->countMessage(3601 * server.options.client.messageBytesPerSecond, server.clock.now()));
    send(kRequest);
    const auto start = server.clock.now();
    // The deadline of the header ends when the header has been read. Then only the delay of an hour is left.
    ASSERT_TRUE(server.eventually([&] {
        const auto next = server.clock.nextCall();
        return next && *next > start + 10s;
    }));
    server.advance(1h - 1s);
    EXPECT_EQ(received, "");
    server.advance(2s);
    waitForReply();
}

}  // namespace
}  // namespace oval4d::net
