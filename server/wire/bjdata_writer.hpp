#pragma once
// Writes messages as BJData (Binary JData, draft 2: https://neurojson.org/bjdata/draft2). Typed arrays are "optimized
// containers": they state the type and the count of all their numbers first.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "wire/binary_writer.hpp"
#include "wire/buffer.hpp"

namespace oval4d::wire {

/// A writer that overwrites a string with BJData. The string is complete after the writer is destroyed. An object
/// begins with "{U" if its first name has at most 255 bytes. By these bytes, clients distinguish BJData messages from
/// files (protocol/README.md, "Binary messages").
class BjdataWriter final : public BinaryWriter {
  public:
    explicit BjdataWriter(std::string& out) : buffer_(out) {}

    // Objects and ordinary arrays end with a marker, so their sizes need not be known at the beginning.
    void beginObject() override { buffer_.put('{'); }
    void endObject() override { buffer_.put('}'); }
    void beginArray() override { buffer_.put('['); }
    void endArray() override { buffer_.put(']'); }
    void key(std::string_view name) override {
        value(std::uint64_t{name.size()});  // writes the marker U first if the size is at most 255
        buffer_.put(name);
    }

    /// Writes single precision if it represents the number exactly, else double precision.
    void value(double number) override {
        const auto shorter = static_cast<float>(number);
        if (shorter == number) {
            put('d', shorter);
        } else {
            put('D', number);
        }
    }
    void value(std::uint64_t number) override {
        if (number <= UINT8_MAX) {
            put('U', static_cast<std::uint8_t>(number));
        } else if (number <= UINT16_MAX) {
            put('u', static_cast<std::uint16_t>(number));
        } else if (number <= UINT32_MAX) {
            put('m', static_cast<std::uint32_t>(number));
        } else {
            put('M', number);
        }
    }
    void value(std::int64_t number) override {
        if (number >= 0) {
            value(static_cast<std::uint64_t>(number));
        } else if (number >= INT8_MIN) {
            put('i', static_cast<std::int8_t>(number));
        } else if (number >= INT16_MIN) {
            put('I', static_cast<std::int16_t>(number));
        } else if (number >= INT32_MIN) {
            put('l', static_cast<std::int32_t>(number));
        } else {
            put('L', number);
        }
    }
    void value(bool flag) override { buffer_.put(flag ? 'T' : 'F'); }
    void value(std::string_view text) override {
        buffer_.put('S');
        key(text);
    }
    using BinaryWriter::value;
    // These overloads hide those of BinaryWriter, which make a virtual call for each number of an ordinary array.
    void value(std::uint32_t number) { value(std::uint64_t{number}); }
    void value(int number) { value(std::int64_t{number}); }
    void appendMembersOf(std::string_view object) override { buffer_.put(object.substr(1, object.size() - 2)); }

  private:
    /// The marker of a type of numbers, and the size of a number in bytes.
    struct NumberMarker {
        char marker;
        std::size_t bytes;
    };
    static NumberMarker numberTypeOf(ArrayType type) {
        switch (type) {
            case ArrayType::uint8:
                return {'U', 1};
            case ArrayType::uint16:
                return {'u', 2};
            case ArrayType::uint32:
                return {'m', 4};
            case ArrayType::float32:
                return {'d', 4};
            case ArrayType::float64:
                break;
        }
        return {'D', 8};
    }

    char* beginTypedArray(ArrayType type, std::size_t bytes) override {
        const NumberMarker numbers = numberTypeOf(type);
        buffer_.put("[$");
        buffer_.put(numbers.marker);
        buffer_.put('#');
        value(std::uint64_t{bytes / numbers.bytes});
        return buffer_.append(bytes);
    }
    /// Writes a marker, and a number as it is in memory. BJData is little-endian, and binary_writer.cpp checks that the
    /// memory is, too.
    template <typename Number>
    void put(char marker, Number number) {
        buffer_.put(marker);
        std::memcpy(buffer_.append(sizeof number), &number, sizeof number);
    }

    OutputBuffer buffer_;
};

}  // namespace oval4d::wire
