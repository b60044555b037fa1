#pragma once
// Kernels for any processor.

#include "fields/formula/kernels.hpp"

namespace oval4d::fields {

/// Returns the kernels that run on every processor.
const TapeKernels& portableKernels();

}  // namespace oval4d::fields
