#pragma once
// The far end of a connection, as a session sees it.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace oval4d::net {

/// Bytes that never change and are shared by all that send them.
class Bytes {
  public:
    Bytes() = default;
    explicit Bytes(std::string text);
    explicit Bytes(std::vector<std::uint8_t> bytes);

    std::string_view view() const { return view_; }
    std::size_t size() const { return view_.size(); }

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

/// Both functions may be called from any thread, and do nothing once the connection has ended.
class Peer {
  public:
    virtual ~Peer() = default;

    /// Queues a message. `written` is called, on whatever thread, once the socket has taken the whole of it.
    virtual void send(Message message, std::function<void()> written = {}) = 0;

    /// Ends the connection after what is queued.
    virtual void close(std::uint16_t code, std::string reason) = 0;
};

/// WebSocket close codes: the standard's, and from 4000 the protocol's own.
namespace close_code {
inline constexpr std::uint16_t kNotText = 1003, kNotJson = 1007, kPolicy = 1008, kTooLarge = 1009, kStopping = 1012,
                               kTryLater = 1013;
inline constexpr std::uint16_t kBadToken = 4401, kNoSession = 4404;
}  // namespace close_code

}  // namespace oval4d::net
