#pragma once
// Interval arithmetic for formulas. The interval of an operation contains both the exact real result and the float that
// evaluate() computes.
//
// Proof by induction over the operations of a formula. Assume that the interval of each operand contains the exact
// value and the float. Let m and M be bounds of the exact results for all real operands in these intervals, which
// include the floats. The interval of the result is [m, M], widened for the rounding of the operation:
//
// - Addition, subtraction, multiplication, division, squares and square roots are correctly rounded. The float is the
//   exact result times 1 + δ with |δ| ≤ 2⁻²⁴; a subnormal float is off by at most 2⁻¹⁵⁰; a float beyond the largest one
//   is infinite. Therefore m and M are moved outward by 2⁻²³ of their value and by 2⁻¹⁴⁸, and an end beyond the largest
//   float becomes infinite. This also covers the error of computing m and M in double precision (2⁻⁵³ for arithmetic,
//   a few times that for the functions of the C library). A correctly rounded result never has the wrong sign, so an
//   end is never moved beyond 0.
// - Functions such as sin have errors of at most 4 units in the last place (2⁻²¹ of the value, which the tests check).
//   Each end is moved outward by 2⁻²⁰ of its value. It is also moved by 2⁻¹²⁵, because these functions may return 0 for
//   a subnormal result.
// - aⁿ is computed by multiplications, with a relative error of less than n · 2⁻²⁴. Each end is moved outward by
//   n · 2⁻²³ of its value and by n · 2⁻¹⁴⁸. A power with the exponent n + 1/2, where n is an integer from 0 to 8, is aⁿ
//   times a square root; its interval is widened like that of sin.
// - Negation, abs, min, max, step, sign and floor are exact, so their intervals are not widened.

#include "fields/formula/operation.hpp"
#include "fields/scalar_function.hpp"

namespace oval4d::fields {

/// Returns the interval of a number in a formula. The interval contains the number, and the float that evaluate() uses
/// for it. For NaN, returns an empty interval (min > max).
ValueBounds intervalOf(double number);

/// Returns the interval of a coordinate between `min` and `max`. The ends are rounded outward to floats, so the
/// interval also contains coordinates that were rounded to floats. If `min` or `max` is NaN, the interval is unbounded,
/// and its `hasValueEverywhere` is false.
ValueBounds intervalOfCoordinate(double min, double max);

/// Returns the interval of the results of an operation, which must be neither `constant` nor `variable`. `a` and `b`
/// are the intervals of the operands; `b` is ignored if the operation has one operand. `exponent` is the exponent of
/// integer_power. ValueBounds::hasValueEverywhere is false if a result of the operation may be NaN.
ValueBounds intervalOf(Operation operation, const ValueBounds& a, const ValueBounds& b, int exponent);

}  // namespace oval4d::fields
