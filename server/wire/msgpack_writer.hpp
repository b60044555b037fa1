#pragma once
// Writes messages as MessagePack (https://github.com/msgpack/msgpack/blob/master/spec.md). Typed arrays are extension
// types, whose numbers are the values of ArrayType.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "wire/binary_writer.hpp"
#include "wire/buffer.hpp"

namespace oval4d::wire {

/// A writer that overwrites a string with MessagePack. The string is complete after the writer is destroyed. Functions
/// throw std::length_error for a text or an array of 4 GiB or more, which MessagePack cannot represent.
class MsgpackWriter final : public BinaryWriter {
  public:
    explicit MsgpackWriter(std::string& out) : out_(out), buffer_(out), open_(1) {}

    // Objects (maps in MessagePack) and arrays begin with their sizes, which are known only at their ends. So 32 bits
    // are reserved for each size, and filled in at the end.
    void beginObject() override { beginContainer('\xDF'); }
    void endObject() override { endContainer(2); }
    void beginArray() override { beginContainer('\xDD'); }
    void endArray() override { endContainer(1); }
    void key(std::string_view name) override { value(name); }

    /// Writes single precision if it represents the number exactly, else double precision.
    void value(double number) override;
    void value(std::uint64_t number) override;
    void value(std::int64_t number) override;
    void value(bool flag) override;
    void value(std::string_view text) override;
    using BinaryWriter::value;
    // These overloads hide those of BinaryWriter, which make a virtual call for each number of an ordinary array.
    void value(std::uint32_t number) { value(std::uint64_t{number}); }
    void value(int number) { value(std::int64_t{number}); }
    void appendMembersOf(std::string_view object) override;

  private:
    /// An object or an array that is being written.
    struct OpenContainer {
        std::size_t sizeAt;   ///< the position of the container's size in the message
        std::uint32_t items;  ///< the number of values in the container; names in an object count as values, too
    };

    char* beginTypedArray(ArrayType type, std::size_t bytes) override;
    void beginContainer(char format);
    void endContainer(std::uint32_t itemsPerElement);
    void countItem() { ++open_.back().items; }
    /// Writes a format byte, and then an integer as 2^k bytes, the most significant byte first.
    void writeHead(unsigned format, unsigned k, std::uint64_t integer);

    std::string& out_;
    OutputBuffer buffer_;
    // The containers that are being written, the innermost last. The first entry is not a container; it counts the
    // message itself.
    std::vector<OpenContainer> open_;
};

}  // namespace oval4d::wire
