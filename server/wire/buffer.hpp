#pragma once
// A growing output buffer on top of a string.

#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

namespace oval4d::wire {

/// Overwrites a string through a pointer. Enlarges the string as needed, and truncates it to the bytes written on
/// destruction. Reusing the string avoids reallocating it, and zero-filling it for a text as long as the one before.
class Buffer {
  public:
    explicit Buffer(std::string& out);
    ~Buffer() { out_.resize(static_cast<std::size_t>(at_ - out_.data())); }
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;

    /// Ensures that at least `size` bytes can be written at at(). Invalidates earlier results of at().
    void reserve(std::size_t size) {
        if (static_cast<std::size_t>(end_ - at_) < size) grow(size);
    }
    /// The current end of the text.
    char* at() { return at_; }
    /// Sets the end of the text, after writing directly to at().
    void moveTo(char* at) { at_ = at; }
    void put(char c) {
        reserve(1);
        *at_++ = c;
    }
    void put(std::string_view text) {
        reserve(text.size());
        std::memcpy(at_, text.data(), text.size());
        at_ += text.size();
    }

  private:
    void grow(std::size_t size);

    std::string& out_;
    char* at_;
    char* end_;
};

}  // namespace oval4d::wire
