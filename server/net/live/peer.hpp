#pragma once
// The interface through which a session sends messages to a client.

#include <cstdint>
#include <functional>
#include <string>

#include "net/clients.hpp"
#include "net/live/message.hpp"

namespace oval4d::net {

/// A connected client as a session sees it. Every function may be called from any thread, and has no effect once the
/// connection has ended.
class Peer {
  public:
    virtual ~Peer() = default;

    /// Queues a message. `written`, if not empty, is called on any thread once the whole message is written to the
    /// socket; it is not called if the connection ends before that.
    virtual void send(OutgoingMessage message, std::function<void()> written = {}) = 0;

    /// Returns the account of the IP address or network from which the client is connected (see AddressAccount). The
    /// worker pools divide their time among these accounts: what this connection requests counts as this account's
    /// work.
    virtual const AddressAccountPtr& client() const = 0;

    /// Makes the connection notice at once if its client leaves while the current request is being executed, and then
    /// call LiveSession::stopSearches(). Without this call, the connection may not notice that the client has left
    /// before the request is done.
    virtual void watchForDisconnect() = 0;

    /// Closes the connection with a WebSocket close code after the queued messages have been written.
    virtual void close(std::uint16_t code, std::string reason) = 0;
};

/// WebSocket close codes: standard and registered ones (RFC 6455, section 7.4.1), and those of the oval4d protocol,
/// which begin at 4000. After kStopping, the client should reconnect at once; after kTryLater, later.
namespace close_code {
inline constexpr std::uint16_t kNotText = 1003, kNotJson = 1007, kPolicy = 1008, kTooLarge = 1009, kStopping = 1012,
                               kTryLater = 1013;
inline constexpr std::uint16_t kBadToken = 4401, kNoSession = 4404;
}  // namespace close_code

}  // namespace oval4d::net
