#pragma once
// A WebSocket client for load tests. It waits for the picture after each key press and for the answer to each question.
// It counts pictures and bytes.

#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace load {

using Clock = std::chrono::steady_clock;
using Endpoint = boost::asio::ip::tcp::endpoint;

/// Times in seconds: from each key press to its picture, or from each question to its answer.
using Latencies = std::vector<double>;

class Client {
  public:
    Client(boost::asio::io_context& io, Endpoint server) : stream_(io), server_(server) {}

    /// Connects and sends `hello`, a JSON text. If `streams` is true, `hello` must request pictures, and the function
    /// reads the first one.
    boost::asio::awaitable<void> open(std::string hello, bool streams);
    boost::asio::awaitable<void> send(std::string text);
    /// Reads messages up to the picture of the revision `wanted` or of a newer one. Acknowledges and counts this
    /// picture and all before it.
    boost::asio::awaitable<void> picture(std::uint64_t wanted);
    /// Presses a key and waits for its picture.
    boost::asio::awaitable<void> key(char which);
    /// Asks what the picture shows at the point (x, y), in pixels from the upper left corner. Waits for the answer. All
    /// pictures must have been read before.
    boost::asio::awaitable<void> pointAt(int x, int y);
    boost::asio::awaitable<void> close();

    std::uint64_t revision() const { return revision_; }
    std::uint64_t pictures() const { return pictures_; }
    std::uint64_t bytes() const { return bytes_; }

  private:
    boost::asio::awaitable<std::string_view> read();

    boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
    Endpoint server_;
    boost::beast::flat_buffer buffer_;
    std::uint64_t revision_ = 0, pictures_ = 0, bytes_ = 0;
};

/// Returns the body of the response to an HTTP GET request.
boost::asio::awaitable<std::string> get(boost::asio::io_context& io, Endpoint server, std::string path);

}  // namespace load
