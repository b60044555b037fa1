#pragma once
// Functions that write CBOR records (RFC 8949) and read values from them with checks.

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "store/unreadable.hpp"

namespace oval4d::store {

/// The version of the records that this program writes and reads. It is the first element of each record.
inline constexpr int kRecordVersion = 1;

/// Throws Unreadable with this message.
[[noreturn]] void refuse(const std::string& what);

/// Returns the CBOR encoding of a value.
std::string bytesOf(const nlohmann::json& value);

/// Parses a record: an array that begins with kRecordVersion. Throws Unreadable if `bytes` is anything else or is
/// nested too deeply.
nlohmann::json parsedRecord(std::string_view bytes);

/// Calls `read` and returns its result. Converts exceptions of the JSON library to Unreadable.
template <typename Read>
auto translatingErrors(Read read) {
    try {
        return read();
    } catch (const nlohmann::json::exception& fault) {
        refuse(fault.what());
    }
}

/// Returns a number from `least` to `most`, or from −`most` to `most` if there is no `least`. Throws Unreadable if it
/// is outside that range.
double number(const nlohmann::json& value, double least, double most);
double number(const nlohmann::json& value, double most);

/// Returns an integer. Throws Unreadable if the value is not an integer that T can represent.
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

/// Returns an array of integers from 0 to 2^32 − 1. Throws Unreadable if an element is anything else.
std::vector<std::uint32_t> integersIn(const nlohmann::json& value);

/// Returns a name: valid UTF-8 of at most 256 bytes. Throws Unreadable if the text is not.
std::string textIn(const nlohmann::json& value);

}  // namespace oval4d::store
