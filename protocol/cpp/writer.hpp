#pragma once
// Two writers with the same functions, so that a message is described once and comes out as JSON or CBOR.

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace oval4d::protocol {

using Pair = std::array<std::uint32_t, 2>;
using Triple = std::array<std::uint32_t, 3>;

/// Lists one after the other, as geometry keeps them: list i is items[begin[i] − begin[0]] …
struct ListsView {
    std::span<const std::uint32_t> begin, items;
};

/// Writes over a string through a pointer: the string is made longer where need be and cut to size at the end. So
/// nothing is allocated once it has been large enough, nor filled for a text that is as long as the last one.
class Buffer {
  public:
    explicit Buffer(std::string& out);
    ~Buffer() { out_.resize(static_cast<std::size_t>(at_ - out_.data())); }
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;

    /// Makes room for `size` more bytes at `at`.
    void room(std::size_t size) {
        if (static_cast<std::size_t>(end_ - at_) < size) grow(size);
    }
    char* at() { return at_; }
    void moveTo(char* at) { at_ = at; }
    void put(char c) {
        room(1);
        *at_++ = c;
    }
    void put(std::string_view text) {
        room(text.size());
        std::memcpy(at_, text.data(), text.size());
        at_ += text.size();
    }

  private:
    void grow(std::size_t size);

    std::string& out_;
    char* at_;
    char* end_;
};

class JsonWriter {
  public:
    explicit JsonWriter(std::string& out) : buffer_(out) {}

    void beginObject() { open('{'); }
    void endObject() { close('}'); }
    void beginArray() { open('['); }
    void endArray() { close(']'); }
    void key(std::string_view name) {  // here, where most names are known
        buffer_.room(name.size() + 4);
        char* at = buffer_.at();
        if (comma_) *at++ = ',';
        *at++ = '"';
        std::memcpy(at, name.data(), name.size());
        at += name.size();
        *at++ = '"';
        *at++ = ':';
        buffer_.moveTo(at);
        comma_ = false;
    }

    void value(double number);
    void value(std::uint64_t number);
    void value(std::int64_t number);
    void value(std::uint32_t number) { value(std::uint64_t{number}); }
    void value(int number) { value(std::int64_t{number}); }
    void value(bool flag);
    void value(std::string_view text);
    void value(const char* text) { value(std::string_view(text)); }
    void null();
    /// A value, or members of an object, as another writer wrote them.
    void written(std::string_view text);

    /// Arrays of numbers. Coordinates are written as precisely as a float has them.
    void vector(const glm::dvec3& v);
    void vectors(std::span<const glm::dvec3> list);
    void vectors(std::span<const glm::dvec4> list);
    void pairs(std::span<const Pair> list);
    void triples(std::span<const Triple> list);
    void numbers(std::span<const std::uint32_t> list);
    void lists(ListsView view);
    /// A picture of so many columns: its rows.
    void picture(std::span<const std::uint8_t> pixels, std::size_t columns);

    template <typename T>
    void member(std::string_view name, const T& content) {
        key(name);
        value(content);
    }

  private:
    void open(char bracket);
    void close(char bracket);
    template <typename Put>
    void array(std::size_t numbers, Put put);
    template <std::size_t Size>
    void tuples(std::span<const std::array<std::uint32_t, Size>> list);
    void separate() {
        if (comma_) buffer_.put(',');
        comma_ = true;
    }

    Buffer buffer_;
    bool comma_ = false;
};

class CborWriter {
  public:
    explicit CborWriter(std::string& out) : buffer_(out) {}

    // Of indefinite length, so that a message is written as it comes.
    void beginObject() { buffer_.put('\xBF'); }
    void endObject() { buffer_.put('\xFF'); }
    void beginArray() { buffer_.put('\x9F'); }
    void endArray() { buffer_.put('\xFF'); }
    void key(std::string_view name) { value(name); }

    void value(double number);
    void value(std::uint64_t number) { head(0, number); }
    void value(std::int64_t number);
    void value(std::uint32_t number) { head(0, number); }
    void value(int number) { value(std::int64_t{number}); }
    void value(bool flag) { buffer_.put(flag ? '\xF5' : '\xF4'); }
    void value(std::string_view text);
    void value(const char* text) { value(std::string_view(text)); }
    void written(std::string_view text) { buffer_.put(text); }

    void doubles(std::span<const double> list);
    void vectors(std::span<const glm::dvec3> list);
    void vectors(std::span<const glm::dvec4> list);
    void pairs(std::span<const Pair> list);
    void triples(std::span<const Triple> list);
    void numbers(std::span<const std::uint32_t> list);
    void picture(std::span<const std::uint8_t> pixels, std::size_t columns);

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
    void floats(std::span<const V> list);

    Buffer buffer_;
};

}  // namespace oval4d::protocol
