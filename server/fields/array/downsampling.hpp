#pragma once
// Downsampled versions and selections of the samples of arrays.

#include <cstddef>
#include <span>
#include <vector>

#include "fields/array/sample_storage.hpp"
#include "fields/array/shape.hpp"

namespace oval4d::fields {

/// Returns the shape of a downsampled array, which has half as many cells along each axis, rounded up.
Shape downsampledShape(const Shape& shape);

/// Returns the samples of a downsampled array, which is described at ArrayFunction::downsampled(). `shape` is the shape
/// of `samples`.
std::vector<float> downsample(const Shape& shape, std::span<const float> samples);

/// Returns the shape of a selection of at most `maxSamples` samples of an array with the shape `shape`. Halves the
/// number of samples along the axis with the most samples, rounding up, until there are few enough samples in all.
Shape selectionShape(Shape shape, std::size_t maxSamples);

/// Returns a selection of `samples`: for each point of a lattice with the shape `size` in the same box, the nearest
/// sample. Along an axis with several points, the first and the last sample are selected among others; along an axis
/// with one point, only the first sample. `shape` is the shape of `samples`. Reads only the selected samples.
std::vector<float> selectSamples(const Shape& shape, const SampleStorage& samples, const Shape& size);

}  // namespace oval4d::fields
