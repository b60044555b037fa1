#pragma once
// The messages that the server sends to clients over WebSockets.

#include <optional>
#include <string>
#include <utility>

#include "net/shared_bytes.hpp"
#include "wire/messages.hpp"
#include "wire/request.hpp"

namespace oval4d::net {

/// A message that the server sends over a WebSocket.
struct OutgoingMessage {
    SharedBytes bytes;
    bool binary = false;  ///< whether the message is binary; otherwise it is text
};

/// Makes an outgoing text message.
inline OutgoingMessage textMessage(std::string text) { return {SharedBytes(std::move(text)), false}; }

/// Makes the outgoing text message for an answer. `id` is the id of the answered request; empty if the request has
/// none.
inline OutgoingMessage textAnswer(const wire::Answer& answer, std::optional<double> id) {
    return textMessage(wire::answerMessage(answer, id));
}

}  // namespace oval4d::net
