// This file is compiled with -mavx2. If several files compile the same inline function, the linker keeps only one copy.
// If the linker kept the copy of this file, processors without AVX2 could not run it. Therefore all functions here have
// internal linkage, or are templates with an argument type that only this file has.
#include "fields/formula/kernels_avx2.hpp"

#ifdef __AVX2__

#include <immintrin.h>

#include "fields/formula/gradient_loops.hpp"
#include "fields/formula/portable_math.hpp"

namespace oval4d::fields {

#ifdef OVAL4D_LIBMVEC

// The vector functions of glibc, which compute eight floats at once.
__m256 exp8(__m256) __asm__("_ZGVdN8v_expf");
__m256 log8(__m256) __asm__("_ZGVdN8v_logf");
__m256 sin8(__m256) __asm__("_ZGVdN8v_sinf");
__m256 cos8(__m256) __asm__("_ZGVdN8v_cosf");
__m256 tan8(__m256) __asm__("_ZGVdN8v_tanf");
__m256 asin8(__m256) __asm__("_ZGVdN8v_asinf");
__m256 acos8(__m256) __asm__("_ZGVdN8v_acosf");
__m256 atan8(__m256) __asm__("_ZGVdN8v_atanf");
__m256 sinh8(__m256) __asm__("_ZGVdN8v_sinhf");
__m256 cosh8(__m256) __asm__("_ZGVdN8v_coshf");
__m256 tanh8(__m256) __asm__("_ZGVdN8v_tanhf");
__m256 cbrt8(__m256) __asm__("_ZGVdN8v_cbrtf");
__m256 pow8(__m256, __m256) __asm__("_ZGVdN8vv_powf");
__m256 atan28(__m256, __m256) __asm__("_ZGVdN8vv_atan2f");

namespace {

struct Avx2Math {
    static void unary(Operation operation, float* out, const float* a, std::size_t size) {
        switch (operation) {
            case Operation::exp:
                return map<exp8>(out, a, size);
            case Operation::log:
                return map<log8>(out, a, size);
            case Operation::sin:
                return map<sin8>(out, a, size);
            case Operation::cos:
                return map<cos8>(out, a, size);
            case Operation::tan:
                return map<tan8>(out, a, size);
            case Operation::asin:
                return map<asin8>(out, a, size);
            case Operation::acos:
                return map<acos8>(out, a, size);
            case Operation::atan:
                return map<atan8>(out, a, size);
            case Operation::sinh:
                return map<sinh8>(out, a, size);
            case Operation::cosh:
                return map<cosh8>(out, a, size);
            case Operation::tanh:
                return map<tanh8>(out, a, size);
            case Operation::cbrt:
                return map<cbrt8>(out, a, size);
            default:
                return;
        }
    }
    static void powerOrAtan2(Operation operation, float* out, const float* a, const float* b, std::size_t size) {
        if (operation == Operation::power) {
            map<pow8>(out, a, b, size);
        } else {
            map<atan28>(out, a, b, size);
        }
    }

  private:
    template <__m256 (*function)(__m256)>
    static void map(float* out, const float* a, std::size_t size) {
        for (std::size_t i = 0; i < size; i += kKernelLanes)
            _mm256_storeu_ps(out + i, function(_mm256_loadu_ps(a + i)));
    }
    template <__m256 (*function)(__m256, __m256)>
    static void map(float* out, const float* a, const float* b, std::size_t size) {
        for (std::size_t i = 0; i < size; i += kKernelLanes)
            _mm256_storeu_ps(out + i, function(_mm256_loadu_ps(a + i), _mm256_loadu_ps(b + i)));
    }
};
using Math = Avx2Math;

#else

namespace {

struct Avx2SourceTag {};
using Math = PortableMath<Avx2SourceTag>;

#endif

}  // namespace

const TapeKernels* avx2Kernels() {
    static constexpr TapeKernels kKernels = TapeDifferentiator<Math>::kernels();
    return __builtin_cpu_supports("avx2") ? &kKernels : nullptr;
}

}  // namespace oval4d::fields

#else

namespace oval4d::fields {

const TapeKernels* avx2Kernels() { return nullptr; }

}  // namespace oval4d::fields

#endif
