#pragma once
// Tables of values and their names.

#include <optional>
#include <string_view>
#include <vector>

namespace oval4d::text {

/// One row of a table of choices: a value and its name in messages, queries and on the command line. A value may have
/// several rows: the first holds its name, the others hold aliases.
template <typename Value>
struct Choice {
    std::string_view name;
    Value value;
};

/// The value of this name in a table of choices.
template <typename Choices>
constexpr auto valueNamed(const Choices& choices, std::string_view name)
    -> std::optional<decltype(choices.begin()->value)> {
    for (const auto& choice : choices) {
        if (choice.name == name) return choice.value;
    }
    return {};
}

/// The name of this value; empty if the table lacks it.
template <typename Choices, typename Value>
constexpr std::string_view nameOf(const Choices& choices, const Value& value) {
    for (const auto& choice : choices) {
        if (choice.value == value) return choice.name;
    }
    return {};
}

/// All names, aliases included.
template <typename Choices>
std::vector<std::string_view> namesOf(const Choices& choices) {
    std::vector<std::string_view> names;
    for (const auto& choice : choices) names.push_back(choice.name);
    return names;
}

}  // namespace oval4d::text
