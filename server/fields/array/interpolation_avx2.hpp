#pragma once
// Quadrilinear interpolation with AVX2, eight points at once.

#include <span>

#include "fields/array/interpolation.hpp"

namespace oval4d::fields::avx2 {

/// Returns whether this processor has AVX2. If the result is false, interpolate() must not be called.
bool isSupported();

/// Writes the values at the points, and the gradients unless `gradients` is null. The number of points must be a
/// multiple of 8, and the lattice must have at least two samples along x.
void interpolate(const SampledLattice& from, const PointBatch& points, std::span<float> values,
                 const GradientBatch* gradients);

}  // namespace oval4d::fields::avx2
