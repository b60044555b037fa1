#pragma once
// The interface through which a session sends messages to a client, and the types of messages and their bytes.

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
    /// Refers to the bytes of `view`, which `owner` keeps alive.
    Bytes(std::string_view view, std::shared_ptr<const void> owner) : view_(view), owner_(std::move(owner)) {}

    std::string_view view() const { return view_; }
    std::size_t size() const { return view_.size(); }

    /// Returns `size` bytes from offset `first`. The result shares their memory.
    Bytes subrange(std::size_t first, std::size_t size) const;

    /// Returns the same bytes; the result also keeps `resource` alive.
    Bytes keepingAlive(std::shared_ptr<const void> resource) const;

  private:
    std::string_view view_;
    std::shared_ptr<const void> owner_;
};

/// A WebSocket message.
struct Message {
    Bytes bytes;
    bool binary = false;  ///< whether this is a binary message; otherwise it is a text message
};

/// Returns a text message.
Message textMessage(std::string text);

/// A connected client as a session sees it. Every function may be called from any thread, and has no effect once the
/// connection has ended.
class Peer {
  public:
    virtual ~Peer() = default;

    /// Queues a message. `written`, if not empty, is called on any thread once the whole message is written to the
    /// socket; it is not called if the connection ends before that.
    virtual void send(Message message, std::function<void()> written = {}) = 0;

    /// Returns the client to whom the connection belongs and whose share of the workers its jobs use.
    virtual const ClientPtr& client() const = 0;

    /// Closes the connection with a WebSocket close code after the queued messages have been written.
    virtual void close(std::uint16_t code, std::string reason) = 0;
};

/// WebSocket close codes: standard and registered ones (RFC 6455, section 7.4.1), and those of the oval4d protocol,
/// which begin at 4000.
namespace close_code {
inline constexpr std::uint16_t kNotText = 1003, kNotJson = 1007, kPolicy = 1008, kTooLarge = 1009, kStopping = 1012,
                               kTryLater = 1013;
inline constexpr std::uint16_t kBadToken = 4401, kNoSession = 4404;
}  // namespace close_code

}  // namespace oval4d::net
