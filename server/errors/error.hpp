#pragma once
// Error codes, errors with messages, and a result type that holds a value or an error.

#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace oval4d {

/// The codes of all errors that a client can receive. protocol/errors.json and protocol/README.md list their names and
/// meanings. A test compares the names with this enum.
enum class ErrorCode {
    bad_json,            ///< the text is not JSON, is nested too deeply, or has too many values
    bad_message,         ///< the message does not match its schema, or a request has a malformed or unexpected part
    unknown_type,        ///< the type of the message is unknown
    unknown_key,         ///< the key is not bound to an action
    unknown_polytope,    ///< the name of the polytope is unknown
    unknown_command,     ///< the page's command line or a query names an unknown command or setting
    bad_expression,      ///< a value on the page's command line or in a query, such as an angle, cannot be parsed
    out_of_range,        ///< a value is outside the allowed range
    not_a_rotation,      ///< the value for an orientation is not a rotation matrix (orthogonal, with determinant 1)
    bad_polytope,        ///< a loaded polytope is invalid
    bad_field,           ///< a loaded field (an array or a formula) is invalid
    unsupported_format,  ///< a loaded file has a format that the server does not read
    /// There is nothing to export: the body is empty or flat, its label has no room, no element is highlighted, or the
    /// file format cannot contain what is requested.
    no_body,
    nothing_to_undo,  ///< there is no step to undo or redo, or no rotation to repeat or to go on with
    hello_first,      ///< a message was sent before the message `hello`
    not_found,        ///< the session or resource does not exist
    bad_token,        ///< the token does not open this session
    too_many,         ///< a limit on sessions, connections, requests, loaded objects or bytes is reached
    too_large,        ///< a message, picture, file, polytope or field exceeds a limit on its size
    canceled,         ///< a search was stopped, because its result was no longer needed
    later_version,    ///< a later version has stored the session; this server keeps it, but cannot open it
    internal,         ///< an internal error of the server; the session is unchanged
};

/// Returns the name of the code in protocol messages. The name is spelled like the enumerator.
std::string_view protocolName(ErrorCode code);

/// An error to report to a client. `message` tells the user what is wrong, where, and what is allowed.
struct Error {
    ErrorCode code;
    std::string message;
};

/// A value, or the error that explains why there is none. Converts to true if it holds a value. Accessing the value if
/// there is an error, or the error if there is a value, throws std::bad_variant_access.
template <typename T>
class [[nodiscard]] Result {
  public:
    Result(T value) : held_(std::move(value)) {}      // NOLINT(google-explicit-constructor): allows `return value;`
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

}  // namespace oval4d
