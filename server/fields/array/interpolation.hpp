#pragma once
// Quadrilinear interpolation of samples on a lattice.

#include <cstdint>
#include <span>

#include "fields/array/lattice.hpp"
#include "fields/scalar_function.hpp"

namespace oval4d::fields {

/// The instruction set that interpolation uses. All instruction sets give the same results, bit for bit.
enum class InstructionSet : std::uint8_t {
    portable,  ///< runs on every processor
    avx2,      ///< runs only on processors with AVX2 (see fastestInstructionSet())
};

/// Returns the fastest instruction set that this processor has.
InstructionSet fastestInstructionSet();

/// The samples to interpolate, and the lattice on which they lie.
struct SampledLattice {
    const Lattice& lattice;
    const float* samples;  ///< sampleCount(lattice.shape) numbers, in the order of Lattice
};

/// Writes the values of the quadrilinear interpolant at the points, as described at ArrayFunction::evaluate().
void interpolate(const SampledLattice& from, const PointBatch& points, std::span<float> values,
                 InstructionSet instructions);

/// Writes the value and the gradient of the quadrilinear interpolant at each point.
/// ArrayFunction::evaluateWithGradient() says what the gradient is between two cells, outside the box, and where
/// samples are missing.
void interpolateWithGradient(const SampledLattice& from, const PointBatch& points, std::span<float> values,
                             const GradientBatch& gradients, InstructionSet instructions);

}  // namespace oval4d::fields
