#pragma once
// The mapping of the dimensions of an array in a file to the axes x, y, z and w of a field.

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "errors/error.hpp"
#include "fields/array/shape.hpp"
#include "fields/readers/field_array.hpp"
#include "fields/readers/file_contents.hpp"
#include "fields/readers/numbers.hpp"

namespace oval4d::fields {

/// The maximum size of a slab, in numbers. A slab is a part of an array that is read and converted at once. After each
/// slab, the readers release the pages of mapped files.
inline constexpr std::size_t kSlabSize = std::size_t{1} << 24U;

/// The size in bytes of the caches of the libraries for HDF5 and NetCDF. The caches keep decompressed chunks, because
/// several slabs may need the same chunk.
inline constexpr std::size_t kChunkCacheSize = std::size_t{192} << 20U;

/// A dimension of an array in a file.
struct ArrayDimension {
    std::size_t size = 1;
    std::size_t axis = 0;   ///< the axis of the field: 0 … 3 for x, y, z, w
    bool reversed = false;  ///< whether the coordinate decreases along the dimension
};

/// Returns the axis of each dimension of an array, 0 … 3 for x, y, z, w, in the order of the array's indices. `axes`
/// has a letter for each dimension: x, y, z, w, or t for w. If `axes` is empty, uses "tzyx", "zyx", "yx" or "x",
/// depending on the number of dimensions. Errors: `bad_field` if there are no dimensions, or more than 4;
/// `out_of_range` if `axes` does not have as many letters as there are dimensions, has another letter, or has an axis
/// twice.
Result<std::vector<std::size_t>> parseAxes(std::string_view axes, std::size_t dimensions);

/// Returns the indices of the dimensions of an array that are mapped to axes, in ascending order. `sizes` are the sizes
/// of the dimensions. If there are more than 4 dimensions, leaves out dimensions of size 1, from the first on, until 4
/// remain: an array often has such a dimension for the only member of an ensemble. More than 4 indices are returned if
/// too many dimensions are larger; parseAxes() refuses such an array.
std::vector<std::size_t> squeezedDimensionIndices(std::span<const std::size_t> sizes);

/// A part of an array that is read and converted at once.
struct Slab {
    std::array<std::size_t, 4> start;  ///< the indices of the slab's first number, in the order of StridedLayout::size
    StridedLayout layout;              ///< the sizes of the slab, and the strides among the samples of the field
    std::size_t first;                 ///< the index, among the samples of the field, of the slab's first number
};

/// Maps the dimensions of an array in a file to the axes of the samples of a field: says where each number of the file
/// belongs among the samples.
class AxisMapping {
  public:
    /// `dimensions` are the dimensions of the array, from the slowest to the fastest; all must have different axes.
    /// Errors: `bad_field` if a dimension has the size 0; `too_large` if an axis has more than kMaxSamplesPerAxis
    /// samples, or if there are more than `maxSamples` samples in all.
    static Result<AxisMapping> fromDimensions(std::span<const ArrayDimension> dimensions, std::size_t maxSamples);

    const Shape& shape() const { return shape_; }
    std::size_t count() const { return sampleCount(shape_); }

    /// Returns the sizes of the array's dimensions and, for each of them, the stride: the distance among the samples
    /// between neighbors. If the array has fewer than 4 dimensions, dimensions of size 1 precede them.
    const StridedLayout& layout() const { return layout_; }
    /// Returns the index, among the samples, of the array's first number. The index is 0 unless a dimension is
    /// reversed.
    std::size_t firstSampleIndex() const { return first_; }

    /// Returns whether the file stores the numbers in the memory order of the samples: x fastest, w slowest (see
    /// Lattice).
    bool isInMemoryOrder() const;

    /// Divides the array into slabs of at most `maxCount` numbers, in the order of the file. The slabs are as large as
    /// possible: a part of a compressed file may be decompressed again for each slab that needs it.
    std::vector<Slab> slabs(std::size_t maxCount) const;

    /// Returns the samples of the array. `bytes` is the part of `file` that stores the numbers in the format `format`;
    /// it must contain at least count() numbers. Uses the bytes in place, without a copy, if they are aligned, in order
    /// (see isInMemoryOrder()), and plain 32-bit floats (see StoredNumberFormat::needsNoConversion()) in this
    /// processor's byte order. Otherwise, converts them. Errors: those of SampleBuffer::allocate().
    Result<SampleStorage> samples(const FileContents& file, std::span<const std::byte> bytes,
                                  const StoredNumberFormat& format, const FieldReadOptions& options) const;

  private:
    Shape shape_{1, 1, 1, 1};
    StridedLayout layout_{{1, 1, 1, 1}, {0, 0, 0, 0}};
    std::size_t first_ = 0;
};

/// Returns a box for an array for which only the shape is known. The box is centered at the origin. The distance
/// between samples is the same along all axes, and the longest axis extends from −1 to 1. However, if `time` is true, w
/// always extends from −1 to 1, and only x, y and z follow these rules. An axis with one sample has no extent.
Box defaultBox(const Shape& shape, bool time);

}  // namespace oval4d::fields
