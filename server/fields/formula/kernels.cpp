#include "fields/formula/kernels.hpp"

#include "fields/formula/kernels_avx2.hpp"
#include "fields/formula/kernels_portable.hpp"

namespace oval4d::fields {

const TapeKernels& fastestKernels() {
    static const TapeKernels* const kFastest = avx2Kernels() != nullptr ? avx2Kernels() : &portableKernels();
    return *kFastest;
}

}  // namespace oval4d::fields
