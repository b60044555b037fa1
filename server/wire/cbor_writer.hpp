#pragma once
// Writes messages as CBOR (RFC 8949). JsonWriter and CborWriter have functions of the same names, so that one template
// can write a message in both encodings.

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

/// Overwrites a string with CBOR. The string is complete after the writer is destroyed.
class CborWriter {
  public:
    explicit CborWriter(std::string& out) : buffer_(out) {}

    // Objects (maps in CBOR) and arrays have indefinite length, so that their sizes need not be known in advance.
    void beginObject() { buffer_.put('\xBF'); }
    void endObject() { buffer_.put('\xFF'); }
    void beginArray() { buffer_.put('\x9F'); }
    void endArray() { buffer_.put('\xFF'); }
    void key(std::string_view name) { value(name); }

    void value(double number);  ///< writes single precision if that is exact, else double precision
    void id(double number);     ///< writes an integer within ±2^53 as an integer, other numbers like value()
    void value(std::uint64_t number) { head(0, number); }
    void value(std::int64_t number);
    void value(std::uint32_t number) { head(0, number); }
    void value(int number) { value(std::int64_t{number}); }
    void value(bool flag) { buffer_.put(flag ? '\xF5' : '\xF4'); }
    void value(std::string_view text);
    void value(const char* text) { value(std::string_view(text)); }
    /// Appends encoded CBOR unchanged: a value, or members of an object.
    void raw(std::string_view text) { buffer_.put(text); }

    // Typed arrays (RFC 8746), little-endian. doubles() writes double precision; vectors() and floatsForPictures()
    // write single precision, to which vectors() rounds doubles; pairs(), triples() and numbers() write integers of 8,
    // 16 or 32 bits, the smallest size that fits all numbers of the array. Vectors, pairs and triples are flattened.
    void doubles(std::span<const double> list);
    void vectors(std::span<const glm::vec3> list);
    void vectors(std::span<const glm::dvec3> list);
    void vectors(std::span<const glm::dvec4> list);
    void pairs(std::span<const Pair> list);
    void triples(std::span<const Triple> list);
    void numbers(std::span<const std::uint32_t> list);
    void floatsForPictures(std::span<const float> list);  ///< does not round the numbers; only JsonWriter does
    void image(std::span<const std::uint8_t> pixels, std::size_t columns);  ///< 8-bit values, row by row

    template <typename T>
    void member(std::string_view name, const T& content) {
        key(name);
        value(content);
    }

  private:
    void head(std::uint8_t major, std::uint64_t argument);
    template <typename Word>
    void bigEndian(char first, Word word);
    void typedArray(std::uint8_t tag, std::size_t bytes);
    template <typename Integer>
    void integersAs(std::uint8_t tag, std::span<const std::uint32_t> list);
    template <typename V>
    void floatVectors(std::span<const V> list);

    Buffer buffer_;
};

}  // namespace oval4d::wire
