#pragma once
// The operations of compiled formulas. The functions that formulas may call (functions.hpp) consist of these
// operations.

#include <cstdint>

namespace oval4d::fields {

/// An operation of a compiled formula on the operands a and b. The result is NaN if an operand is NaN. Therefore pow(1,
/// NaN) and pow(NaN, 0) are NaN, unlike in C.
enum class Operation : std::uint8_t {
    // Operations without operands:
    constant,  ///< a number
    variable,  ///< x, y, z or w
    // Operations with one operand, a:
    copy,
    negate,
    abs,
    square,
    integer_power,  ///< aⁿ for a constant integer n, by multiplications
    sqrt,
    cbrt,
    exp,
    log,
    sin,
    cos,
    tan,
    asin,
    acos,
    atan,
    sinh,
    cosh,
    tanh,
    step,  ///< 0 for a < 0, otherwise 1
    sign,  ///< −1, 0 or 1
    floor,
    // Operations with two operands, a and b:
    add,
    subtract,
    multiply,
    divide,
    min,
    max,
    power,
    atan2,
    mod,  ///< a − b ⌊a/b⌋, which has the sign of b
};

/// Returns whether the operation has two operands.
constexpr bool isBinary(Operation operation) { return operation >= Operation::add; }

/// Returns the result of an operation in double precision. The operation must be neither `constant` nor `variable`. `b`
/// is the second operand, or the exponent of integer_power; other operations ignore `b`.
double applyOperation(Operation operation, double a, double b);

}  // namespace oval4d::fields
