#pragma once
// The messages that the server sends to clients over WebSockets.

#include <string>
#include <utility>

#include "net/shared_bytes.hpp"

namespace oval4d::net {

/// A message to send over a WebSocket.
struct OutgoingMessage {
    SharedBytes bytes;
    bool binary = false;  ///< whether this is a binary message; otherwise it is a text message
};

/// Returns a text message.
inline OutgoingMessage textMessage(std::string text) { return {SharedBytes(std::move(text)), false}; }

}  // namespace oval4d::net
