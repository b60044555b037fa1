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

/// Sends an `error` message, and counts it. `id`: the id of the request that failed; empty if the error answers no
/// request.
void sendError(Peer& peer, Metrics& metrics, const Error& error, std::optional<double> id);

/// Returns the error for a client to whom a picture, a file or the critical values of a state cannot be sent, or whose
/// command cannot be applied to a state, because the work has failed with `why`: `bad_field` if the file of the
/// state's field can no longer be read, `too_large` if the slices have too many edges, else `otherwise`. Logs the
/// failure unless it returns `too_large`.
Error logAndClassifyFailure(const session::State& state, const std::string& sessionId, std::uint64_t revision,
                            const std::exception& why, const Error& otherwise);

}  // namespace oval4d::net
