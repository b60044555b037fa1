#pragma once
// Makes coarser versions of arrays.

#include <cstddef>
#include <span>
#include <vector>

#include "fields/array/samples.hpp"
#include "fields/array/shape.hpp"

namespace oval4d::fields {

/// Returns the shape of a downsampled array: half as many cells along each axis, rounded up.
Shape downsampledShape(const Shape& shape);

/// Returns the samples of the downsampled array, as ArrayFunction::downsampled() specifies. `shape` is the shape of
/// `samples`.
std::vector<float> downsample(const Shape& shape, std::span<const float> samples);

/// Halves the longest axis of `shape` until there are at most `maxSamples` samples, and returns the result.
Shape selectionShape(Shape shape, std::size_t maxSamples);

/// Returns samples at equal distances, with the first and the last along each axis: those nearest to the positions of a
/// lattice of the shape `size` in the same box. Reads no other samples.
std::vector<float> selectSamples(const Shape& shape, const Samples& samples, const Shape& size);

}  // namespace oval4d::fields
