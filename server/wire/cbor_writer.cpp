#include "wire/cbor_writer.hpp"

#include <bit>

namespace oval4d::wire {

namespace {

// Major types of CBOR (RFC 8949, section 3.1).
constexpr std::uint8_t kUnsigned = 0, kNegative = 1, kBytes = 2, kText = 3;

}  // namespace

void CborWriter::writeHead(std::uint8_t major, std::uint64_t argument) {
    buffer_.reserveMore(9);
    char* at = buffer_.at();
    const int bytes = argument < 24            ? 0
                      : argument <= 0xFF       ? 1
                      : argument <= 0xFFFF     ? 2
                      : argument <= 0xFFFFFFFF ? 4
                                               : 8;
    const std::uint64_t info = bytes == 0 ? argument : bytes == 1 ? 24 : bytes == 2 ? 25 : bytes == 4 ? 26 : 27;
    *at++ = static_cast<char>((std::uint64_t{major} << 5U) | info);
    for (int i = bytes - 1; i >= 0; --i) *at++ = static_cast<char>(argument >> (8U * static_cast<unsigned>(i)));
    buffer_.setEnd(at);
}

template <typename Word>
void CborWriter::putBigEndian(char first, Word word) {
    buffer_.put(first);
    for (std::size_t i = sizeof word; i-- > 0;) buffer_.put(static_cast<char>(word >> 8 * i));
}

void CborWriter::value(double number) {
    const auto shorter = static_cast<float>(number);
    if (shorter == number) {
        putBigEndian('\xFA', std::bit_cast<std::uint32_t>(shorter));
    } else {
        putBigEndian('\xFB', std::bit_cast<std::uint64_t>(number));
    }
}

void CborWriter::value(std::int64_t number) {
    if (number < 0) {
        writeHead(kNegative, ~static_cast<std::uint64_t>(number));
    } else {
        writeHead(kUnsigned, static_cast<std::uint64_t>(number));
    }
}

void CborWriter::value(std::string_view text) {
    writeHead(kText, text.size());
    buffer_.put(text);
}

char* CborWriter::beginTypedArray(ArrayType type, std::size_t bytes) {
    buffer_.put('\xD8');
    buffer_.put(static_cast<char>(type));
    writeHead(kBytes, bytes);
    return buffer_.append(bytes);
}

}  // namespace oval4d::wire
