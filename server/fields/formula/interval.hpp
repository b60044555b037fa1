#pragma once
// Interval arithmetic. The interval of an operation contains both its exact real value and the float that evaluate()
// computes for it.
//
// Proof by induction over the operations of a formula: the interval of each operand contains the exact value and the
// float, and the interval of the result is computed such that it contains the exact result and its float, too. Let m
// and M be bounds of the exact results for all real operands in the intervals; these include the operands that are
// floats.
//
// - Addition, subtraction, multiplication, division, squares and square roots are correctly rounded. The float is the
//   exact result times 1 + δ, |δ| ≤ 2⁻²⁴; it is off by at most 2⁻¹⁵⁰ if it is subnormal, and infinite if it is beyond
//   the largest float. Therefore m and M are moved outward by 2⁻²³ of their value and by 2⁻¹⁴⁸, and an end beyond the
//   largest float becomes infinite. This also covers the error of computing m and M in double precision (2⁻⁵³ for
//   arithmetic, a few times that for the functions of the C library). A correctly rounded result never has the wrong
//   sign, so an end is never moved beyond 0.
// - Functions such as sin have errors of at most 4 units in the last place (2⁻²¹ of the value, which the tests check).
//   Each end of their intervals is moved outward by 2⁻²⁰ of its value and, because they may return 0 for a subnormal
//   result, by 2⁻¹²⁵.
// - aⁿ is computed by multiplications, with a relative error of less than n · 2⁻²⁴; each end of its interval is moved
//   outward by n · 2⁻²³ of its value. A power with the exponent n + 1/2, n ≤ 8, is aⁿ times a square root; its interval
//   is widened as for sin.
// - Negation, abs, min, max, step, sign and floor are exact.

#include "fields/formula/operation.hpp"
#include "fields/scalar_function.hpp"

namespace oval4d::fields {

/// Returns the interval of a number in a formula: it contains both the number and the float that evaluate() uses in
/// place of the number. For NaN, returns an empty interval (min > max).
ValueBounds intervalOf(double number);

/// Returns the interval of a coordinate between `min` and `max`. The ends are rounded outward to floats, so the
/// interval also contains coordinates that were rounded to floats. If `min` or `max` is NaN, the interval is unbounded,
/// and its `hasValueEverywhere` is false.
ValueBounds intervalOfCoordinate(double min, double max);

/// Returns the interval of the results of an operation, which must be neither `constant` nor `variable`. `a` and `b`
/// are the intervals of the operands; `b` is ignored if there is only one. `exponent` is the exponent of integer_power.
/// In the result, `hasValueEverywhere` is false if a result of the operation may be NaN.
ValueBounds intervalOf(Operation operation, const ValueBounds& a, const ValueBounds& b, int exponent);

}  // namespace oval4d::fields
