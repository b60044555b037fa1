// When WebSocket connections end, in virtual time. The sockets are real.

#include "net/ws/websocket_connection.hpp"

#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/field.hpp>
#include <boost/beast/http/verb.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "unit/net/connection_test.hpp"

namespace oval4d::net {
namespace {

namespace beast = boost::beast;
using namespace std::chrono_literals;

constexpr std::uint8_t kText = 1, kPing = 9;  // WebSocket opcodes

/// Returns a WebSocket frame in the form that clients send. The content must be shorter than 126 bytes. The mask is 0,
/// which leaves the content unchanged.
std::string clientFrame(std::uint8_t opcode, const std::string& content) {
    std::string frame;
    frame += static_cast<char>(0x80U | opcode);
    frame += static_cast<char>(0x80U | content.size());
    return frame + std::string(4, '\0') + content;
}

ServerOptions optionsWithRarePings() {
    ServerOptions options;
    options.pingInterval = 24h;  // Beast measures this with the system's clock
    options.helloTimeout = 10s;
    options.writeTimeout = 10s;
    return options;
}

class WebSocketConnectionTest : public ConnectionTest {
  protected:
    WebSocketConnectionTest() : ConnectionTest(optionsWithRarePings()) {}
    void TearDown() override {
        connection->drop();
        ConnectionTest::TearDown();
    }

    /// Opens a connection. If `reads` is true, the client reads all that the server sends.
    void open(bool reads) {
        boost::asio::ip::tcp::socket accepted = connect(reads ? std::nullopt : std::optional(4096));
        const auto executor = accepted.get_executor();
        connection = std::make_shared<WebSocketConnection>(beast::tcp_stream(std::move(accepted)), server.services,
                                                           manager, server.account, "", [] {});
        UpgradeRequest upgrade{beast::http::verb::get, "/ws", 11};
        upgrade.set(beast::http::field::host, "localhost");
        upgrade.set(beast::http::field::connection, "Upgrade");
        upgrade.set(beast::http::field::upgrade, "websocket");
        upgrade.set(beast::http::field::sec_websocket_version, "13");
        upgrade.set(beast::http::field::sec_websocket_key, "dGhlIHNhbXBsZSBub25jZQ==");
        serve(executor, connection->serveClient(std::move(upgrade)));
        if (reads) read();
        ASSERT_TRUE(server.eventually([&] { return server.metrics.webSockets.Value() == 1; }));
    }
    bool hasReceived(const std::string& text) const { return received.find(text) != std::string::npos; }
    void waitFor(const std::string& text) {
        EXPECT_TRUE(server.eventually([&] { return hasReceived(text); })) << text;
    }

    std::shared_ptr<WebSocketConnection> connection;
};

TEST_F(WebSocketConnectionTest, AConnectionWithoutHelloIsClosedInTimeWhateverElseItSends) {
    open(true);
    send(clientFrame(kPing, "x"));
    send(clientFrame(kText, R"({"type":"undo","id":1})"));
    waitFor("hello_first");
    server.advance(5s);
    send(clientFrame(kText, R"({"type":"hello"})").substr(0, 12));
    server.advance(5s - 1ns);
    EXPECT_FALSE(hasReceived("no hello"));
    server.advance(1ns);
    waitFor("no hello arrived in time");
    waitFor(std::string("\x03\xf0", 2) + "no hello");  // a close frame with the code 1008
}

TEST_F(WebSocketConnectionTest, AConnectionWithHelloStays) {
    open(true);
    server.advance(10s - 1ns);
    send(clientFrame(kText, R"({"type":"hello"})"));
    waitFor("\"welcome\"");
    server.advance(100h);
    send(clientFrame(kText, R"({"type":"ping","id":2})"));
    waitFor("\"pong\"");
    EXPECT_FALSE(hasReceived("no hello"));
    EXPECT_FALSE(ended);
}

TEST_F(WebSocketConnectionTest, AClientThatReadsNothingIsDropped) {
    constexpr std::size_t kMoreThanTheKernelHolds = std::size_t{64} << 20U;
    open(false);
    send(clientFrame(kText, R"({"type":"hello"})"));
    ASSERT_TRUE(server.eventually([&] { return manager->openSessionCount() == 1; }));
    connection->send(textMessage(std::string(kMoreThanTheKernelHolds, ' ')));
    EXPECT_TRUE(server.eventually([&] {
        server.advance(10s);
        return server.metrics.droppedSlowClients.Value() == 1;
    }));
    EXPECT_TRUE(server.eventually([&] { return ended; }));
    EXPECT_EQ(server.metrics.webSockets.Value(), 0);
}

TEST_F(WebSocketConnectionTest, MessagesAboveTheRateAreDelayed) {
    open(true);
    send(clientFrame(kText, R"({"type":"hello"})"));
    waitFor("\"welcome\"");
    // Uses up what the client's address may send in the next hour. The next message is therefore delayed by an hour.
    const std::size_t most = server.options.client.messageBytesPerSecond;
    static_cast<void>(server.account->countMessage(3601 * most, server.clock.now()));
    const double before = server.metrics.messagesReceived.Value();
    send(clientFrame(kText, R"({"type":"ping","id":2})"));
    ASSERT_TRUE(server.eventually([&] { return server.metrics.messagesReceived.Value() == before + 1; }));
    server.advance(1h - 1s);
    EXPECT_FALSE(hasReceived("\"pong\""));
    server.advance(2s);
    waitFor("\"pong\"");
}

}  // namespace
}  // namespace oval4d::net
