#include "fields/readers/zarr_json.hpp"

#include <sodium.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "text/message_text.hpp"

namespace oval4d::fields {

using nlohmann::json;

Error badMetadataError(std::string reason) {
    return {ErrorCode::bad_field, "the Zarr metadata are not valid: " + std::move(reason)};
}

std::string quoted(const json& value) {
    return text::inQuotes(value.is_string() ? value.get<std::string>() : value.dump(-1, ' ', true).substr(0, 60));
}

std::string replaceNanByNull(std::string text) {
    bool inString = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\\' && inString) {
            ++i;  // skips the escaped character: an escaped quote does not end the string
            continue;
        }
        if (text[i] == '"') inString = !inString;
        if (inString) continue;
        for (const std::string_view word : {"-Infinity", "Infinity", "NaN"}) {
            if (!std::string_view(text).substr(i).starts_with(word)) continue;
            text.replace(i, word.size(), "null" + std::string(word.size() > 4 ? word.size() - 4 : 0, ' '));
        }
    }
    return text;
}

const json* findMember(const json& object, std::string_view name) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(name);
    return found == object.end() || found->is_null() ? nullptr : &*found;
}

std::string stringMember(const json& object, std::string_view name) {
    const json* const value = findMember(object, name);
    return value != nullptr && value->is_string() ? value->get<std::string>() : std::string();
}

std::optional<double> numberIn(const json& value) {
    if (value.is_boolean()) return value.get<bool>() ? 1 : 0;
    if (value.is_number()) return value.get<double>();
    if (!value.is_string()) return {};
    const auto text = value.get<std::string>();
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    if (text == "NaN") return std::numeric_limits<double>::quiet_NaN();
    if (text == "Infinity") return kInfinite;
    if (text == "-Infinity") return -kInfinite;
    return {};
}

std::optional<double> base64DoubleIn(const std::string& text) {
    std::array<std::uint8_t, sizeof(double)> bytes{};
    std::size_t size = 0;
    const char* end = nullptr;
    if (sodium_base642bin(bytes.data(), bytes.size(), text.data(), text.size(), nullptr, &size, &end,
                          sodium_base64_VARIANT_ORIGINAL) != 0 ||
        size != bytes.size() || end != text.data() + text.size()) {
        return {};
    }
    std::uint64_t bits = 0;
    for (std::size_t i = bytes.size(); i-- > 0;) bits = bits << 8U | bytes.at(i);
    return std::bit_cast<double>(bits);
}

}  // namespace oval4d::fields
