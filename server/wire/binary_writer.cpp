#include "wire/binary_writer.hpp"

#include <bit>
#include <cstring>

#include "text/decimal.hpp"

namespace oval4d::wire {

static_assert(std::endian::native == std::endian::little, "typed arrays are copied from memory");

void BinaryWriter::id(double number) {
    if (text::isExactInteger(number)) {
        value(static_cast<std::int64_t>(number));
    } else {
        value(number);
    }
}

template <typename Number>
void BinaryWriter::copyNumbers(ArrayType type, std::span<const Number> list) {
    char* const at = beginTypedArray(type, list.size_bytes());
    if (!list.empty()) std::memcpy(at, list.data(), list.size_bytes());
}

template <typename V>
void BinaryWriter::floatVectors(std::span<const V> list) {
    char* at = beginTypedArray(ArrayType::float32, list.size() * V::length() * sizeof(float));
    for (const V& v : list) {
        for (int i = 0; i < V::length(); ++i) {
            const auto coordinate = static_cast<float>(v[i]);
            std::memcpy(at, &coordinate, sizeof coordinate);
            at += sizeof coordinate;
        }
    }
}

void BinaryWriter::doubles(std::span<const double> list) { copyNumbers(ArrayType::float64, list); }
void BinaryWriter::floatsForPictures(std::span<const float> list) { copyNumbers(ArrayType::float32, list); }
void BinaryWriter::vectors(std::span<const glm::vec3> list) { floatVectors(list); }
void BinaryWriter::vectors(std::span<const glm::dvec3> list) { floatVectors(list); }
void BinaryWriter::vectors(std::span<const glm::dvec4> list) { floatVectors(list); }

template <typename Integer>
void BinaryWriter::integersAs(ArrayType type, std::span<const std::uint32_t> list) {
    char* at = beginTypedArray(type, list.size() * sizeof(Integer));
    for (const std::uint32_t number : list) {
        const auto narrow = static_cast<Integer>(number);
        std::memcpy(at, &narrow, sizeof narrow);
        at += sizeof narrow;
    }
}

void BinaryWriter::numbers(std::span<const std::uint32_t> list) {
    std::uint32_t bits = 0;
    for (const std::uint32_t number : list) bits |= number;
    if (bits <= 0xFF) {
        integersAs<std::uint8_t>(ArrayType::uint8, list);
    } else if (bits <= 0xFFFF) {
        integersAs<std::uint16_t>(ArrayType::uint16, list);
    } else {
        integersAs<std::uint32_t>(ArrayType::uint32, list);
    }
}

void BinaryWriter::pairs(std::span<const IndexPair> list) {
    numbers({reinterpret_cast<const std::uint32_t*>(list.data()), 2 * list.size()});
}

void BinaryWriter::triples(std::span<const IndexTriple> list) {
    numbers({reinterpret_cast<const std::uint32_t*>(list.data()), 3 * list.size()});
}

void BinaryWriter::image(std::span<const std::uint8_t> pixels, std::size_t /*columns*/) {
    copyNumbers(ArrayType::uint8, pixels);
}

}  // namespace oval4d::wire
