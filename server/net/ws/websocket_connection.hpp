#pragma once
// One WebSocket connection, over which a client sends requests and receives messages.

#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "net/clock.hpp"
#include "net/live/peer.hpp"
#include "net/live/session_manager.hpp"
#include "net/services.hpp"
#include "net/transfer_deadline.hpp"
#include "net/ws/beast_close_code_fix.hpp"
#include "net/ws/rate_limit.hpp"
#include "wire/parse.hpp"
#include "wire/request.hpp"

namespace oval4d::net {

/// The WebSocket subprotocol that the server supports.
inline constexpr std::string_view kSubprotocol = "oval4d.v1";

/// The header of a request for an upgrade to WebSocket.
using UpgradeRequest = boost::beast::http::request<boost::beast::http::empty_body>;

/// Handles the requests of one client over a WebSocket. Answers each request before it executes the next one. Reads at
/// most one message ahead, so TCP back-pressure slows down a client that sends too fast. Writes one message at a time,
/// and drops a client that reads too slowly. closeForShutdown(), drop() and the functions of Peer may be called from
/// any thread; all other functions run on the stream's strand.
class WebSocketConnection final : public Peer, public std::enable_shared_from_this<WebSocketConnection> {
  public:
    /// `session` is the session id in the request path; empty for a new session. `joined` is called when the client has
    /// sent its first hello and has joined a session; it may be empty.
    WebSocketConnection(boost::beast::tcp_stream stream, Services services, std::shared_ptr<SessionManager> sessions,
                        ClientAccountPtr client, std::string session, std::function<void()> joined);

    /// Serves the connection from the handshake until its end. `upgrade` is the client's handshake request.
    boost::asio::awaitable<void> serveClient(UpgradeRequest upgrade);

    void send(OutgoingMessage message, std::function<void()> written = {}) override;
    const ClientAccountPtr& client() const override { return client_; }
    void watchForDisconnect() override;
    void close(std::uint16_t code, std::string reason) override;
    /// Closes the connection with the code kStopping, because the server stops. Discards all queued messages except the
    /// one that is being written.
    void closeForShutdown();
    /// Closes the socket without a close frame.
    void drop();

  private:
    using RequestId = LiveSession::RequestId;
    // A message in the send queue.
    struct QueuedMessage {
        OutgoingMessage message;
        std::function<void()> written;  // called once the message is written; may be empty
        ByteBudget::Reservation held;   // reserves the bytes of the message
    };
    // The result of reading a message.
    struct ReceivedMessage {
        boost::system::error_code fault;  // why reading failed; empty after success
        std::optional<Error> refusal;     // why a long message was refused; empty if it was not
        RequestId id;                     // the request id of a refused message, if the id was found
        bool isText = false;
        ByteBudget::Reservation held;  // reserves the memory of a long message
    };

    void configureStream(bool offersSubprotocol);
    void startHelloTimer();
    void closeWithoutHello();
    boost::asio::awaitable<void> readLoop();
    void startHandling(ReceivedMessage incoming);
    void discardMessage();
    boost::asio::awaitable<void> handleMessage(ReceivedMessage incoming);
    boost::asio::awaitable<ReceivedMessage> readAhead();
    boost::asio::awaitable<ReceivedMessage> readMessage();
    void admitOrRefuseLongMessage(ReceivedMessage& incoming);
    boost::asio::awaitable<void> waitUntil(boost::asio::steady_timer& changed, std::function<bool()> isTrue);
    boost::asio::awaitable<void> parseAndExecute(std::string_view text);
    boost::asio::awaitable<std::variant<wire::Request, wire::BadRequest>> parseMessage(std::string_view text);
    boost::asio::awaitable<void> execute(wire::Request request);
    boost::asio::awaitable<void> handleHello(wire::Hello hello, RequestId id);
    boost::asio::awaitable<SessionManager::JoinResult> joinOrCreateSession(wire::Hello hello);
    std::function<void(SessionManager::JoinHandler)> sessionOpener(const std::string& token);
    void sendError(const Error& error, RequestId id);

    void closeForUnreadBytes();
    void startClosing(std::uint16_t code, std::string reason);
    void writeNext();
    void writeFragmentsFrom(std::size_t from);
    void onMessageWritten(boost::system::error_code fault);
    void startWriteDeadline();

    boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
    const Services services_;
    const std::shared_ptr<SessionManager> sessions_;
    const ClientAccountPtr client_;
    const std::string requestedId_;  // the session id in the request path; empty for a new session
    std::function<void()> joined_;
    std::shared_ptr<LiveSession> session_;  // null until the client has joined a session
    bool joining_ = false;                  // whether the session that a hello requests is being opened
    RateLimit rate_;
    boost::beast::flat_buffer buffer_;   // the message that is being read
    boost::beast::flat_buffer message_;  // the message that is being executed
    // executing_ tells whether message_ is being handled. watching_ tells whether watchForDisconnect() has been called
    // since the handling of message_ began.
    bool executing_ = false, watching_ = false;

    std::deque<QueuedMessage> outbox_;
    std::size_t unsent_ = 0;  // total size of the messages in outbox_, in bytes
    bool writing_ = false, ended_ = false;
    std::uint64_t writes_ =
        0;  // number of completed writes; tells the handler of deadline_ whether the write that it limits is complete
    std::optional<boost::beast::websocket::close_reason> closing_;  // set when the connection is to be closed
    std::optional<TransferDeadline> transferDeadline_;       // gives the timeouts of the message that is being written
    const std::unique_ptr<Timer> deadline_, helloDeadline_;  // the deadlines of the current write and of the hello
    Timer::Clock::time_point helloDue_;                      // when helloDeadline_ expires
    // Two timers on which coroutines wait. Canceling a timer wakes its coroutines: `drainedSignal_` is canceled after
    // messages have been written, `executedSignal_` after a message has been handled.
    boost::asio::steady_timer drainedSignal_, executedSignal_;
};

}  // namespace oval4d::net
