#pragma once
// The mathematical functions of the C library, applied to the elements of arrays.

#include <math.h>  // not <cmath>, whose inline functions must not be used: see TapeEvaluator

#include <cstddef>

#include "fields/formula/operation.hpp"

namespace oval4d::fields {

/// The `Math` argument of TapeEvaluator for every processor. `Source` must be a type that only the including source
/// file has, so that other source files do not share the code (see TapeEvaluator).
template <typename Source>
struct PortableMath {
    static void unary(Operation operation, float* out, const float* a, std::size_t size) {
        switch (operation) {
            case Operation::exp:
                return map<::expf>(out, a, size);
            case Operation::log:
                return map<::logf>(out, a, size);
            case Operation::sin:
                return map<::sinf>(out, a, size);
            case Operation::cos:
                return map<::cosf>(out, a, size);
            case Operation::tan:
                return map<::tanf>(out, a, size);
            case Operation::asin:
                return map<::asinf>(out, a, size);
            case Operation::acos:
                return map<::acosf>(out, a, size);
            case Operation::atan:
                return map<::atanf>(out, a, size);
            case Operation::sinh:
                return map<::sinhf>(out, a, size);
            case Operation::cosh:
                return map<::coshf>(out, a, size);
            case Operation::tanh:
                return map<::tanhf>(out, a, size);
            case Operation::cbrt:
                return map<::cbrtf>(out, a, size);
            default:
                return;
        }
    }
    static void powerOrAtan2(Operation operation, float* out, const float* a, const float* b, std::size_t size) {
        if (operation == Operation::power) {
            for (std::size_t i = 0; i < size; ++i) out[i] = ::powf(a[i], b[i]);
        } else {
            for (std::size_t i = 0; i < size; ++i) out[i] = ::atan2f(a[i], b[i]);
        }
    }

  private:
    template <float (*function)(float)>
    static void map(float* out, const float* a, std::size_t size) {
        for (std::size_t i = 0; i < size; ++i) out[i] = function(a[i]);
    }
};

}  // namespace oval4d::fields
