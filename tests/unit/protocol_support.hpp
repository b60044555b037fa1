#pragma once
// What the protocol's tests share.

#include <string>
#include <variant>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "protocol/cpp/codec.hpp"
#include "protocol/cpp/schema.hpp"

namespace oval4d::protocol {

/// The message must parse; returns it.
inline Request parsed(std::string_view text) {
    auto result = parseRequest(text);
    if (const auto* bad = std::get_if<BadRequest>(&result)) throw std::runtime_error(bad->error.message);
    return std::get<Request>(std::move(result));
}

template <typename C>
C parsedCommand(std::string_view text) {
    return std::get<C>(std::get<Command>(parsed(text).body));
}

/// The text must be JSON that fits the schema of its type; returns it.
inline nlohmann::json fitting(std::string_view text) {
    nlohmann::json message = nlohmann::json::parse(text);
    const auto fault = misfit(message.at("type").get<std::string>(), message);
    EXPECT_FALSE(fault) << fault->message;
    return message;
}

}  // namespace oval4d::protocol
