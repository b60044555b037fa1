#include "load_client.hpp"

#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/http.hpp>
#include <charconv>

namespace load {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::use_awaitable;

namespace {

/// Returns the number after `"revision":`, which must be near the beginning of the text.
std::uint64_t revisionIn(std::string_view text) {
    constexpr std::string_view kName = "\"revision\":";
    const std::size_t at = text.find(kName);
    std::uint64_t value = 0;
    if (at != std::string_view::npos)
        std::from_chars(text.data() + at + kName.size(), text.data() + text.size(), value);
    return value;
}

}  // namespace

asio::awaitable<void> Client::open(std::string hello, bool streams) {
    auto& socket = beast::get_lowest_layer(stream_).socket();
    co_await socket.async_connect(server_, use_awaitable);
    socket.set_option(asio::ip::tcp::no_delay(true));
    stream_.read_message_max(0);
    const std::string host = server_.address().to_string();
    co_await stream_.async_handshake(host, "/ws", use_awaitable);
    co_await send(std::move(hello));
    co_await read();  // the message `welcome`
    if (streams) co_await picture(0);
}

asio::awaitable<void> Client::send(std::string text) {
    stream_.text(true);
    co_await stream_.async_write(asio::buffer(text), use_awaitable);
}

asio::awaitable<std::string_view> Client::read() {
    buffer_.clear();
    bytes_ += co_await stream_.async_read(buffer_, use_awaitable);
    co_return std::string_view(static_cast<const char*>(buffer_.cdata().data()), buffer_.size());
}

asio::awaitable<void> Client::picture(std::uint64_t wanted) {
    for (std::uint64_t seen = 0;;) {
        const std::string_view message = co_await read();
        if (message.starts_with(R"({"type":"state")")) {
            seen = revisionIn(message);  // the picture of this state is the next message
            continue;
        }
        if (message.starts_with(R"({"type":"error")")) throw std::runtime_error(std::string(message));
        ++pictures_;
        revision_ = seen;
        co_await send(R"({"type":"shown","revision":)" + std::to_string(seen) + "}");
        if (seen >= wanted) co_return;
    }
}

asio::awaitable<void> Client::key(char which) {
    const std::uint64_t next = revision_ + 1;
    co_await send(std::string(R"({"type":"key","key":")") + which + "\"}");
    co_await picture(next);
}

asio::awaitable<void> Client::pointAt(int x, int y) {
    co_await send(R"({"type":"get","what":"at","x":)" + std::to_string(x) + R"(,"y":)" + std::to_string(y) + "}");
    const std::string_view answer = co_await read();
    if (!answer.starts_with(R"({"type":"at")")) throw std::runtime_error(std::string(answer.substr(0, 200)));
}

asio::awaitable<void> Client::close() {
    co_await stream_.async_close(beast::websocket::close_code::normal, use_awaitable);
}

asio::awaitable<std::string> get(asio::io_context& io, Endpoint server, std::string path) {
    beast::tcp_stream stream(io);
    co_await stream.async_connect(server, use_awaitable);
    http::request<http::empty_body> request{http::verb::get, path, 11};
    request.set(http::field::host, server.address().to_string());
    co_await http::async_write(stream, request, use_awaitable);
    beast::flat_buffer buffer;
    http::response<http::string_body> response;
    co_await http::async_read(stream, buffer, response, use_awaitable);
    co_return response.body();
}

}  // namespace load
