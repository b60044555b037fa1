#include "fields/formula/kernels_portable.hpp"

#include "fields/formula/gradient_loops.hpp"
#include "fields/formula/portable_math.hpp"

namespace oval4d::fields {

namespace {

struct UniqueSourceFileTag {};

}  // namespace

const TapeKernels& portableKernels() {
    static constexpr TapeKernels kKernels = TapeDifferentiator<PortableMath<UniqueSourceFileTag>>::kernels();
    return kKernels;
}

}  // namespace oval4d::fields
