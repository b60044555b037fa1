#pragma once
// The base class of the writers of binary encodings. The base class chooses the type of each array of numbers, and a
// derived class encodes the array.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "wire/arrays.hpp"

namespace oval4d::wire {

/// The types of numbers in a typed array, which stores numbers of one type as their bytes. The value of an enumerator
/// is the tag of little-endian arrays of this type in CBOR (RFC 8746, section 2.1).
enum class ArrayType : std::uint8_t { uint8 = 64, uint16 = 69, uint32 = 70, float32 = 85, float64 = 86 };

/// A writer of messages in a binary encoding. JsonWriter has functions with the same names, so that one template can
/// write a message in any encoding.
class BinaryWriter {
  public:
    virtual void beginObject() = 0;
    virtual void endObject() = 0;
    virtual void beginArray() = 0;
    virtual void endArray() = 0;
    virtual void key(std::string_view name) = 0;

    virtual void value(double number) = 0;
    virtual void value(std::uint64_t number) = 0;
    virtual void value(std::int64_t number) = 0;
    virtual void value(bool flag) = 0;
    virtual void value(std::string_view text) = 0;
    void value(std::uint32_t number) { value(std::uint64_t{number}); }
    void value(int number) { value(std::int64_t{number}); }
    void value(const char* text) { value(std::string_view(text)); }
    /// Writes an id. Integers within ±2^53 get the encoding's format of integers; other numbers are written like
    /// value().
    void id(double number);
    /// Appends the members of `object` to the object that is being written. `object` is a complete encoded object from
    /// another writer of the same class.
    virtual void appendMembersOf(std::string_view object) = 0;

    template <typename T>
    void member(std::string_view name, const T& content) {
        key(name);
        value(content);
    }

    // Typed arrays. doubles() writes double precision. vectors() and floatsForPictures() write single precision;
    // vectors() rounds doubles to it. pairs(), triples() and numbers() write integers of 8, 16 or 32 bits: the smallest
    // size that fits all numbers of the array. Vectors, pairs and triples become flat lists of numbers.
    void doubles(std::span<const double> list);
    void vectors(std::span<const glm::vec3> list);
    void vectors(std::span<const glm::dvec3> list);
    void vectors(std::span<const glm::dvec4> list);
    void pairs(std::span<const IndexPair> list);
    void triples(std::span<const IndexTriple> list);
    void numbers(std::span<const std::uint32_t> list);
    /// Writes single precision. JsonWriter's function of this name rounds to four decimals instead.
    void floatsForPictures(std::span<const float> list);
    /// Writes `pixels` as 8-bit integers; ignores `columns`.
    void image(std::span<const std::uint8_t> pixels, std::size_t columns);

  protected:
    ~BinaryWriter() = default;

  private:
    /// Begins a typed array of numbers that take `bytes` bytes in total. Returns the address at which the caller must
    /// write the numbers, in little-endian byte order.
    virtual char* beginTypedArray(ArrayType type, std::size_t bytes) = 0;

    template <typename Number>
    void copyNumbers(ArrayType type, std::span<const Number> list);
    template <typename Integer>
    void integersAs(ArrayType type, std::span<const std::uint32_t> list);
    template <typename V>
    void floatVectors(std::span<const V> list);
};

}  // namespace oval4d::wire
