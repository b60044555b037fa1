#pragma once
// Tables of values and their names, mostly for enumerations.

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace oval4d::text {

/// A row of a table of choices: a value, and its name in messages, queries and on the command line. A value may have
/// several rows. The first row contains its name, and the others contain aliases.
template <typename Value>
struct NamedValue {
    std::string_view name;
    Value value;
};

/// Returns whether an enumerator of the enumeration has this value.
template <auto value>
consteval bool isEnumerator() {
    // The compiler writes `value` as Fruit::apple if an enumerator has the value, and as (Fruit)7 if none has.
    constexpr std::string_view function = __PRETTY_FUNCTION__, assignment = "value = ";
    return function.at(function.rfind(assignment) + assignment.size()) != '(';
}

/// An upper bound: enumerators in tables must have smaller numbers.
inline constexpr std::size_t kMaxEnumerators = 32;

/// Returns, for each number less than kMaxEnumerators, whether an enumerator of `Enum` has this number.
template <typename Enum, std::size_t... numbers>
consteval std::array<bool, kMaxEnumerators> enumeratorsOf(std::index_sequence<numbers...> /*all*/) {
    return {isEnumerator<static_cast<Enum>(numbers)>()...};
}

/// Returns whether the table contains every enumerator, no other value, and no name twice. A row has the members `name`
/// and `value`, as NamedValue has.
template <typename Row, std::size_t size>
consteval bool isComplete(const std::array<Row, size>& rows) {
    using Enum = decltype(Row::value);
    const auto isUsed = enumeratorsOf<Enum>(std::make_index_sequence<kMaxEnumerators>());
    for (std::size_t number = 0; number < kMaxEnumerators; ++number) {
        const bool isNamed = std::ranges::find(rows, static_cast<Enum>(number), &Row::value) != rows.end();
        if (isNamed != isUsed[number]) return false;
    }
    for (auto row = rows.begin(); row != rows.end(); ++row) {
        if (static_cast<std::size_t>(row->value) >= kMaxEnumerators) return false;
        if (std::find_if(rows.begin(), row, [&](const Row& other) { return other.name == row->name; }) != row)
            return false;
    }
    return true;
}

/// Returns a table with these rows, as std::to_array() does. Compiles only if isComplete() holds for the table.
template <typename Row, std::size_t size>
consteval std::array<Row, size> completeTable(const Row (&rows)[size]) {
    const std::array<Row, size> table = std::to_array(rows);
    if (!isComplete(table)) throw std::logic_error("an enumerator has no row, or a name has two");
    return table;
}

/// Returns whether each value has only one row. If so, no two enumerators have the same number, either.
template <typename Row, std::size_t size>
consteval bool hasNoAliases(const std::array<Row, size>& rows) {
    return std::ranges::all_of(rows,
                               [&](const Row& row) { return std::ranges::count(rows, row.value, &Row::value) == 1; });
}

/// Returns the value with this name or alias, or an empty optional if the table lacks the name.
template <typename Choices>
constexpr auto valueNamed(const Choices& choices, std::string_view name)
    -> std::optional<decltype(choices.begin()->value)> {
    for (const auto& choice : choices) {
        if (choice.name == name) return choice.value;
    }
    return {};
}

/// Returns the name of a value (not an alias), or an empty string if the table lacks the value.
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

/// Satisfied by enumerations with a table of choices. The function choicesOf(value) returns the table for any value of
/// the enumeration.
template <typename Enum>
concept HasChoices = std::is_enum_v<Enum> && requires(Enum value) { choicesOf(value).begin()->name; };

}  // namespace oval4d::text
