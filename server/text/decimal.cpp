#include "text/decimal.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace oval4d::text {

namespace {

constexpr std::array<std::uint64_t, 10'000> smallIntegerTexts() {
    std::array<std::uint64_t, 10'000> all{};
    for (std::uint32_t number = 0; number < all.size(); ++number) {
        std::uint64_t text = 0;
        std::uint64_t length = 0;
        std::uint32_t rest = number;
        do {
            text = text << 8U | ('0' + rest % 10);
            ++length;
            rest /= 10;
        } while (rest != 0);
        all.at(number) = text | length << 56U;
    }
    return all;
}

// The JSON text after a number: "," within a vector, and "],[" after the last number of a vector.
struct JsonSeparator {
    char text[4];
    std::size_t length;
};
template <std::size_t Size>
constexpr std::array<JsonSeparator, Size> vectorSeparators() {
    std::array<JsonSeparator, Size> all{};
    for (auto& each : all) each = {",", 1};
    all.back() = {"],[", 3};
    return all;
}

char* putSeparator(char* at, const JsonSeparator& separator) {
    std::memcpy(at, separator.text, sizeof separator.text);
    return at + separator.length;
}

// From this number on, std::to_chars may write integers with an exponent.
constexpr float kExponentFrom = 1e5F;

// Writes numbers[begin] … numbers[end − 1] at `at`, each followed by its separator. `numbers` contains the coordinates
// of vectors with `Size` coordinates each, from the first coordinate of the first vector on. Returns the end of the
// text.
template <std::size_t Size>
char* putCoordinatesScalar(char* at, const double* numbers, std::size_t begin, std::size_t end) {
    static constexpr auto kSeparators = vectorSeparators<Size>();
    for (std::size_t i = begin; i < end; ++i) {
        const auto number = static_cast<float>(numbers[i]);
        char* const room = at + 2 * kBytesPerNumber;
        const bool large = std::abs(number) >= kExponentFrom && isExactInteger(number);
        at = large ? std::to_chars(at, room, static_cast<std::int64_t>(number)).ptr
                   : std::to_chars(at, room, number).ptr;
        at = putSeparator(at, kSeparators[i % Size]);
    }
    return at;
}

#if defined(__x86_64__)

using SimdDouble4 = double __attribute__((vector_size(32)));
using SimdUint64x4 = std::uint64_t __attribute__((vector_size(32)));
using SimdUint32x8 = std::uint32_t __attribute__((vector_size(32)));
using SimdFloat4 = float __attribute__((vector_size(16)));
using SimdInt32x4 = std::int32_t __attribute__((vector_size(16)));

// A group is four numbers, which fill one AVX2 register of doubles. A block is several groups. Each step of the
// computation processes all groups of a block before the next step begins. Groups do not depend on each other, so this
// hides the latency of the instructions.
constexpr std::size_t kGroups = 3, kBlock = 4 * kGroups;  // kBlock is a multiple of 3 and 4, the sizes of vectors

// The texts of the numbers of a block. The text of a number is in two integers, `head` and `digits`. The first
// character is in the lowest byte of `head`.
struct FormattedNumbers {
    alignas(32) std::uint64_t head[kBlock];  // for each number: its text up to and including the second decimal
    // For each number: the number of bytes in `head`.
    alignas(32) std::uint64_t headLength[kBlock];
    // For each number: the next eight decimals, including trailing zeros, as bytes from 0 to 9. The lowest byte is the
    // first of these decimals.
    alignas(32) std::uint64_t digits[kBlock];
    // For each group: whether putCoordinatesScalar() must write all numbers of the group, because `head` and `digits`
    // cannot be used. This is so in two cases: a number is too small or too large for `head` and `digits`, or a number
    // has no nonzero digit after the second decimal. In the second case, `head` could end in superfluous zeros.
    bool needsFallback[kGroups];
};

// The method: round a float from 2^e to 2^(e + 1) to the nearest integer multiple of 10^−p. Here, 10^−p is the largest
// power of ten below 2^(e − 23), the spacing of these floats. Therefore, the same float is read back from this
// multiple. At most one integer multiple of 10^(1 − p), which has one decimal less, gives the same float, too. If there
// is such a multiple, it is used instead.
//
// The method works for e from −10 to 5; p decreases from 10 to 6 as e increases. The bounds have two reasons:
// - FormattedNumbers has room for only ten decimals, and for only two digits before the point.
// - Below a power of two, the spacing of floats is half as large, so another float might be read back from the
//   multiple nearest to the power of two. This cannot happen if the power 2^e is itself a multiple of 10^−p, that is,
//   if it has at most p decimals. For negative e, it has −e decimals, so e must be at least −10.
constexpr std::int32_t kMinExponent = -10, kExponents = 16;
// kExponentMask selects the exponent bits of a float. Subtracting kHalfSpacing from these bits gives the bits of the
// float 2^(e − 24), half the spacing of the floats from 2^e to 2^(e + 1).
constexpr std::int32_t kExponentMask = 0x7F80'0000, kHalfSpacing = 24 << 23;
// A bound for the rounding errors of formatNumbers(), in units of 10^−p.
constexpr double kMargin = 0x1p-20;

// Tables for the unit 10^−p, with the index 10 − p. kUnitsPerOne contains 10^p. kUnitSize contains the unit as a
// multiple of 10^−10. Floats represent all these numbers exactly.
constexpr std::array<float, 8> kUnitsPerOne{1e10, 1e9, 1e8, 1e7, 1e6}, kUnitSize{1e0, 1e1, 1e2, 1e3, 1e4};

// A number that rounds: adding kRounder to a number from −0.5 to 2^51 (exclusive) rounds it to an integer. This integer
// is in the low bits of the sum, from which extractInteger() extracts it.
constexpr double kRounder = 0x1.8p52;
[[gnu::target("avx2")]] inline SimdUint64x4 extractInteger(SimdDouble4 sum) {
    return SimdUint64x4(sum) ^ std::bit_cast<std::uint64_t>(kRounder);
}

[[gnu::target("avx2")]] inline SimdDouble4 toDoubles(SimdFloat4 numbers) {
    return SimdDouble4(_mm256_cvtps_pd(__m128(numbers)));
}

// Returns table[which[i]] for each i.
[[gnu::target("avx2")]] inline SimdDouble4 lookUp(const std::array<float, 8>& table, SimdInt32x4 which) {
    const __m256i places = _mm256_castsi128_si256(__m128i(which));
    const __m256 picked = _mm256_permutevar8x32_ps(_mm256_loadu_ps(table.data()), places);
    return toDoubles(SimdFloat4(_mm256_castps256_ps128(picked)));
}

// Operations on 16-bit elements: addWords() adds them, and multiplyHigh() returns the upper 16 bits of the products.
[[gnu::target("avx2")]] inline SimdUint64x4 addWords(SimdUint64x4 a, SimdUint64x4 b) {
    return SimdUint64x4(_mm256_add_epi16(__m256i(a), __m256i(b)));
}
[[gnu::target("avx2")]] inline SimdUint64x4 multiplyHigh(SimdUint64x4 a, short b) {
    return SimdUint64x4(_mm256_mulhi_epu16(__m256i(a), _mm256_set1_epi16(b)));
}
// Returns the products of the lower byte of each 16-bit number and `b`, which must be from −128 to 127.
[[gnu::target("avx2")]] inline SimdUint64x4 multiplyLowBytes(SimdUint64x4 a, int b) {
    return SimdUint64x4(_mm256_maddubs_epi16(__m256i(a), _mm256_set1_epi16(b & 0xFF)));
}

// Converts each 32-bit half of each element to its four decimal digits, with one digit per byte. The lowest byte is the
// most significant digit. Each half must be below 10,000.
[[gnu::target("avx2")]] inline SimdUint64x4 fourDigits(SimdUint64x4 numbers) {
    const auto hundreds = SimdUint64x4(SimdUint32x8(multiplyHigh(numbers, 5243)) >> 3);
    const SimdUint64x4 pairs = hundreds | addWords(numbers, multiplyLowBytes(hundreds, -100)) << 16;
    const SimdUint64x4 tens = multiplyHigh(pairs, 6554);
    return tens | addWords(pairs, multiplyLowBytes(tens, -10)) << 8;
}

[[gnu::target("avx2")]] void formatNumbers(const double* numbers, FormattedNumbers& out) {
    SimdInt32x4 bits[kGroups], drop[kGroups], outOfRange[kGroups];
    SimdDouble4 unitsPerOne[kGroups], exact[kGroups], rounder[kGroups], decimals[kGroups], upper[kGroups];
    SimdUint64x4 digits[kGroups], first[kGroups];
    for (std::size_t g = 0; g < kGroups; ++g) {
        SimdDouble4 four;
        std::memcpy(&four, numbers + 4 * g, sizeof four);
        bits[g] = SimdInt32x4(__builtin_convertvector(four, SimdFloat4));
        const SimdInt32x4 place = ((bits[g] & kExponentMask) >> 23) - (127 + kMinExponent);
        outOfRange[g] = place & ~(kExponents - 1);
        // The index 10 − p, which is 10 + log10(2^(e − 23)), rounded down.
        drop[g] = (place * 1233 + 270) >> 12;
    }
    for (std::size_t g = 0; g < kGroups; ++g) {
        unitsPerOne[g] = lookUp(kUnitsPerOne, drop[g]);
        exact[g] = toDoubles(SimdFloat4(bits[g] & 0x7FFF'FFFF)) * unitsPerOne[g];
    }
    for (std::size_t g = 0; g < kGroups; ++g) rounder[g] = ((exact[g] * 0.1 + kRounder) - kRounder) * 10;
    for (std::size_t g = 0; g < kGroups; ++g) {
        const auto half = SimdFloat4((bits[g] & kExponentMask) - kHalfSpacing);
        const SimdDouble4 reach = toDoubles(half) * unitsPerOne[g] - kMargin;
        const SimdDouble4 off = SimdDouble4(SimdUint64x4(rounder[g] - exact[g]) & ~std::uint64_t{0} >> 1);
        const SimdDouble4 nearest = (exact[g] + kRounder) - kRounder;
        decimals[g] = (off < reach ? rounder[g] : nearest) * lookUp(kUnitSize, drop[g]);
    }
    for (std::size_t g = 0; g < kGroups; ++g) upper[g] = (decimals[g] - 49'999'999.5) * 1e-8 + kRounder;
    for (std::size_t g = 0; g < kGroups; ++g) {
        const SimdDouble4 eight = decimals[g] - (upper[g] - kRounder) * 1e8;
        const SimdDouble4 thousands = (eight - 4'999.5) * 1e-4 + kRounder;
        digits[g] = extractInteger(thousands) | extractInteger(eight - (thousands - kRounder) * 1e4 + kRounder) << 32;
    }
    for (std::size_t g = 0; g < kGroups; ++g) {
        digits[g] = fourDigits(digits[g]);
        // The digits of the tens, ones, tenths and hundredths.
        first[g] = fourDigits(extractInteger(upper[g]));
    }
    for (std::size_t g = 0; g < kGroups; ++g) {
        const SimdUint64x4 tens = first[g] & 0xFF;
        const SimdUint64x4 tensBits = tens != 0 ? SimdUint64x4{} + 8 : SimdUint64x4{};
        const SimdUint64x4 negative = SimdUint64x4(_mm256_cvtepi32_epi64(__m128i(bits[g] >> 31)));
        const SimdUint64x4 signBits = negative & 8;
        SimdUint64x4 head = (first[g] >> 8 & 0xFF) | (first[g] & 0xFFFF'0000) | 0x3030'2E30;
        head = head << tensBits | (tens != 0 ? tens | '0' : tens);
        head = head << signBits | (negative & '-');
        const SimdUint64x4 length = 4 + ((tensBits + signBits) >> 3);
        std::memcpy(out.head + 4 * g, &head, sizeof head);
        std::memcpy(out.headLength + 4 * g, &length, sizeof length);
        std::memcpy(out.digits + 4 * g, &digits[g], sizeof digits[g]);
        const SimdUint64x4 zero = digits[g] == 0;
        out.needsFallback[g] = (outOfRange[g][0] | outOfRange[g][1] | outOfRange[g][2] | outOfRange[g][3]) != 0 ||
                               (zero[0] | zero[1] | zero[2] | zero[3]) != 0;
    }
}

template <std::size_t Size>
[[gnu::target("avx2")]] char* putBlock(char* at, const double* numbers, std::size_t count) {
    static constexpr auto kSeparators = vectorSeparators<Size>();
    FormattedNumbers block;
    formatNumbers(numbers, block);
#pragma GCC unroll 12
    for (std::size_t i = 0; i < count; ++i) {
        if (block.needsFallback[i / 4]) {
            at = putCoordinatesScalar<Size>(at, numbers, i, i + 1);
            continue;
        }
        std::memcpy(at, &block.head[i], 8);
        at += block.headLength[i];
        const std::uint64_t digits = block.digits[i] | 0x3030'3030'3030'3030;
        std::memcpy(at, &digits, 8);
        const auto zeros = static_cast<unsigned>(std::countl_zero(block.digits[i])) / 8;
        at = putSeparator(at + 8 - zeros, kSeparators[i % Size]);
    }
    return at;
}

template <std::size_t Size>
[[gnu::target("avx2")]] char* putBlocks(char* at, const double* numbers, std::size_t count) {
    std::size_t i = 0;
    for (; i + kBlock <= count; i += kBlock) at = putBlock<Size>(at, numbers + i, kBlock);
    if (i == count) return at;
    std::array<double, kBlock> rest;
    rest.fill(numbers[i]);
    std::copy(numbers + i, numbers + count, rest.begin());
    return putBlock<Size>(at, rest.data(), count - i);
}

template <std::size_t Size>
char* putCoordinates(char* at, const double* numbers, std::size_t count) {
    static const bool blocks = __builtin_cpu_supports("avx2") != 0;
    return blocks ? putBlocks<Size>(at, numbers, count) : putCoordinatesScalar<Size>(at, numbers, 0, count);
}

#else

template <std::size_t Size>
char* putCoordinates(char* at, const double* numbers, std::size_t count) {
    return putCoordinatesScalar<Size>(at, numbers, 0, count);
}

#endif

template <typename V>
char* putVectorList(char* at, std::span<const V> list) {
    if (list.empty()) return at;
    *at++ = '[';
    at = putCoordinates<sizeof(V) / sizeof(double)>(at, &list[0].x, list.size() * (sizeof(V) / sizeof(double)));
    return at - 2;  // omits the ",[" after the last vector
}

}  // namespace

constinit const std::array<std::uint64_t, 10'000> kSmallIntegerTexts = smallIntegerTexts();

char* putLargeInteger(char* at, std::uint32_t number) {
    at = putInteger(at, number / 10'000);
    const std::uint64_t rest = kSmallIntegerTexts[number % 10'000];
    std::memcpy(at, "0000", 4);
    std::memcpy(at + 4 - (rest >> 56U), &rest, sizeof rest);
    return at + 4;
}

char* putVectorsAsJson(char* at, std::span<const glm::dvec3> list) { return putVectorList(at, list); }
char* putVectorsAsJson(char* at, std::span<const glm::dvec4> list) { return putVectorList(at, list); }

}  // namespace oval4d::text
