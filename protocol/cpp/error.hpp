#pragma once
// What can go wrong, as data, and a result type for it.

#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace oval4d::protocol {

/// Every error a client can be told. The wire names and their meanings stand in protocol/errors.json, which the
/// specification lists too; a test compares them with this enum.
enum class ErrorCode {
    bad_json,            ///< the text is not JSON, nests too deeply or holds too many values
    bad_message,         ///< the JSON does not fit the message's schema
    unknown_type,        ///< no message has this type
    unknown_key,         ///< the key has no meaning
    unknown_polytope,    ///< no polytope has this name
    unknown_command,     ///< the ':' line names no command
    bad_expression,      ///< a number or angle on the ':' line or in a query cannot be read
    out_of_range,        ///< a value is outside what is allowed
    not_a_rotation,      ///< an orientation matrix is not orthogonal with determinant 1
    bad_polytope,        ///< a loaded polytope is not sound
    unsupported_format,  ///< a file format that cannot be read
    no_body,             ///< a file is asked of a slice that is empty or flat, or cannot bear its label
    nothing_to_undo,     ///< undo, redo or repeat with nothing to act on
    hello_first,         ///< a message before hello
    not_found,           ///< no such session or resource
    bad_token,           ///< the token does not open this session
    too_many,            ///< a limit on sessions, connections or requests is reached
    too_large,           ///< a message, frame, file or polytope is over its limit
    internal,            ///< a fault of the server; the session is as it was
};

/// The name on the wire: the enumerator's own spelling.
std::string_view wireName(ErrorCode code);

/// `message` says what was wrong, where, and what is allowed, in a sentence for the user.
struct Error {
    ErrorCode code;
    std::string message;
};

/// A value, or the error that kept it from being made.
template <typename T>
class [[nodiscard]] Result {
  public:
    Result(T value) : held_(std::move(value)) {}      // NOLINT(google-explicit-constructor): reads as a return
    Result(Error error) : held_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

    explicit operator bool() const { return held_.index() == 0; }
    T& operator*() { return std::get<0>(held_); }
    const T& operator*() const { return std::get<0>(held_); }
    T* operator->() { return &std::get<0>(held_); }
    const T* operator->() const { return &std::get<0>(held_); }
    const Error& error() const { return std::get<1>(held_); }

  private:
    std::variant<T, Error> held_;
};

}  // namespace oval4d::protocol
