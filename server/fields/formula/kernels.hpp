#pragma once
// Kernels: functions that run compiled formulas (tapes) for blocks of points. There are kernels for several instruction
// sets.

#include <cstddef>

#include "fields/formula/tape.hpp"

namespace oval4d::fields {

/// The number of points that a kernel processes at once.
constexpr std::size_t kKernelLanes = 8;
/// The maximum numbers of points in a PointBlock and in a GradientBlock. With these sizes, the registers of most
/// formulas fit into the first-level cache.
constexpr std::size_t kBlockPoints = 256, kGradientBlockPoints = 64;

/// A block of points, and the memory for their values. `size` must be a multiple of kKernelLanes, and at most
/// kBlockPoints.
struct PointBlock {
    const float* coordinates[4];  ///< the arrays of x, y, z and w
    float* values;
    float* scratch;  ///< kBlockPoints floats for each scratch register of the tape
    std::size_t size;
};

/// A block of points, and the memory for their values and gradients. `size` must be a multiple of kKernelLanes, and at
/// most kGradientBlockPoints.
struct GradientBlock {
    const float* coordinates[4];
    float* values;
    float* gradients[4];  ///< the arrays of the derivatives with respect to x, y, z, w
    float* scratch;       ///< 5 · kGradientBlockPoints floats for each scratch register of the tape
    std::size_t size;
};

/// The functions of one instruction set that run the `count` instructions of a tape for a block of points. Both
/// functions compute the same values. The value at a point does not depend on the other points of the block. A gradient
/// is (0, 0, 0, 0) if the value or one of the derivatives is not finite.
struct TapeKernels {
    void (*evaluate)(const Instruction* instructions, std::size_t count, const PointBlock& block);
    void (*differentiate)(const Instruction* instructions, std::size_t count, const GradientBlock& block);
};

/// Returns the kernels of the fastest instruction set that this processor has.
const TapeKernels& fastestKernels();

}  // namespace oval4d::fields
