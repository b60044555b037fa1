#pragma once
// Writes messages as CBOR (RFC 8949), with typed arrays (RFC 8746).

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "wire/binary_writer.hpp"
#include "wire/buffer.hpp"

namespace oval4d::wire {

/// A writer that overwrites a string with CBOR. The string is complete after the writer is destroyed.
class CborWriter final : public BinaryWriter {
  public:
    explicit CborWriter(std::string& out) : buffer_(out) {}

    // Objects (maps in CBOR) and arrays have indefinite length, so their sizes need not be known at the beginning.
    void beginObject() override { buffer_.put('\xBF'); }
    void endObject() override { buffer_.put('\xFF'); }
    void beginArray() override { buffer_.put('\x9F'); }
    void endArray() override { buffer_.put('\xFF'); }
    void key(std::string_view name) override { value(name); }

    /// Writes single precision if it represents the number exactly, else double precision.
    void value(double number) override;
    void value(std::uint64_t number) override { writeHead(0, number); }
    void value(std::int64_t number) override;
    void value(bool flag) override { buffer_.put(flag ? '\xF5' : '\xF4'); }
    void value(std::string_view text) override;
    using BinaryWriter::value;
    // These overloads hide those of BinaryWriter, which make a virtual call for each number of an ordinary array.
    void value(std::uint32_t number) { writeHead(0, number); }
    void value(int number) { value(std::int64_t{number}); }
    void appendMembersOf(std::string_view object) override { buffer_.put(object.substr(1, object.size() - 2)); }

  private:
    char* beginTypedArray(ArrayType type, std::size_t bytes) override;
    void writeHead(std::uint8_t major, std::uint64_t argument);
    template <typename Word>
    void putBigEndian(char first, Word word);

    OutputBuffer buffer_;
};

}  // namespace oval4d::wire
