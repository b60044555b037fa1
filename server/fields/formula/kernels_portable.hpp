#pragma once
// Kernels for any processor.

#include "fields/formula/kernels.hpp"

namespace oval4d::fields {

const Kernels& portableKernels();

}  // namespace oval4d::fields
