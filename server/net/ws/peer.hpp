#pragma once
// The interface through which a session talks to a client, and the messages that it sends.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "net/clients.hpp"

namespace oval4d::net {

/// An immutable byte string with shared ownership; copies share the same memory.
class Bytes {
  public:
    Bytes() = default;
    explicit Bytes(std::string text);
    explicit Bytes(std::vector<std::uint8_t> bytes);
    /// The bytes of `view`, which `owner` keeps alive.
    Bytes(std::string_view view, std::shared_ptr<const void> owner) : view_(view), owner_(std::move(owner)) {}

    std::string_view view() const { return view_; }
    std::size_t size() const { return view_.size(); }

    /// A range of the bytes, which shares their memory.
    Bytes subrange(std::size_t first, std::size_t size) const;

    /// The same bytes, but the result also keeps `resource` alive.
    Bytes keepingAlive(std::shared_ptr<const void> resource) const;

  private:
    std::string_view view_;
    std::shared_ptr<const void> owner_;
};

/// One WebSocket message.
struct Message {
    Bytes bytes;
    bool binary = false;
};

Message textMessage(std::string text);

/// The client side of a connection. Every function may be called from any thread and has no effect once the connection
/// has ended.
class Peer {
  public:
    virtual ~Peer() = default;

    /// Queues a message. `written` is called from any thread once the whole message is written to the socket.
    virtual void send(Message message, std::function<void()> written = {}) = 0;

    /// The client that pays for the jobs of this connection.
    virtual const ClientPtr& client() const = 0;

    /// Closes the connection with a WebSocket close code after the queued messages.
    virtual void close(std::uint16_t code, std::string reason) = 0;
};

/// WebSocket close codes: standard ones (RFC 6455, section 7.4.1), and from 4000 those of the oval4d protocol.
namespace close_code {
inline constexpr std::uint16_t kNotText = 1003, kNotJson = 1007, kPolicy = 1008, kTooLarge = 1009, kStopping = 1012,
                               kTryLater = 1013;
inline constexpr std::uint16_t kBadToken = 4401, kNoSession = 4404;
}  // namespace close_code

}  // namespace oval4d::net
