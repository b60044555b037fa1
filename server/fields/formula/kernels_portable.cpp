#include "fields/formula/kernels_portable.hpp"

#include "fields/formula/gradient_loops.hpp"
#include "fields/formula/portable_math.hpp"

namespace oval4d::fields {

namespace {

struct PortableSourceTag {};

}  // namespace

const Kernels& portableKernels() {
    static constexpr Kernels kKernels = GradientLoops<PortableMath<PortableSourceTag>>::kernels();
    return kKernels;
}

}  // namespace oval4d::fields
