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

/// Sends an `error` message, and counts it. `id`: the id of the request that it answers; empty if it answers none.
void sendError(Peer& peer, Metrics& metrics, const Error& error, std::optional<double> id);

/// Logs that a picture of a state could not be made because of `why`, and returns the error for the client. If the file
/// of the state's field can no longer be read, which is no fault of the server, this is `bad_field`. If the slices have
/// too many edges, it is `too_large`, and nothing is logged. Else it is `otherwise`.
Error pictureError(const session::State& state, const std::string& sessionId, std::uint64_t revision,
                   const std::exception& why, const Error& otherwise);

}  // namespace oval4d::net
