#pragma once
// JSON in and out.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "geometry/polytope.hpp"
#include "geometry/slicer.hpp"
#include "protocol/cpp/error.hpp"
#include "protocol/cpp/request.hpp"
#include "scene/scene.hpp"
#include "session/session.hpp"

namespace oval4d::protocol {

/// A failed parse still carries the id, where the text had one, so that the error can be matched to its request.
struct BadRequest {
    std::optional<double> id;
    Error error;
    bool notJson = false;  ///< not JSON text at all: the connection ends with close code 1007
};

/// Parses and checks one message against its schema.
std::variant<Request, BadRequest> parseRequest(std::string_view text, int maxDepth = 32);

/// The `state` message of the session's present; the same text is embedded in frames.
std::string stateMessage(const session::State& state, std::uint64_t revision, std::optional<double> id = {});
/// The same; overwrites `out`, reusing its memory.
void stateMessage(const session::State& state, std::uint64_t revision, std::optional<double> id, std::string& out);

/// Restores a state from a `state` message, as found in a frame's iTXt chunk: the Set that brings it about.
Result<Set> setFromState(std::string_view text);

std::string errorMessage(const Error& error, std::optional<double> id);
std::string doneMessage(std::optional<double> id, std::uint64_t revision,
                        const std::vector<std::string>& warnings = {});
/// The `catalogue` message, after the catalogue's entries those of what a session has loaded.
std::string catalogueMessage(std::optional<double> id, std::span<const session::PolytopePtr> loaded = {});
std::string keymapMessage(std::optional<double> id);

/// `welcome`: `limits` is a JSON object text.
std::string welcomeMessage(std::string_view session, std::string_view token, std::string_view limits,
                           std::optional<double> id);

}  // namespace oval4d::protocol
