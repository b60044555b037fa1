#pragma once
// Memory for pictures that two processes see.

#include <cstddef>
#include <cstdint>
#include <span>

namespace oval4d::picture {

/// A file in memory, mapped.
class SharedPixels {
  public:
    /// A new one, empty. Throws std::system_error.
    SharedPixels();
    /// One that another process made, as large as that is now; takes `file` over. Throws std::system_error.
    explicit SharedPixels(int file);
    ~SharedPixels();
    SharedPixels(const SharedPixels&) = delete;
    SharedPixels& operator=(const SharedPixels&) = delete;

    /// The first `size` bytes; the file grows to that, and shrinks when it is much larger. Throws std::system_error.
    std::span<std::uint8_t> take(std::size_t size);

    /// Maps what the other process has made of the file, and returns the first `size` bytes. Throws std::system_error.
    std::span<std::uint8_t> see(std::size_t size);

    int file() const { return file_; }
    /// Equal for two processes that have the same file.
    std::uint64_t number() const { return number_; }

  private:
    void map(std::size_t size);

    int file_;
    std::uint64_t number_ = 0;
    std::span<std::uint8_t> mapped_;
};

}  // namespace oval4d::picture
