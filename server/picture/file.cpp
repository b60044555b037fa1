#include "picture/file.hpp"

#include <charconv>
#include <utility>

#include "protocol/cpp/suggest.hpp"

namespace oval4d::picture {

using protocol::Error;
using protocol::ErrorCode;

namespace {

template <typename Choices, typename Choice>
protocol::Result<std::monostate> choose(const std::string& name, const std::string& value, const Choices& choices,
                                        Choice& into) {
    if (const auto found = exports::named(choices, value)) {
        into = *found;
        return std::monostate{};
    }
    std::vector<std::string_view> allowed;
    for (const auto& choice : choices) allowed.push_back(choice.name);
    return Error{ErrorCode::bad_message,
                 name + " must be " + protocol::listed(allowed) + ", not " + protocol::inQuotes(value)};
}

protocol::Result<std::monostate> takeSize(const std::string& text, double& size) {
    const char* const end = text.data() + text.size();
    double value = 0;
    const auto [stopped, fault] = std::from_chars(text.data(), end, value);
    if (fault != std::errc{} || stopped != end || !(value >= exports::kLeastSize && value <= exports::kMostSize)) {
        return Error{ErrorCode::out_of_range,
                     "size must be a number of millimetres from " + protocol::shortest(exports::kLeastSize) + " to " +
                         protocol::shortest(exports::kMostSize) + ", not " + protocol::inQuotes(text)};
    }
    size = value;
    return std::monostate{};
}

}  // namespace

protocol::Result<std::string> fileOf(const session::State& state, const exports::Wish& wish,
                                     const exports::Limits& limits, std::stop_token stop) {
    auto made = exports::fileOf(
        {*state.polytope, state.orientation, state.hyperplanes(), state.slices.focus, state.look.colouring}, wish,
        limits, std::move(stop));
    if (auto* refusal = std::get_if<exports::Refusal>(&made)) {
        const bool empty = refusal->cause == exports::Refusal::Cause::no_body;
        return Error{empty ? ErrorCode::no_body : ErrorCode::too_large, std::move(refusal->message)};
    }
    return std::get<std::string>(std::move(made));
}

protocol::Result<exports::Wish> takeWish(session::Query& query, exports::Format format) {
    exports::Wish wish;
    wish.format = format;
    session::Query rest;
    for (auto& [name, value] : query) {
        protocol::Result<std::monostate> done = std::monostate{};
        if (name == "of") {
            done = choose(name, value, exports::kExtents, wish.of);
        } else if (name == "body") {
            done = choose(name, value, exports::kBodies, wish.body);
        } else if (name == "label") {
            done = choose(name, value, exports::kLabels, wish.label);
        } else if (name == "size") {
            done = takeSize(value, wish.size);
        } else {
            rest.emplace_back(std::move(name), std::move(value));
        }
        if (!done) return done.error();
    }
    query = std::move(rest);
    return wish;
}

std::string fileName(const session::State& state, const exports::Wish& wish) {
    std::string name;
    for (const char c : state.polytope->name) {
        const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-';
        name += plain ? c : '_';
    }
    return name + "." + std::string(exports::nameOf(wish.format));
}

}  // namespace oval4d::picture
