#include <bit>

#include "wire/cbor_writer.hpp"

#include "text/decimal.hpp"

namespace oval4d::wire {

namespace {

static_assert(std::endian::native == std::endian::little, "typed arrays are copied from memory");

// Major types (RFC 8949, section 3.1), and tags of typed arrays (RFC 8746, section 2.1).
constexpr std::uint8_t kUnsigned = 0, kNegative = 1, kBytes = 2, kText = 3;
constexpr std::uint8_t kUint8Array = 64, kUint16Array = 69, kUint32Array = 70, kFloat32Array = 85,
                       kFloat64Array = 86;  // little-endian

}  // namespace

void CborWriter::head(std::uint8_t major, std::uint64_t argument) {
    buffer_.reserve(9);
    char* at = buffer_.at();
    const int bytes = argument < 24            ? 0
                      : argument <= 0xFF       ? 1
                      : argument <= 0xFFFF     ? 2
                      : argument <= 0xFFFFFFFF ? 4
                                               : 8;
    const std::uint64_t info = bytes == 0 ? argument : bytes == 1 ? 24 : bytes == 2 ? 25 : bytes == 4 ? 26 : 27;
    *at++ = static_cast<char>((std::uint64_t{major} << 5U) | info);
    for (int i = bytes - 1; i >= 0; --i) *at++ = static_cast<char>(argument >> (8U * static_cast<unsigned>(i)));
    buffer_.moveTo(at);
}

template <typename Word>
void CborWriter::bigEndian(char first, Word word) {
    buffer_.put(first);
    for (std::size_t i = sizeof word; i-- > 0;) buffer_.put(static_cast<char>(word >> 8 * i));
}

void CborWriter::value(double number) {
    const auto shorter = static_cast<float>(number);
    if (shorter == number) {
        bigEndian('\xFA', std::bit_cast<std::uint32_t>(shorter));
    } else {
        bigEndian('\xFB', std::bit_cast<std::uint64_t>(number));
    }
}

void CborWriter::id(double number) {
    if (text::isExactInteger(number)) {
        value(static_cast<std::int64_t>(number));
    } else {
        value(number);
    }
}

void CborWriter::value(std::int64_t number) {
    if (number < 0) {
        head(kNegative, ~static_cast<std::uint64_t>(number));
    } else {
        head(kUnsigned, static_cast<std::uint64_t>(number));
    }
}

void CborWriter::value(std::string_view text) {
    head(kText, text.size());
    buffer_.put(text);
}

void CborWriter::typedArray(std::uint8_t tag, std::size_t bytes) {
    buffer_.put('\xD8');
    buffer_.put(static_cast<char>(tag));
    head(kBytes, bytes);
    buffer_.reserve(bytes);
}

template <typename V>
void CborWriter::floatVectors(std::span<const V> list) {
    typedArray(kFloat32Array, list.size() * V::length() * sizeof(float));
    char* at = buffer_.at();
    for (const V& v : list) {
        for (int i = 0; i < V::length(); ++i) {
            const auto coordinate = static_cast<float>(v[i]);
            std::memcpy(at, &coordinate, sizeof coordinate);
            at += sizeof coordinate;
        }
    }
    buffer_.moveTo(at);
}

void CborWriter::doubles(std::span<const double> list) {
    typedArray(kFloat64Array, list.size_bytes());
    if (!list.empty()) buffer_.put({reinterpret_cast<const char*>(list.data()), list.size_bytes()});
}
void CborWriter::floatsForPictures(std::span<const float> list) {
    typedArray(kFloat32Array, list.size_bytes());
    if (!list.empty()) buffer_.put({reinterpret_cast<const char*>(list.data()), list.size_bytes()});
}
void CborWriter::vectors(std::span<const glm::vec3> list) { floatVectors(list); }
void CborWriter::vectors(std::span<const glm::dvec3> list) { floatVectors(list); }
void CborWriter::vectors(std::span<const glm::dvec4> list) { floatVectors(list); }

void CborWriter::numbers(std::span<const std::uint32_t> list) {
    std::uint32_t bits = 0;
    for (const std::uint32_t number : list) bits |= number;
    if (bits <= 0xFF) {
        integersAs<std::uint8_t>(kUint8Array, list);
    } else if (bits <= 0xFFFF) {
        integersAs<std::uint16_t>(kUint16Array, list);
    } else {
        integersAs<std::uint32_t>(kUint32Array, list);
    }
}

template <typename Integer>
void CborWriter::integersAs(std::uint8_t tag, std::span<const std::uint32_t> list) {
    typedArray(tag, list.size() * sizeof(Integer));
    char* at = buffer_.at();
    for (const std::uint32_t number : list) {
        const auto narrow = static_cast<Integer>(number);
        std::memcpy(at, &narrow, sizeof narrow);
        at += sizeof narrow;
    }
    buffer_.moveTo(at);
}

void CborWriter::pairs(std::span<const Pair> list) {
    numbers({reinterpret_cast<const std::uint32_t*>(list.data()), 2 * list.size()});
}

void CborWriter::triples(std::span<const Triple> list) {
    numbers({reinterpret_cast<const std::uint32_t*>(list.data()), 3 * list.size()});
}

void CborWriter::image(std::span<const std::uint8_t> pixels, std::size_t /*columns*/) {
    typedArray(kUint8Array, pixels.size());
    if (!pixels.empty()) buffer_.put({reinterpret_cast<const char*>(pixels.data()), pixels.size()});
}

}  // namespace oval4d::wire
