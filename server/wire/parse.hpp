#pragma once
// Parses the messages from clients. All of them are JSON.

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "errors/error.hpp"
#include "wire/request.hpp"

namespace oval4d::wire {

/// Returns the types of messages that clients may send.
std::span<const std::string_view> requestTypes();

/// The error for a refused message.
struct BadRequest {
    std::optional<double> id;  ///< the id of the message, if it could be read
    Error error;
    bool notJson = false;  ///< whether the text is not JSON; the connection must then be closed with WebSocket code
                           ///< 1007
};

/// Parses one message with at most `maxDepth` levels of nesting, and validates it against its JSON schema. Errors:
/// `bad_json` if the text is not JSON or exceeds a limit of parseJson(); `unknown_type` for an unknown type of message;
/// `out_of_range` for a number outside its bounds; `bad_message` for all other faults.
std::variant<Request, BadRequest> parseRequest(std::string_view text, int maxDepth = 32);

/// The type and the id of a message, as far as they could be read.
struct RequestTypeAndId {
    std::optional<std::string> type;
    std::optional<double> id;
};
/// Reads the type and the id from the beginning of a message. The rest of the message may be missing or invalid.
RequestTypeAndId peekRequest(std::string_view beginning);

/// Parses a `state` message, such as the one in the iTXt chunk of a picture's PNG file. Returns the command that
/// restores the state. Errors: `bad_json`, `bad_message` and `out_of_range`, as for parseRequest().
Result<session::ChangeSettings> setCommandFromState(std::string_view text);

/// Parses the `state` message in a file: a picture made by oval4d, or a JSON file with only this message. Returns the
/// command that restores the state. Errors: `bad_message` if the file is a PNG file without a state; `too_large` if the
/// message has more than `maxMessage` bytes; the errors of setCommandFromState().
Result<session::ChangeSettings> setCommandFromFile(std::string_view file,
                                                   std::size_t maxMessage = std::numeric_limits<std::size_t>::max());

/// Returns whether setCommandFromFile() may be able to read a file: it starts like a PNG file or a JSON object.
bool mayContainState(std::string_view file);

}  // namespace oval4d::wire
