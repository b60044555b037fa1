#pragma once
// Writes messages as JSON. JsonWriter and BinaryWriter have functions with the same names, so that one template can
// write a message in any encoding.

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "wire/arrays.hpp"
#include "wire/buffer.hpp"

namespace oval4d::wire {

/// A writer that overwrites a string with JSON. The string is complete after the writer is destroyed.
class JsonWriter {
  public:
    explicit JsonWriter(std::string& out) : buffer_(out) {}

    void beginObject() { openBracket('{'); }
    void endObject() { closeContainer('}'); }
    void beginArray() { openBracket('['); }
    void endArray() { closeContainer(']'); }
    /// Writes the name of a member. The name must need no escapes. The function is inline, so that the compiler can
    /// optimize it for names that are known at compile time.
    void key(std::string_view name) {
        buffer_.reserveMore(name.size() + 4);
        char* at = buffer_.at();
        if (comma_) *at++ = ',';
        *at++ = '"';
        std::memcpy(at, name.data(), name.size());
        at += name.size();
        *at++ = '"';
        *at++ = ':';
        buffer_.setEnd(at);
        comma_ = false;
    }

    /// Writes integers within ±2^53 without a decimal point or an exponent.
    void value(double number);
    void value(std::uint64_t number);
    void value(std::int64_t number);
    void value(std::uint32_t number) { value(std::uint64_t{number}); }
    void value(int number) { value(std::int64_t{number}); }
    void value(bool flag);
    void id(double number) { value(number); }
    void value(std::string_view text);
    void value(const char* text) { value(std::string_view(text)); }
    void null();
    /// Appends `text`, a value that is already encoded as JSON.
    void raw(std::string_view text);
    /// Appends the members of `object` to the object that is being written. `object` is a complete object from another
    /// JsonWriter, and has at least one member.
    void appendMembersOf(std::string_view object) { raw(object.substr(1, object.size() - 2)); }

    // Functions that write arrays of numbers. Coordinates of vectors are rounded to single precision.
    void vector(const glm::dvec3& v);
    void vectors(std::span<const glm::vec3> list);
    void vectors(std::span<const glm::dvec3> list);
    void vectors(std::span<const glm::dvec4> list);
    void pairs(std::span<const IndexPair> list);
    void triples(std::span<const IndexTriple> list);
    void numbers(std::span<const std::uint32_t> list);
    void floatsForPictures(std::span<const float> list);  ///< rounds the numbers to four decimals
    void jaggedArray(JaggedArrayView view);               ///< writes an array of arrays, one for each list
    /// Writes `pixels`, a table with this number of columns, as an array of rows. Each row is an array.
    void image(std::span<const std::uint8_t> pixels, std::size_t columns);

    template <typename T>
    void member(std::string_view name, const T& content) {
        key(name);
        value(content);
    }

  private:
    void openBracket(char bracket);
    void closeContainer(char bracket);
    template <typename Put>
    void numberArray(std::size_t numbers, Put put);
    template <std::size_t Size>
    void tuples(std::span<const std::array<std::uint32_t, Size>> list);
    void writeCommaIfNeeded() {
        if (comma_) buffer_.put(',');
        comma_ = true;
    }

    OutputBuffer buffer_;
    bool comma_ = false;
};

}  // namespace oval4d::wire
