#pragma once
// The messages of a WebSocket.

#include <string>
#include <utility>

#include "net/shared_bytes.hpp"

namespace oval4d::net {

/// A WebSocket message.
struct Message {
    SharedBytes bytes;
    bool binary = false;  ///< whether this is a binary message; otherwise it is a text message
};

/// Returns a text message.
inline Message textMessage(std::string text) { return {SharedBytes(std::move(text)), false}; }

}  // namespace oval4d::net
