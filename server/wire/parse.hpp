#pragma once
// Parses the messages of clients, which are JSON.

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "errors/error.hpp"
#include "wire/request.hpp"

namespace oval4d::wire {

/// A message that was refused. It has the id of the message, if that could be read, so that the client can match the
/// error to its request.
struct BadRequest {
    std::optional<double> id;
    Error error;
    bool notJson = false;  ///< the text is not JSON: the connection is closed with code 1007
};

/// Parses one message, with at most `maxDepth` levels of nesting, and validates it against its schema. Errors:
/// `bad_json`, `bad_message`, `unknown_type`, `out_of_range`.
std::variant<Request, BadRequest> parseRequest(std::string_view text, int maxDepth = 32);

/// The type and id of a message, as far as they could be read.
struct RequestPeek {
    std::optional<std::string> type;
    std::optional<double> id;
};
/// Reads the type and the id from the beginning of a message, which may be incomplete or invalid after that.
RequestPeek peekRequest(std::string_view beginning);

/// Parses a `state` message, such as the one in a frame's iTXt chunk, and returns the command that restores this state.
/// Errors: `bad_json`, `bad_message`, `out_of_range`.
Result<session::Set> setFromState(std::string_view text);

}  // namespace oval4d::wire
