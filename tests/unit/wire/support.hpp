#pragma once
// Helpers for the tests of messages.

#include <string>
#include <variant>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "protocol_data/embedded_files.hpp"
#include "unit/session/support.hpp"
#include "wire/parse.hpp"
#include "wire/schema.hpp"

namespace oval4d::wire {

/// Parses a message and returns it. Throws std::runtime_error if the message is invalid.
inline Request parsed(std::string_view text) {
    auto result = parseRequest(text);
    if (const auto* bad = std::get_if<BadRequest>(&result)) throw std::runtime_error(bad->error.message);
    return std::get<Request>(std::move(result));
}

template <typename C>
C parsedCommand(std::string_view text) {
    return std::get<C>(std::get<session::Command>(parsed(text).body));
}

/// Parses a JSON message and returns it. Expects that it conforms to the schema of its type. Throws an exception if the
/// text is not JSON or has no type.
inline nlohmann::json fitting(std::string_view text) {
    nlohmann::json message = nlohmann::json::parse(text);
    const auto fault = validationError(message.at("type").get<std::string>(), message);
    EXPECT_FALSE(fault) << fault->message;
    return message;
}

/// Returns the bytes that `write` writes with a writer of the class W.
template <typename W, typename Write>
std::string written(Write write) {
    std::string out = "what was there before";
    {
        W w(out);
        write(w);
    }
    return out;
}

}  // namespace oval4d::wire
