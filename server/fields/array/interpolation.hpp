#pragma once
// Quadrilinear interpolation of samples on a lattice.

#include <cstdint>
#include <span>

#include "fields/array/lattice.hpp"
#include "fields/scalar_function.hpp"

namespace oval4d::fields {

/// The instruction set that interpolation uses. The results of all instruction sets are the same, bit for bit.
enum class InstructionSet : std::uint8_t {
    portable,  ///< runs on every processor
    avx2,      ///< must not be used unless fastestInstructions() returns it
};

/// Returns the fastest instruction set that this processor has.
InstructionSet fastestInstructions();

/// The samples to be interpolated, and the lattice at whose points they lie.
struct SampledLattice {
    const Lattice& lattice;
    const float* samples;  ///< sampleCount(lattice.shape) numbers, in the order of Lattice
};

/// Writes the values of the quadrilinear interpolant at the points, as ArrayFunction::evaluate() specifies.
void interpolate(const SampledLattice& from, const PointBatch& points, std::span<float> values,
                 InstructionSet instructions);

/// Like interpolate(), but also writes the gradients, as ArrayFunction::evaluateWithGradient() specifies.
void interpolateWithGradient(const SampledLattice& from, const PointBatch& points, std::span<float> values,
                             const GradientBatch& gradients, InstructionSet instructions);

}  // namespace oval4d::fields
