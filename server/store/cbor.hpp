#pragma once
// Functions that write records in CBOR (RFC 8949), and that read and check values in such records.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "store/unreadable_record.hpp"

namespace oval4d::store {

/// The version of session records that this program writes and reads. The version is the first element of each record.
/// Records of objects have versions of their own (see object_codec.cpp).
inline constexpr int kRecordVersion = 1;

/// Throws UnreadableRecord (the record is not valid) with the message `what`.
[[noreturn]] void throwUnreadableRecord(const std::string& what);

/// Throws NewerVersionRecord. Its message says that a later version of the program has stored the record, followed by
/// `what`, which must tell what this version does not know or allow.
[[noreturn]] void throwLaterRecord(const std::string& what);

/// Returns the CBOR encoding of a JSON value.
std::string encodeCbor(const nlohmann::json& value);

/// Parses a record, and returns it: a CBOR array whose first element is a version from 1 to `latestVersion`. Throws
/// NewerVersionRecord if the version is greater. Throws UnreadableRecord if `bytes` is not a record, or is nested too
/// deeply.
nlohmann::json parseRecord(std::string_view bytes, int latestVersion = kRecordVersion);

/// Throws NewerVersionRecord if the array has more than `known` elements, one for each stored member of a struct. Only
/// a later version of this program stores more members. Reading such a record is refused, because the unknown members
/// would be lost when the session is stored again.
void refuseUnknownMembers(const nlohmann::json& array, std::size_t known);

/// Calls `read` and returns its result. Converts exceptions of the JSON library to UnreadableRecord.
template <typename Read>
auto callTranslatingErrors(Read read) {
    try {
        return read();
    } catch (const nlohmann::json::exception& fault) {
        throwUnreadableRecord(fault.what());
    }
}

/// Returns `value` as a number, which must be from `least` to `most` or, in the overload without `least`, from −`most`
/// to `most`. Throws NewerVersionRecord for a number outside this range. If `value` is not a number, throws an
/// exception of the JSON library, which callTranslatingErrors() converts to UnreadableRecord.
double readNumber(const nlohmann::json& value, double least, double most);
double readNumber(const nlohmann::json& value, double most);

/// Returns `value` as an integer. Throws UnreadableRecord if `value` is not an integer, or if T cannot represent it.
template <std::integral T>
T readInteger(const nlohmann::json& value) {
    const auto fitting = [](auto found) {
        if (!std::in_range<T>(found)) throwUnreadableRecord("an integer is out of range");
        return static_cast<T>(found);
    };
    if (value.is_number_unsigned()) return fitting(value.get<std::uint64_t>());
    if (value.is_number_integer()) return fitting(value.get<std::int64_t>());
    throwUnreadableRecord("a value is not an integer");
}

/// Returns the elements of an array of integers. Throws UnreadableRecord if an element is not an integer from 0 to 2^32
/// − 1.
std::vector<std::uint32_t> readIntegers(const nlohmann::json& value);

/// Throws UnreadableRecord if the text is longer than 256 bytes or is not valid UTF-8.
void checkShortText(std::string_view text);

/// Returns `value` as a short text, such as a name. Throws UnreadableRecord if the text is longer than 256 bytes or is
/// not valid UTF-8. If `value` is not a string, throws an exception of the JSON library, which callTranslatingErrors()
/// converts to UnreadableRecord.
std::string readShortText(const nlohmann::json& value);

}  // namespace oval4d::store
