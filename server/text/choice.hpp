#pragma once
// Tables of values and their names.

#include <optional>
#include <string_view>
#include <type_traits>
#include <vector>

namespace oval4d::text {

/// A row of a table of choices: a value and its name in messages, queries and on the command line. A value may have
/// several rows: the first one contains its name, the others contain aliases.
template <typename Value>
struct NamedValue {
    std::string_view name;
    Value value;
};

/// Returns the value with this name or alias; std::nullopt if the table does not contain the name.
template <typename Choices>
constexpr auto valueNamed(const Choices& choices, std::string_view name)
    -> std::optional<decltype(choices.begin()->value)> {
    for (const auto& choice : choices) {
        if (choice.name == name) return choice.value;
    }
    return {};
}

/// Returns the name of this value, not an alias; an empty string if the table does not contain the value.
template <typename Choices, typename Value>
constexpr std::string_view nameOf(const Choices& choices, const Value& value) {
    for (const auto& choice : choices) {
        if (choice.value == value) return choice.name;
    }
    return {};
}

/// Returns all names and aliases in the order of the table.
template <typename Choices>
std::vector<std::string_view> namesOf(const Choices& choices) {
    std::vector<std::string_view> names;
    for (const auto& choice : choices) names.push_back(choice.name);
    return names;
}

/// An enumeration with a table of choices, which a function choicesOf(value) returns for any of its values.
template <typename Enum>
concept HasChoices = std::is_enum_v<Enum> && requires(Enum value) { choicesOf(value).begin()->name; };

}  // namespace oval4d::text
