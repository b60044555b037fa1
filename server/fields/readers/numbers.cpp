#include "fields/readers/numbers.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

namespace oval4d::fields {

namespace {

struct BooleanByte {
    std::uint8_t byte;
};

struct HalfFloat {
    std::uint16_t bits;
};

float decodedNumber(BooleanByte stored) { return stored.byte != 0 ? 1.F : 0.F; }

// Converts an IEEE 754 binary16, which has 5 bits of exponent and 10 of fraction.
float decodedNumber(HalfFloat stored) {
    const int exponent = stored.bits >> 10U & 0x1f, fraction = stored.bits & 0x3ff;
    float magnitude = std::ldexp(static_cast<float>(fraction + (exponent > 0 ? 1024 : 0)), std::max(exponent, 1) - 25);
    if (exponent == 0x1f)
        magnitude = fraction == 0 ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
    return (stored.bits & 0x8000U) != 0 ? -magnitude : magnitude;
}

template <typename Number>
Number decodedNumber(Number stored) {
    return stored;
}

template <typename Number, bool kSwap>
auto loadValue(const std::byte* from) {
    std::array<std::byte, sizeof(Number)> bytes;
    std::memcpy(bytes.data(), from, sizeof(Number));
    if constexpr (kSwap) std::reverse(bytes.begin(), bytes.end());
    return decodedNumber(std::bit_cast<Number>(bytes));
}

template <typename Value>
float roundedToFloat(Value value) {
    if constexpr (std::is_same_v<Value, double>) {
        if (!(std::abs(value) <= double{std::numeric_limits<float>::max()}))
            return std::numeric_limits<float>::quiet_NaN();
    }
    return static_cast<float>(value);
}

float rescaledSample(const StoredNumberFormat& format, double stored) {
    const bool missing = !(format.min <= stored && stored <= format.max) ||
                         std::find(format.missing.begin(), format.missing.end(), stored) != format.missing.end();
    return missing ? std::numeric_limits<float>::quiet_NaN() : roundedToFloat(stored * format.scale + format.offset);
}

template <typename Visit>
void visitRows(const StridedLayout& layout, float* to, const Visit& visit) {
    const auto& size = layout.size;
    for (std::size_t i = 0; i < size[0]; ++i) {
        for (std::size_t j = 0; j < size[1]; ++j) {
            for (std::size_t k = 0; k < size[2]; ++k) {
                visit(to + static_cast<std::ptrdiff_t>(i) * layout.stride[0] +
                      static_cast<std::ptrdiff_t>(j) * layout.stride[1] +
                      static_cast<std::ptrdiff_t>(k) * layout.stride[2]);
            }
        }
    }
}

template <typename Number, bool kSwap>
void convertNumbers(const StoredNumberFormat& format, const std::byte* from, const StridedLayout& layout, float* to) {
    const bool plain = format.needsNoConversion();
    visitRows(layout, to, [&](float* row) {
        const std::ptrdiff_t stride = layout.stride[3];
        const auto count = static_cast<std::ptrdiff_t>(layout.size[3]);
        if (plain) {
            for (std::ptrdiff_t i = 0; i < count; ++i, from += sizeof(Number))
                row[i * stride] = roundedToFloat(loadValue<Number, kSwap>(from));
        } else {
            for (std::ptrdiff_t i = 0; i < count; ++i, from += sizeof(Number))
                row[i * stride] = rescaledSample(format, static_cast<double>(loadValue<Number, kSwap>(from)));
        }
    });
}

template <typename Number>
void convertInFileByteOrder(const StoredNumberFormat& format, const std::byte* from, const StridedLayout& layout,
                            float* to) {
    if (format.bigEndian == (std::endian::native == std::endian::big) || sizeof(Number) == 1)
        convertNumbers<Number, false>(format, from, layout, to);
    else
        convertNumbers<Number, true>(format, from, layout, to);
}

}  // namespace

std::size_t sizeOf(NumberType type) {
    constexpr std::array<std::size_t, 12> kSizes{1, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
    return kSizes.at(static_cast<std::size_t>(type));
}

std::optional<StoredNumberFormat> numberFormatOf(std::string_view descr) {
    static constexpr std::array<std::pair<std::string_view, NumberType>, 12> kNumpyTypes{{
        {"b1", NumberType::boolean},
        {"i1", NumberType::i1},
        {"u1", NumberType::u1},
        {"i2", NumberType::i2},
        {"u2", NumberType::u2},
        {"i4", NumberType::i4},
        {"u4", NumberType::u4},
        {"i8", NumberType::i8},
        {"u8", NumberType::u8},
        {"f2", NumberType::f2},
        {"f4", NumberType::f4},
        {"f8", NumberType::f8},
    }};
    if (descr.size() != 3 || std::string_view("<>=|").find(descr[0]) == std::string_view::npos) return {};
    const auto* const type = std::find_if(kNumpyTypes.begin(), kNumpyTypes.end(),
                                          [&](const auto& each) { return each.first == descr.substr(1); });
    if (type == kNumpyTypes.end()) return {};
    StoredNumberFormat format;
    format.type = type->second;
    format.bigEndian = descr[0] == '>' || (descr[0] != '<' && std::endian::native == std::endian::big);
    return format;
}

bool StoredNumberFormat::needsNoConversion() const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return scale == 1 && offset == 0 && missing.empty() && min == -kInfinity && max == kInfinity;
}

double StoredNumberFormat::roundedToType(double number) const {
    // A file may state the greatest 32-bit float as 3.4028235e38, a decimal number that is slightly greater than this
    // float.
    constexpr double kMost{std::numeric_limits<float>::max()}, kRoundedToMost = kMost * (1 + 0x1p-25);
    if (type != NumberType::f4 || !(std::abs(number) < kRoundedToMost)) return number;
    return double{static_cast<float>(std::clamp(number, -kMost, kMost))};
}

void StoredNumberFormat::roundLimitsToType() {
    for (double& number : missing) number = roundedToType(number);
    min = roundedToType(min);
    max = roundedToType(max);
}

void convertToFloats(const StoredNumberFormat& format, const std::byte* from, const StridedLayout& layout, float* to) {
    switch (format.type) {
        case NumberType::boolean:
            return convertInFileByteOrder<BooleanByte>(format, from, layout, to);
        case NumberType::i1:
            return convertInFileByteOrder<std::int8_t>(format, from, layout, to);
        case NumberType::u1:
            return convertInFileByteOrder<std::uint8_t>(format, from, layout, to);
        case NumberType::i2:
            return convertInFileByteOrder<std::int16_t>(format, from, layout, to);
        case NumberType::u2:
            return convertInFileByteOrder<std::uint16_t>(format, from, layout, to);
        case NumberType::i4:
            return convertInFileByteOrder<std::int32_t>(format, from, layout, to);
        case NumberType::u4:
            return convertInFileByteOrder<std::uint32_t>(format, from, layout, to);
        case NumberType::i8:
            return convertInFileByteOrder<std::int64_t>(format, from, layout, to);
        case NumberType::u8:
            return convertInFileByteOrder<std::uint64_t>(format, from, layout, to);
        case NumberType::f2:
            return convertInFileByteOrder<HalfFloat>(format, from, layout, to);
        case NumberType::f4:
            return convertInFileByteOrder<float>(format, from, layout, to);
        case NumberType::f8:
            return convertInFileByteOrder<double>(format, from, layout, to);
    }
}

}  // namespace oval4d::fields
