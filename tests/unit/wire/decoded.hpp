#pragma once
// Decodes `slices` messages in every encoding, for tests.

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "wire/request.hpp"

namespace oval4d::wire {

/// A reader that follows a BJData message to find the types of its optimized arrays. nlohmann::json decodes such arrays
/// to ordinary arrays of numbers.
class BjdataArrayTypes {
  public:
    explicit BjdataArrayTypes(std::string_view message) : message_(message) {}

    /// Replaces optimized arrays in `value` by binary values, as decoded() describes. nlohmann::json has decoded
    /// `value` from the next bytes. Throws std::exception if the value and the bytes have different structures.
    void restore(nlohmann::json& value) {
        const char marker = next();
        if (marker == '{') {
            std::size_t members = 0;
            for (; message_.at(at_) != '}'; ++members) restore(value.at(std::string(take(count()))));
            ++at_;
            require(value.is_object() && members == value.size());
        } else if (marker == '[' && message_.at(at_) == '$') {
            ++at_;
            const char numbers = next();
            require(next() == '#');
            const std::size_t size = count();
            require(value.is_array() && size == value.size());
            const std::string_view bytes = take(size * bytesOf(numbers));
            value = nlohmann::json::binary(std::vector<std::uint8_t>(bytes.begin(), bytes.end()), subtypeOf(numbers));
        } else if (marker == '[') {
            std::size_t items = 0;
            while (message_.at(at_) != ']') restore(value.at(items++));
            ++at_;
            require(value.is_array() && items == value.size());
        } else if (marker == 'S') {
            require(take(count()) == value.get<std::string>());
        } else if (marker != 'T' && marker != 'F') {
            take(bytesOf(marker));
        }
    }

  private:
    static void require(bool agrees) {
        if (!agrees) throw std::logic_error("a message in BJData differs from what was decoded");
    }
    /// Returns the size, in bytes, of a number with this marker.
    static std::size_t bytesOf(char marker) {
        constexpr std::string_view kMarkers = "iUIulmdLMD";
        const std::size_t i = kMarkers.find(marker);
        require(i != std::string_view::npos);
        return i < 2 ? 1 : i < 4 ? 2 : i < 7 ? 4 : 8;
    }
    static std::uint64_t subtypeOf(char marker) {
        switch (marker) {
            case 'U':
                return 64;
            case 'u':
                return 69;
            case 'm':
                return 70;
            case 'd':
                return 85;
            case 'D':
                return 86;
            default:
                throw std::logic_error("ArrayType has no such type");
        }
    }
    std::string_view take(std::size_t bytes) {
        require(bytes <= message_.size() - at_);
        return message_.substr(std::exchange(at_, at_ + bytes), bytes);
    }
    char next() { return take(1).front(); }
    /// Reads a length, which is a marker and a number.
    std::size_t count() {
        std::size_t length = 0;
        unsigned shift = 0;
        for (const char byte : take(bytesOf(next()))) {
            length |= std::size_t{static_cast<std::uint8_t>(byte)} << shift;
            shift += 8;
        }
        return length;
    }

    std::string_view message_;
    std::size_t at_ = 0;
};

/// Returns a decoded message. Typed arrays of binary encodings become binary values, whose subtypes are the numbers of
/// ArrayType. Throws nlohmann::json::exception if the bytes are not a message in this encoding.
inline nlohmann::json decoded(const std::string& message, Encoding encoding) {
    using nlohmann::json;
    switch (encoding) {
        case Encoding::json:
            return json::parse(message);
        case Encoding::cbor:
            return json::from_cbor(message, true, true, json::cbor_tag_handler_t::store);
        case Encoding::msgpack:
            return json::from_msgpack(message);
        case Encoding::bjdata: {
            json value = json::from_bjdata(message);
            BjdataArrayTypes(message).restore(value);
            return value;
        }
    }
    throw std::logic_error("this encoding has no decoder in the tests");
}

}  // namespace oval4d::wire
