#include "fields/formula/operation.hpp"

#include <cmath>
#include <limits>

namespace oval4d::fields {

double applyOperation(Operation operation, double a, double b) {
    if (std::isnan(a) || (isBinary(operation) && std::isnan(b))) return std::numeric_limits<double>::quiet_NaN();
    switch (operation) {
        case Operation::constant:
        case Operation::variable:
        case Operation::copy:
            return a;
        case Operation::negate:
            return -a;
        case Operation::abs:
            return std::abs(a);
        case Operation::square:
            return a * a;
        case Operation::integer_power:
            return std::pow(a, b);
        case Operation::sqrt:
            return std::sqrt(a);
        case Operation::cbrt:
            return std::cbrt(a);
        case Operation::exp:
            return std::exp(a);
        case Operation::log:
            return std::log(a);
        case Operation::sin:
            return std::sin(a);
        case Operation::cos:
            return std::cos(a);
        case Operation::tan:
            return std::tan(a);
        case Operation::asin:
            return std::asin(a);
        case Operation::acos:
            return std::acos(a);
        case Operation::atan:
            return std::atan(a);
        case Operation::sinh:
            return std::sinh(a);
        case Operation::cosh:
            return std::cosh(a);
        case Operation::tanh:
            return std::tanh(a);
        case Operation::step:
            return a < 0 ? 0 : 1;
        case Operation::sign:
            return a < 0 ? -1 : (a > 0 ? 1 : 0);
        case Operation::floor:
            return std::floor(a);
        case Operation::add:
            return a + b;
        case Operation::subtract:
            return a - b;
        case Operation::multiply:
            return a * b;
        case Operation::divide:
            return a / b;
        case Operation::min:
            return a < b ? a : b;
        case Operation::max:
            return a > b ? a : b;
        case Operation::power:
            return std::pow(a, b);
        case Operation::atan2:
            return std::atan2(a, b);
        case Operation::mod:
            return a - b * std::floor(a / b);
    }
    return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace oval4d::fields
