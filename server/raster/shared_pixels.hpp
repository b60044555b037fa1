#pragma once
// Picture memory shared by two processes.

#include <cstddef>
#include <cstdint>
#include <span>

namespace oval4d::raster {

/// A mapped memory file (memfd).
class SharedPixels {
  public:
    /// Creates an empty file. Throws std::system_error.
    SharedPixels();
    /// Opens the file of another process; takes ownership of the descriptor `file`. Throws std::system_error.
    explicit SharedPixels(int file);
    ~SharedPixels();
    SharedPixels(const SharedPixels&) = delete;
    SharedPixels& operator=(const SharedPixels&) = delete;

    /// Returns the first `size` bytes. Grows the file if it is smaller, and shrinks it if it is more than 4 times
    /// larger. Throws std::system_error.
    std::span<std::uint8_t> resize(std::size_t size);

    /// Maps the file at the size that the other process has given it, and returns the first `size` bytes. Throws
    /// std::system_error, also if the file is smaller.
    std::span<std::uint8_t> remap(std::size_t size);

    int file() const { return file_; }
    /// The inode number, which is the same in both processes.
    std::uint64_t number() const { return number_; }

  private:
    void map(std::size_t size);

    int file_;
    std::uint64_t number_ = 0;
    std::span<std::uint8_t> mapped_;
};

}  // namespace oval4d::raster
