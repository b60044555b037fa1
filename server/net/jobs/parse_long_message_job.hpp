#pragma once
// Parses long messages on workers. A message is long if it exceeds ServerOptions::maxRequestBytes.

#include <cstddef>
#include <functional>
#include <string_view>
#include <variant>

#include "errors/error.hpp"
#include "net/server_options.hpp"
#include "wire/parse.hpp"

namespace oval4d::net {

/// The result of parsing a message: a request, or what is wrong with the message.
using MessageParseResult = std::variant<wire::Request, wire::BadRequest>;

/// Returns the error for a message that is too long for its type. The error text states the maximum lengths.
Error messageTooLongError(const ServerOptions& options);

/// Returns a job that parses a long message. Only a `load` message may be long, so the result for any other type is an
/// error. `text` and `options` must outlive the job.
std::function<MessageParseResult(std::size_t worker)> parseLongMessageJob(std::string_view text,
                                                                          const ServerOptions& options);

}  // namespace oval4d::net
