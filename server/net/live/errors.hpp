#pragma once
// The errors that sessions send to clients.

#include <cstdint>
#include <exception>
#include <optional>
#include <string>

#include "errors/error.hpp"
#include "net/live/peer.hpp"
#include "net/metrics.hpp"
#include "session/session.hpp"

namespace oval4d::net {

/// Sends an `error` message, and counts it. `id` is that of the request, if it answers one.
void sendError(Peer& peer, Metrics& metrics, const Error& error, std::optional<double> id);

/// Logs that a picture of a state could not be made, and returns the error for the client: that its file is lost, which
/// is no fault of the server, or else `otherwise`.
Error pictureError(const session::State& state, const std::string& sessionId, std::uint64_t revision,
                   const std::exception& why, const Error& otherwise);

}  // namespace oval4d::net
