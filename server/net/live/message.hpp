#pragma once
// The messages that the server sends to clients over WebSockets.

#include <optional>
#include <string>
#include <utility>

#include "net/shared_bytes.hpp"
#include "wire/messages.hpp"
#include "wire/request.hpp"

namespace oval4d::net {

/// A message to send over a WebSocket.
struct OutgoingMessage {
    SharedBytes bytes;
    bool binary = false;  ///< whether this is a binary message; otherwise it is a text message
};

/// Returns a text message.
inline OutgoingMessage textMessage(std::string text) { return {SharedBytes(std::move(text)), false}; }

/// Returns the message of an answer. `id`: the id of the request that it answers; empty if the request has none.
inline OutgoingMessage textAnswer(const wire::Answer& answer, std::optional<double> id) {
    return textMessage(wire::answerMessage(answer, id));
}

}  // namespace oval4d::net
