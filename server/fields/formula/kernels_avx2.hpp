#pragma once
// Kernels for x86-64 processors with AVX2.

#include "fields/formula/kernels.hpp"

namespace oval4d::fields {

/// Returns the kernels for AVX2. Returns nullptr if this processor has no AVX2, or if the program was compiled without
/// it.
const TapeKernels* avx2Kernels();

}  // namespace oval4d::fields
