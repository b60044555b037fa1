#pragma once
// The types of numbers in files, and the conversion of numbers to 32-bit floats.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

namespace oval4d::fields {

/// A type of numbers: Booleans of one byte, signed (i) and unsigned (u) integers, and IEEE 754 floats (f). The digit is
/// the size in bytes.
enum class NumberType : std::uint8_t { boolean, i1, u1, i2, u2, i4, u4, i8, u8, f2, f4, f8 };

/// Returns the size of a number in bytes.
std::size_t sizeOf(NumberType type);

/// The format of stored numbers: how they are stored, and which values they stand for.
struct StoredNumberFormat {
    NumberType type = NumberType::f4;
    bool bigEndian = false;
    double scale = 1, offset = 0;                           ///< a stored number n stands for n · scale + offset
    std::vector<double> missing;                            ///< stored numbers that stand for no value
    double min = -std::numeric_limits<double>::infinity();  ///< stored numbers outside min … max stand for no value
    double max = std::numeric_limits<double>::infinity();

    /// Returns whether all stored numbers stand for themselves: there is no scale, offset, missing number or limit.
    bool needsNoConversion() const;

    /// Returns the 32-bit float that is closest to `number` if `type` is f4; otherwise, returns `number`. A file of
    /// 32-bit floats may state a missing value or a limit as a double or in decimal notation, such as 0.1, which is not
    /// equal to a 32-bit float. A number beyond the largest float is returned unchanged.
    double roundedToType(double number) const;
    /// Applies roundedToType() to `missing`, `min` and `max`.
    void roundLimitsToType();
};

/// Returns the format for a NumPy type string such as "<f4": a byte order (< little, > big, = or | this processor's), a
/// kind and a size in bytes. Returns an empty optional if the type is not one of NumberType.
std::optional<StoredNumberFormat> numberFormatOf(std::string_view descr);

/// The sizes of a block of stored numbers, and the places to which the numbers go. The number with the indices i[0] …
/// i[3] goes to i[0] · stride[0] + … + i[3] · stride[3], relative to the place of the first number. The dimensions are
/// those of the stored numbers; the last one varies fastest.
struct StridedLayout {
    std::array<std::size_t, 4> size;
    std::array<std::ptrdiff_t, 4> stride;
};

/// Converts the numbers of a block to the nearest 32-bit floats. `from` points to the stored numbers, which need not be
/// aligned; `to` is the place of the first number. Numbers that stand for no value, and finite numbers beyond the
/// largest float, become NaN. Infinite numbers become NaN or stay infinite, both of which ArrayFunction treats as
/// missing samples.
void convertToFloats(const StoredNumberFormat& format, const std::byte* from, const StridedLayout& layout, float* to);

}  // namespace oval4d::fields
