#pragma once
// Converts values to bytes and back, for messages between processes of this program on the same machine. Numbers have
// the machine's byte order.

#include <cstddef>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <boost/pfr.hpp>

namespace oval4d::serialization {

/// Satisfied by types whose values can be copied byte by byte. Classes among these types must not contain pointers or
/// references; the concept cannot check this.
template <typename T>
concept BytewiseCopyable = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;

/// Satisfied by aggregates (structs without constructors) that are not BytewiseCopyable. Their members are written and
/// read one by one.
template <typename T>
concept Memberwise = std::is_aggregate_v<T> && !BytewiseCopyable<T>;

/// A function object that appends values to a string of bytes. Writes a string or vector as the number of its elements,
/// followed by the elements.
class ByteWriter {
  public:
    explicit ByteWriter(std::string& out) : out_(out) {}

    template <BytewiseCopyable T>
    void operator()(const T& value) {
        out_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void operator()(std::string_view text) {
        (*this)(text.size());
        out_.append(text);
    }
    void operator()(const std::string& text) { (*this)(std::string_view(text)); }
    template <BytewiseCopyable T>
    void operator()(std::span<const T> list) {
        (*this)(list.size());
        out_.append(reinterpret_cast<const char*>(list.data()), list.size_bytes());
    }
    template <BytewiseCopyable T>
    void operator()(const std::vector<T>& list) {
        (*this)(std::span<const T>(list));
    }
    template <Memberwise T>
    void operator()(const T& value) {
        boost::pfr::for_each_field(value, [this](const auto& member) { (*this)(member); });
    }
    template <Memberwise T>
    void operator()(const std::vector<T>& list) {
        (*this)(list.size());
        for (const T& element : list) (*this)(element);
    }

  private:
    std::string& out_;
};

/// A function object that reads values from bytes. Values must be read in the order, and with the types, in which a
/// ByteWriter wrote them. Throws std::runtime_error if bytes are missing, or if a Boolean is neither 0 nor 1. Does not
/// check Booleans in BytewiseCopyable classes.
class ByteReader {
  public:
    explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

    template <BytewiseCopyable T>
    void operator()(T& value) {
        std::memcpy(&value, takeBytes(sizeof value), sizeof value);
    }
    void operator()(bool& value) {
        const char byte = *takeBytes(1);
        if (byte != 0 && byte != 1) throw std::runtime_error("a message between processes is damaged");
        value = byte == 1;
    }
    void operator()(std::string& text) {
        const std::size_t size = readElementCount(1);
        text.assign(takeBytes(size), size);
    }
    template <BytewiseCopyable T>
    void operator()(std::vector<T>& list) {
        list.resize(readElementCount(sizeof(T)));
        if (!list.empty()) std::memcpy(list.data(), takeBytes(list.size() * sizeof(T)), list.size() * sizeof(T));
    }
    template <Memberwise T>
    void operator()(T& value) {
        // Pass a lambda, because for_each_field() would copy *this and advance only the copy.
        boost::pfr::for_each_field(value, [this](auto& member) { (*this)(member); });
    }
    template <Memberwise T>
    void operator()(std::vector<T>& list) {
        list.clear();
        for (std::size_t rest = readElementCount(1); rest > 0; --rest) (*this)(list.emplace_back());
    }

  private:
    // Reads the number of elements of a string or vector. Throws std::runtime_error if too few bytes are left for these
    // elements. `each` is the size of an element in bytes.
    std::size_t readElementCount(std::size_t each) {
        std::size_t number = 0;
        (*this)(number);
        if (number > rest_.size() / each) throw std::runtime_error("a message between processes is cut short");
        return number;
    }
    // Returns a pointer to the next `size` bytes, and skips them. Throws std::runtime_error if too few bytes are left.
    const char* takeBytes(std::size_t size) {
        if (size > rest_.size()) throw std::runtime_error("a message between processes is cut short");
        const char* at = rest_.data();
        rest_.remove_prefix(size);
        return at;
    }

    std::string_view rest_;
};

}  // namespace oval4d::serialization
