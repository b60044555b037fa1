#pragma once
// Errors that a session sends to its clients.

#include <cstdint>
#include <exception>
#include <optional>
#include <string>

#include "errors/error.hpp"
#include "net/live/peer.hpp"
#include "net/metrics.hpp"
#include "session/session.hpp"

namespace oval4d::net {

/// Sends an `error` message to a client, and counts the error. `id` is the id of the failed request; empty if the error
/// answers no request.
void sendError(Peer& peer, Metrics& metrics, const Error& error, std::optional<double> id);

/// Returns the error to send to a client after work for the client has failed with the exception `why`. The work was to
/// make a picture or a file, to find critical values of w, or to apply a command. Returns `bad_field` if the file of
/// the field in `state` can no longer be read, `too_large` if the slices have too many edges, and otherwise
/// `otherwise`. Logs the failure with `sessionId` and `revision`, except one with `too_large`.
Error logAndClassifyFailure(const session::State& state, const std::string& sessionId, std::uint64_t revision,
                            const std::exception& why, const Error& otherwise);

}  // namespace oval4d::net
