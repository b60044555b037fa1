#pragma once
// CBOR records: reading values out of them, with checks.

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "store/unreadable.hpp"

namespace oval4d::store {

/// The version of records that this program writes: the first element of each.
inline constexpr int kRecordVersion = 1;

/// Throws Unreadable.
[[noreturn]] void refuse(const std::string& what);

/// The CBOR encoding of a value.
std::string bytesOf(const nlohmann::json& value);

/// Parses a record: an array that begins with kRecordVersion. Throws Unreadable if it is not one or is nested too
/// deeply.
nlohmann::json parsedRecord(std::string_view bytes);

/// Calls `read`, and throws the JSON library's exceptions as Unreadable.
template <typename Read>
auto translatingErrors(Read read) {
    try {
        return read();
    } catch (const nlohmann::json::exception& fault) {
        refuse(fault.what());
    }
}

/// Reads a number from `least` to `most`, or from −`most` to `most`. Throws Unreadable.
double number(const nlohmann::json& value, double least, double most);
double number(const nlohmann::json& value, double most);

/// Reads an integer that T can hold. Throws Unreadable.
template <std::integral T>
T integer(const nlohmann::json& value) {
    const auto fitting = [](auto found) {
        if (!std::in_range<T>(found)) refuse("an integer is out of range");
        return static_cast<T>(found);
    };
    if (value.is_number_unsigned()) return fitting(value.get<std::uint64_t>());
    if (value.is_number_integer()) return fitting(value.get<std::int64_t>());
    refuse("a value is not an integer");
}

/// Reads an array of integers. Throws Unreadable.
std::vector<std::uint32_t> integersIn(const nlohmann::json& value);

/// Reads a name: UTF-8, at most 256 bytes. Throws Unreadable.
std::string textIn(const nlohmann::json& value);

}  // namespace oval4d::store
