#pragma once
// The shared part of connection tests: a server in virtual time, and a client. Their sockets are real.

#include <array>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/write.hpp>
#include <cstddef>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "hang_limit.hpp"
#include "net/live/session_manager.hpp"
#include "store/memory_store.hpp"
#include "unit/net/virtual_server.hpp"

namespace oval4d::net {

/// Tests one connection of a client. A derived class calls connect(), serve() and, if its client reads, read().
class ConnectionTest : public testing::Test {
  protected:
    explicit ConnectionTest(ServerOptions options) : server(std::move(options)) {}

    /// Waits for the end of the connection, which the test must have caused.
    void TearDown() override {
        EXPECT_TRUE(server.eventually([&] { return ended; }));
        server.settle();
        manager->stop(support::hangLimit());
    }

    /// Connects the client, and returns the server's socket. The client's kernel buffers about `receiveBuffer` received
    /// bytes; without this argument, the kernel decides.
    boost::asio::ip::tcp::socket connect(std::optional<int> receiveBuffer = {}) {
        boost::asio::ip::tcp::acceptor acceptor(
            server.io, boost::asio::ip::tcp::endpoint(boost::asio::ip::make_address("127.0.0.1"), 0));
        client.open(boost::asio::ip::tcp::v4());
        if (receiveBuffer) client.set_option(boost::asio::socket_base::receive_buffer_size(*receiveBuffer));
        client.connect(acceptor.local_endpoint());
        boost::asio::ip::tcp::socket accepted(boost::asio::make_strand(server.io));
        acceptor.accept(accepted);
        return accepted;
    }
    /// Starts a coroutine that serves the connection until it ends.
    void serve(const boost::asio::ip::tcp::socket::executor_type& executor, boost::asio::awaitable<void> connection) {
        boost::asio::co_spawn(executor, std::move(connection),
                              [this](const std::exception_ptr& /*failure*/) { ended = true; });
    }
    /// Starts to append all that the server sends to `received`.
    void read() {
        client.async_read_some(boost::asio::buffer(chunk_), [this](boost::system::error_code fault, std::size_t size) {
            received.append(chunk_.data(), size);
            if (!fault) read();
        });
    }
    void send(const std::string& bytes) { boost::asio::write(client, boost::asio::buffer(bytes)); }

    VirtualServer server;
    const std::shared_ptr<SessionManager> manager = std::make_shared<SessionManager>(
        server.services,
        std::make_unique<store::MemoryStore>(store::kDefaultQuota, [this] { return server.clock.now(); }));
    boost::asio::ip::tcp::socket client{server.io};
    bool ended = false;  // whether the server has ended the connection
    std::string received;

  private:
    std::array<char, 65536> chunk_{};
};

}  // namespace oval4d::net
