#pragma once
// An output buffer that writes to a std::string.

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

namespace oval4d::wire {

/// A buffer that overwrites a string through a pointer. Enlarges the string as needed. The destructor truncates the
/// string to the bytes that were written. If a string is overwritten again, with at most as many bytes as before, no
/// memory is allocated or filled with zeros.
class OutputBuffer {
  public:
    explicit OutputBuffer(std::string& out);
    ~OutputBuffer() { out_.resize(static_cast<std::size_t>(at_ - out_.data())); }
    OutputBuffer(const OutputBuffer&) = delete;
    OutputBuffer& operator=(const OutputBuffer&) = delete;

    /// Ensures that the caller can write at least `size` bytes at at(). Invalidates earlier results of at().
    void reserveMore(std::size_t size) {
        if (static_cast<std::size_t>(end_ - at_) < size) grow(size);
    }
    /// Returns a pointer to the current end of the text. The caller may write as many bytes there as it has reserved.
    char* at() { return at_; }
    /// Sets the end of the text to `at`, after the caller has written bytes there directly.
    void setEnd(char* at) { at_ = at; }
    /// Appends one character.
    void put(char c) {
        reserveMore(1);
        *at_++ = c;
    }
    /// Appends text.
    void put(std::string_view text) {
        reserveMore(text.size());
        at_ = std::copy(text.begin(), text.end(), at_);  // unlike memcpy, allows an empty text whose data() is null
    }
    /// Appends `size` bytes with unspecified values. Returns a pointer to the first of them. The pointer is valid until
    /// more bytes are appended.
    char* append(std::size_t size) {
        reserveMore(size);
        at_ += size;
        return at_ - size;
    }

  private:
    void grow(std::size_t size);

    std::string& out_;
    char* at_;
    char* end_;
};

}  // namespace oval4d::wire
