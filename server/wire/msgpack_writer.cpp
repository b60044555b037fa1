#include "wire/msgpack_writer.hpp"

#include <bit>
#include <stdexcept>

namespace oval4d::wire {

namespace {

// Bytes before the content of an object or an array: a format byte, and four bytes for the size.
constexpr std::size_t kContainerHead = 5;

// Returns the least k for which an unsigned integer with 2^k bytes can represent `number`.
unsigned log2ByteWidth(std::uint64_t number) {
    return number <= 0xFF ? 0 : number <= 0xFFFF ? 1 : number <= 0xFFFFFFFF ? 2 : 3;
}

// Returns log2ByteWidth() of the length of a text or a typed array. Throws std::length_error if the length is 4 GiB or
// more.
unsigned log2ByteWidthOfLength(std::size_t length) {
    const unsigned k = log2ByteWidth(length);
    if (k > 2) throw std::length_error("a text or an array is too long for MessagePack");
    return k;
}

// Writes an integer as 2^k bytes, the most significant byte first.
void writeBigEndian(char* at, unsigned k, std::uint64_t integer) {
    for (unsigned i = 1U << k; i-- > 0;) *at++ = static_cast<char>(integer >> (8U * i));
}

}  // namespace

void MsgpackWriter::writeHead(unsigned format, unsigned k, std::uint64_t integer) {
    buffer_.put(static_cast<char>(format));
    writeBigEndian(buffer_.append(std::size_t{1} << k), k, integer);
}

void MsgpackWriter::beginContainer(char format) {
    countItem();
    buffer_.put(format);
    const char* const size = buffer_.append(kContainerHead - 1);
    open_.push_back({static_cast<std::size_t>(size - out_.data()), 0});
}

void MsgpackWriter::endContainer(std::uint32_t itemsPerElement) {
    writeBigEndian(out_.data() + open_.back().sizeAt, 2, open_.back().items / itemsPerElement);
    open_.pop_back();
}

void MsgpackWriter::appendMembersOf(std::string_view object) {
    std::uint32_t members = 0;
    for (const char byte : object.substr(1, kContainerHead - 1))
        members = (members << 8U) | static_cast<std::uint8_t>(byte);
    open_.back().items += 2 * members;
    buffer_.put(object.substr(kContainerHead));
}

void MsgpackWriter::value(double number) {
    countItem();
    const auto shorter = static_cast<float>(number);
    if (shorter == number) {
        writeHead(0xCA, 2, std::bit_cast<std::uint32_t>(shorter));
    } else {
        writeHead(0xCB, 3, std::bit_cast<std::uint64_t>(number));
    }
}

void MsgpackWriter::value(std::uint64_t number) {
    countItem();
    if (number < 0x80) {
        buffer_.put(static_cast<char>(number));
    } else {
        const unsigned k = log2ByteWidth(number);
        writeHead(0xCC + k, k, number);
    }
}

void MsgpackWriter::value(std::int64_t number) {
    const auto bits = static_cast<std::uint64_t>(number);
    if (number >= 0) {
        value(bits);
    } else if (number >= -32) {
        countItem();
        buffer_.put(static_cast<char>(number));
    } else {
        countItem();
        // ~bits is −1 − number. The factor 2 makes room for the sign bit.
        const unsigned k = log2ByteWidth(2 * ~bits);
        writeHead(0xD0 + k, k, bits);
    }
}

void MsgpackWriter::value(bool flag) {
    countItem();
    buffer_.put(flag ? '\xC3' : '\xC2');
}

void MsgpackWriter::value(std::string_view text) {
    countItem();
    if (text.size() < 32) {
        buffer_.put(static_cast<char>(0xA0 + text.size()));
    } else {
        const unsigned k = log2ByteWidthOfLength(text.size());
        writeHead(0xD9 + k, k, text.size());
    }
    buffer_.put(text);
}

char* MsgpackWriter::beginTypedArray(ArrayType type, std::size_t bytes) {
    countItem();
    if (bytes <= 16 && std::has_single_bit(bytes)) {
        buffer_.put(static_cast<char>(0xD4 + std::countr_zero(bytes)));
    } else {
        const unsigned k = log2ByteWidthOfLength(bytes);
        writeHead(0xC7 + k, k, bytes);
    }
    buffer_.put(static_cast<char>(type));
    return buffer_.append(bytes);
}

}  // namespace oval4d::wire
