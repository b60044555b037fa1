#pragma once
// Decompression of gzip files and zlib streams.

#include <cstddef>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "errors/error.hpp"

namespace oval4d::fields {

/// Returns whether the bytes are the start of a gzip file (RFC 1952).
bool isGzipStart(std::span<const std::byte> start);

/// Decompresses a gzip file or zlib stream step by step. The memory grows only with the bytes that were decompressed,
/// so a small file that claims to be large takes little memory.
class GzipReader {
  public:
    /// The format around the deflate data (RFC 1951): a gzip file (RFC 1952) or a zlib stream (RFC 1950).
    enum class StreamFormat : bool { gzip, zlib };

    /// Begins to decompress `compressed`, which must outlive this object.
    explicit GzipReader(std::span<const std::byte> compressed, StreamFormat format = StreamFormat::gzip);
    ~GzipReader();
    GzipReader(const GzipReader&) = delete;
    GzipReader& operator=(const GzipReader&) = delete;

    /// Appends the next decompressed bytes to `to`, until `to` has `size` bytes in all. Error: `bad_field` if the file
    /// is damaged, or ends before `size` bytes.
    Result<std::monostate> extendTo(std::size_t size, std::vector<std::byte>& to);

    /// Fills `to` with the next decompressed bytes. Errors: those of extendTo().
    Result<std::monostate> decompressInto(std::span<std::byte> to);

    /// Returns whether the caller has read all decompressed bytes and the checksum of the bytes is correct. Do not read
    /// from this object after the call, because the call skips a byte if bytes were left.
    bool verifyEnd();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace oval4d::fields
