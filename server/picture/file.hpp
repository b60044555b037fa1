#pragma once
// From a session's state to a file of its slices. The one way there, for the service and for `oval4d export` alike.

#include <stop_token>
#include <string>

#include "export/export.hpp"
#include "protocol/cpp/error.hpp"
#include "session/query.hpp"

namespace oval4d::picture {

/// The bytes of the file, or `no_body`, `too_large`.
protocol::Result<std::string> fileOf(const session::State& state, const exports::Wish& wish,
                                     const exports::Limits& limits, std::stop_token stop = {});

/// Takes "of", "body", "size" and "label" out of a query; or `bad_message`, `out_of_range`, saying what is allowed.
protocol::Result<exports::Wish> takeWish(session::Query& query, exports::Format format);

/// "24-cell.stl": what the file may be called, in ASCII.
std::string fileName(const session::State& state, const exports::Wish& wish);

}  // namespace oval4d::picture
