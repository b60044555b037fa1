#pragma once
// The interface through which a session sends messages to one of its clients.

#include <cstdint>
#include <functional>
#include <string>

#include "net/clients.hpp"
#include "net/live/message.hpp"

namespace oval4d::net {

/// A connected client, as its session sees it. Every function may be called from any thread, and has no effect after
/// the connection has ended.
class Peer {
  public:
    virtual ~Peer() = default;

    /// Queues a message for the client. `written`, if not empty, is called on any thread after the whole message has
    /// been written to the socket. It is not called if the connection ends before.
    virtual void send(OutgoingMessage message, std::function<void()> written = {}) = 0;

    /// Returns the account of the client's IP address or network (see ClientAccount). The worker pools divide their
    /// time among the accounts. Work for this connection counts as work for the returned account.
    virtual const ClientAccountPtr& client() const = 0;

    /// Makes the connection notice at once if its client leaves during the current request, and then call
    /// LiveSession::stopSearches(). Without this call, the connection may notice only after the request that its client
    /// has left.
    virtual void watchForDisconnect() = 0;

    /// Closes the connection with a WebSocket close code, after all queued messages have been written.
    virtual void close(std::uint16_t code, std::string reason) = 0;
};

/// WebSocket close codes. Some are standard or registered (RFC 6455, section 7.4.1); those of the oval4d protocol begin
/// at 4000. After kStopping, the client should reconnect at once; after kTryLater, later.
namespace close_code {
inline constexpr std::uint16_t kNotText = 1003, kNotJson = 1007, kPolicy = 1008, kTooLarge = 1009, kStopping = 1012,
                               kTryLater = 1013;
inline constexpr std::uint16_t kBadToken = 4401, kNoSession = 4404;
}  // namespace close_code

}  // namespace oval4d::net
