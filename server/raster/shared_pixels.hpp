#pragma once
// Memory for the pixels of a picture that two processes share.

#include <cstddef>
#include <cstdint>
#include <span>

namespace oval4d::raster {

/// Memory for pixels that two processes can share: a memory file (memfd_create(2)) and its mapping into this process.
/// Another process can map the same memory if it gets the file descriptor over a socket.
class SharedPixels {
  public:
    /// Creates an empty memory file. Throws std::system_error if the file cannot be created.
    SharedPixels();
    /// Takes ownership of `file`, the descriptor of a memory file that another process has created. Throws
    /// std::system_error if the descriptor is invalid.
    explicit SharedPixels(int file);
    ~SharedPixels();
    SharedPixels(const SharedPixels&) = delete;
    SharedPixels& operator=(const SharedPixels&) = delete;

    /// Makes room for `size` bytes: enlarges the memory file if it is smaller, and shrinks it if it is much larger.
    /// Returns the first `size` bytes, which are valid until the next call of resize() or remapIfResized(). Throws
    /// std::system_error if the file cannot be resized or mapped.
    std::span<std::uint8_t> resize(std::size_t size);

    /// Maps the file again if the other process has resized it. Returns the first `size` bytes, which are valid until
    /// the next call of resize() or remapIfResized(). Throws std::system_error if the file cannot be mapped or has
    /// fewer than `size` bytes.
    std::span<std::uint8_t> remapIfResized(std::size_t size);

    /// Returns the descriptor of the memory file, which this object owns.
    int file() const { return file_; }
    /// Returns the inode number of the memory file, which is the same in both processes.
    std::uint64_t inode() const { return inode_; }

  private:
    void map(std::size_t size);

    int file_;
    std::uint64_t inode_ = 0;
    std::span<std::uint8_t> mapped_;
};

}  // namespace oval4d::raster
