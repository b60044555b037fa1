#pragma once
// Parses long messages on workers. A message is long if it has more than ServerOptions::maxRequestBytes bytes.

#include <cstddef>
#include <functional>
#include <string_view>
#include <variant>

#include "errors/error.hpp"
#include "net/server_options.hpp"
#include "wire/parse.hpp"

namespace oval4d::net {

/// The result of parsing a message.
using ParseResult = std::variant<wire::Request, wire::BadRequest>;

/// Returns the error for a message that is too long for its type. The error states the maximum lengths.
Error messageTooLong(const ServerOptions& options);

/// Returns a job that parses a long message. The result is an error unless the message is a `load`, because no other
/// message may be long. `text` and `options` must outlive the job.
std::function<ParseResult(std::size_t worker)> parseLongMessageJob(std::string_view text, const ServerOptions& options);

}  // namespace oval4d::net
