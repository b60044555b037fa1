#pragma once
// A WebSocket connection.

#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "net/hub.hpp"
#include "net/peer.hpp"
#include "net/rate_limit.hpp"
#include "net/services.hpp"
#include "protocol/cpp/request.hpp"

namespace oval4d::net {

inline constexpr std::string_view kSubprotocol = "oval4d.v1";

/// Reads requests one after the other, each answered before the next is read, so that a client that asks faster than
/// it is served waits in its own socket. Writes one message at a time; a client that does not take one in time is
/// dropped. All but `send`, `close` and `stop` belongs to the stream's strand.
class Connection final : public Peer, public std::enable_shared_from_this<Connection> {
  public:
    using Upgrade = boost::beast::http::request<boost::beast::http::string_body>;

    /// `session`: the one in the request's path, or empty for a new one.
    Connection(boost::beast::tcp_stream stream, Services services, std::shared_ptr<Hub> hub, std::string session);

    /// From the handshake to the end.
    boost::asio::awaitable<void> run(Upgrade upgrade);

    void send(Message message, std::function<void()> written = {}) override;
    void close(std::uint16_t code, std::string reason) override;
    /// Drops what is queued and says that the server is stopping.
    void stop();

  private:
    using Id = LiveSession::Id;
    struct Outgoing {
        Message message;
        std::function<void()> written;
    };

    void setUp(bool offered);
    boost::asio::awaitable<void> converse();
    boost::asio::awaitable<void> room();
    boost::asio::awaitable<void> handle(std::string_view text);
    boost::asio::awaitable<void> carryOut(protocol::Request request);
    boost::asio::awaitable<void> greet(protocol::Hello hello, Id id);
    boost::asio::awaitable<Hub::Joined> enter(protocol::Hello hello);
    std::function<void(Hub::Done)> entrance(const std::string& token);
    void tell(const protocol::Error& error, Id id);

    void startClosing(std::uint16_t code, std::string reason);
    void writeNext();
    void writePiece(std::size_t from);
    void written(boost::system::error_code fault);
    void expectProgress();

    boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
    const Services services_;
    const std::shared_ptr<Hub> hub_;
    const std::string wanted_;  // the session in the path
    std::shared_ptr<LiveSession> session_;
    RateLimit rate_;
    boost::beast::flat_buffer buffer_;

    std::deque<Outgoing> outbox_;
    std::size_t unsent_ = 0;  // bytes in outbox_
    bool writing_ = false, ended_ = false;
    std::uint64_t writes_ = 0;  // tells a deadline which write it watches
    std::optional<boost::beast::websocket::close_reason> closing_;
    boost::asio::steady_timer deadline_, drained_;
};

}  // namespace oval4d::net
