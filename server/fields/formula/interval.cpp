#include "fields/formula/interval.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <utility>

namespace oval4d::fields {

namespace {

using std::numbers::pi;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMaxFloat = std::numeric_limits<float>::max();

// A bound of the rounding error of an operation: |result| · relative + absolute. The second summand is for subnormal
// results.
struct RoundingError {
    double relative, absolute;
};
constexpr RoundingError kCorrectlyRounded{0x1p-23, 0x1p-148}, kFunction{0x1p-20, 0x1p-125};

constexpr ValueBounds kEmpty{.min = kInfinity, .max = -kInfinity, .hasValueEverywhere = false};

bool isEmpty(const ValueBounds& a) { return a.min > a.max; }
bool contains(const ValueBounds& a, double value) { return a.min <= value && value <= a.max; }
bool mayBeInfinite(const ValueBounds& a) { return a.min == -kInfinity || a.max == kInfinity; }

// Returns an upper bound of the floats that are computed for real results up to `max`.
double roundedUpperBound(double max, RoundingError error) {
    if (max == 0 || std::isinf(max)) return max;
    const double wider = max + std::abs(max) * error.relative + error.absolute;
    if (wider > kMaxFloat) return kInfinity;
    return max < 0 ? std::min(wider, 0.0) : wider;
}

// Returns an interval of the floats that are computed for real results in [min, max]. A NaN end becomes infinite.
ValueBounds withRoundingError(double min, double max, bool hasValueEverywhere, RoundingError error) {
    return {std::isnan(min) ? -kInfinity : -roundedUpperBound(-min, error),
            std::isnan(max) ? kInfinity : roundedUpperBound(max, error), hasValueEverywhere};
}

// Returns the interval from the smallest to the largest of the candidates, widened by `error`. If a candidate is NaN,
// the interval is unbounded.
ValueBounds boundsOfCandidates(std::initializer_list<double> candidates, bool hasValueEverywhere, RoundingError error) {
    double min = kInfinity, max = -kInfinity;
    for (const double candidate : candidates) {
        if (std::isnan(candidate)) return {-kInfinity, kInfinity, hasValueEverywhere};
        min = std::min(min, candidate);
        max = std::max(max, candidate);
    }
    return withRoundingError(min, max, hasValueEverywhere, error);
}

// Returns the interval of f on `a`, for a monotonic function f.
template <typename F>
ValueBounds applyMonotonic(F f, const ValueBounds& a, RoundingError error = kFunction) {
    return boundsOfCandidates({f(a.min), f(a.max)}, a.hasValueEverywhere, error);
}

ValueBounds add(const ValueBounds& a, const ValueBounds& b) {
    const bool mayCancel = (a.max == kInfinity && b.min == -kInfinity) || (a.min == -kInfinity && b.max == kInfinity);
    return withRoundingError(a.min + b.min, a.max + b.max, a.hasValueEverywhere && b.hasValueEverywhere && !mayCancel,
                             kCorrectlyRounded);
}

ValueBounds negate(const ValueBounds& a) { return {-a.max, -a.min, a.hasValueEverywhere}; }

ValueBounds multiply(const ValueBounds& a, const ValueBounds& b) {
    const bool hasValueEverywhere = a.hasValueEverywhere && b.hasValueEverywhere &&
                                    !(contains(a, 0) && mayBeInfinite(b)) && !(contains(b, 0) && mayBeInfinite(a));
    // An infinite end stands for large finite numbers, whose products with 0 are 0. The product 0 · ∞ is NaN, for which
    // `hasValueEverywhere` is false.
    const auto product = [](double x, double y) { return x == 0 || y == 0 ? 0 : x * y; };
    return boundsOfCandidates(
        {product(a.min, b.min), product(a.min, b.max), product(a.max, b.min), product(a.max, b.max)},
        hasValueEverywhere, kCorrectlyRounded);
}

ValueBounds divide(const ValueBounds& a, const ValueBounds& b) {
    const bool hasValueEverywhere = a.hasValueEverywhere && b.hasValueEverywhere &&
                                    !(contains(a, 0) && contains(b, 0)) && !(mayBeInfinite(a) && mayBeInfinite(b));
    if (contains(b, 0)) return {-kInfinity, kInfinity, hasValueEverywhere};
    return boundsOfCandidates({a.min / b.min, a.min / b.max, a.max / b.min, a.max / b.max}, hasValueEverywhere,
                              kCorrectlyRounded);
}

ValueBounds abs(const ValueBounds& a) {
    const double min = contains(a, 0) ? 0 : std::min(std::abs(a.min), std::abs(a.max));
    return {min, std::max(std::abs(a.min), std::abs(a.max)), a.hasValueEverywhere};
}

ValueBounds square(const ValueBounds& a) {
    const ValueBounds size = abs(a);
    return withRoundingError(size.min * size.min, size.max * size.max, a.hasValueEverywhere, kCorrectlyRounded);
}

ValueBounds integerPower(const ValueBounds& a, int exponent) {
    const int n = std::abs(exponent);
    const ValueBounds base = n % 2 == 0 ? abs(a) : a;
    const ValueBounds power = withRoundingError(std::pow(base.min, n), std::pow(base.max, n), a.hasValueEverywhere,
                                                {n * kCorrectlyRounded.relative, n * 0x1p-148});
    return exponent > 0 ? power : divide({1, 1, true}, power);
}

ValueBounds sqrt(const ValueBounds& a) {
    if (a.max < 0) return kEmpty;
    return withRoundingError(std::sqrt(std::max(a.min, 0.0)), std::sqrt(a.max), a.hasValueEverywhere && a.min >= 0,
                             kCorrectlyRounded);
}

ValueBounds log(const ValueBounds& a) {
    if (a.max < 0) return kEmpty;
    return withRoundingError(std::log(std::max(a.min, 0.0)), std::log(a.max), a.hasValueEverywhere && a.min >= 0,
                             kFunction);
}

// Returns whether `a`, widened by possible rounding errors, contains phase + k · period for an integer k.
bool containsPhase(const ValueBounds& a, double phase, double period) {
    const double slack = 1e-9 * std::max({1.0, std::abs(a.min), std::abs(a.max)});
    return std::floor((a.max + slack - phase) / period) >= std::ceil((a.min - slack - phase) / period);
}

// Returns the interval of `f` on `a`. `f` must be sin or cos, and `top` a point where `f` is 1.
template <typename F>
ValueBounds sineOrCosine(F f, double top, const ValueBounds& a) {
    constexpr double kLarge = 1e6;  // beyond ±kLarge, containsPhase() is too imprecise
    const bool hasValueEverywhere = a.hasValueEverywhere && !mayBeInfinite(a);
    if (a.min < -kLarge || a.max > kLarge) return withRoundingError(-1, 1, hasValueEverywhere, kFunction);
    const double first = f(a.min), last = f(a.max);
    const bool hasMin = containsPhase(a, top + pi, 2 * pi), hasMax = containsPhase(a, top, 2 * pi);
    return withRoundingError(hasMin ? -1 : std::min(first, last), hasMax ? 1 : std::max(first, last),
                             hasValueEverywhere, kFunction);
}

ValueBounds tangent(const ValueBounds& a) {
    const bool hasValueEverywhere = a.hasValueEverywhere && !mayBeInfinite(a);
    if (mayBeInfinite(a) || a.max - a.min >= pi || containsPhase(a, pi / 2, pi))
        return {-kInfinity, kInfinity, hasValueEverywhere};
    return withRoundingError(std::tan(a.min), std::tan(a.max), hasValueEverywhere, kFunction);
}

// Returns the interval of `f`, which must be asin or acos, on `a`.
template <typename F>
ValueBounds arcsineOrArccosine(F f, const ValueBounds& a) {
    if (a.max < -1 || a.min > 1) return kEmpty;
    const bool hasValueEverywhere = a.hasValueEverywhere && a.min >= -1 && a.max <= 1;
    return boundsOfCandidates({f(std::max(a.min, -1.0)), f(std::min(a.max, 1.0))}, hasValueEverywhere, kFunction);
}

ValueBounds hyperbolicCosine(const ValueBounds& a) {
    const ValueBounds size = abs(a);
    return withRoundingError(std::cosh(size.min), std::cosh(size.max), a.hasValueEverywhere, kFunction);
}

// Returns the interval of a^b; `a` must not contain negative numbers. On the rectangle of all pairs (a, b), a^b has no
// extrema inside and is monotonic along each side, so the extrema are at the corners.
ValueBounds powerOfPositive(const ValueBounds& a, const ValueBounds& b) {
    const bool hasValueEverywhere = a.hasValueEverywhere && b.hasValueEverywhere;
    // A zero in `a` may be −0. A power of −0 with an odd negative exponent is −∞, not ∞.
    if (a.min == 0 && b.min < 0) return {-kInfinity, kInfinity, hasValueEverywhere};
    return boundsOfCandidates(
        {std::pow(a.min, b.min), std::pow(a.min, b.max), std::pow(a.max, b.min), std::pow(a.max, b.max)},
        hasValueEverywhere, kFunction);
}

ValueBounds power(const ValueBounds& a, const ValueBounds& b) {
    if (a.min >= 0) return powerOfPositive(a, b);
    const bool mayBeInteger = std::floor(b.max) >= b.min;
    if (!mayBeInteger) {
        // `b` contains no integers. For such an exponent b, pow is NaN for finite negative bases, and pow(−∞, b) is
        // pow(∞, b).
        if (a.max < 0 && a.min > -kInfinity) return kEmpty;
        const ValueBounds positive{0, a.min == -kInfinity ? kInfinity : a.max, false};
        return powerOfPositive(positive, b);
    }
    const double largest = powerOfPositive(abs(a), b).max;
    const bool isInteger = b.min == b.max;
    return {isInteger && std::fmod(b.min, 2) == 0 ? 0 : -largest, largest,
            a.hasValueEverywhere && b.hasValueEverywhere && isInteger};
}

ValueBounds arctangent2(const ValueBounds& y, const ValueBounds& x) {
    const bool hasValueEverywhere = y.hasValueEverywhere && x.hasValueEverywhere;
    const bool containsCut = contains(y, 0) && x.min <= 0;
    if (containsCut) return withRoundingError(-pi, pi, hasValueEverywhere, kFunction);
    return boundsOfCandidates(
        {std::atan2(y.min, x.min), std::atan2(y.min, x.max), std::atan2(y.max, x.min), std::atan2(y.max, x.max)},
        hasValueEverywhere, kFunction);
}

// Returns the interval of a − b⌊q⌋, where q is the computed quotient: a/b times a factor from 1 − 2⁻²⁴ to 1 + 2⁻²⁴. The
// computed value lies between 0 and b, or outside by a few rounding errors of numbers up to |a| + |b|.
ValueBounds modulo(const ValueBounds& a, const ValueBounds& b) {
    const ValueBounds quotient = divide(a, b);
    if (mayBeInfinite(quotient) || mayBeInfinite(a) || mayBeInfinite(b)) return {-kInfinity, kInfinity, false};
    const double slack = 0x1p-22 * (abs(a).max + abs(b).max) + kFunction.absolute;
    ValueBounds result{std::min(b.min, 0.0) - slack, std::max(b.max, 0.0) + slack,
                       a.hasValueEverywhere && b.hasValueEverywhere};
    if (std::floor(quotient.min) == std::floor(quotient.max)) {
        const ValueBounds whole{std::floor(quotient.min), std::floor(quotient.min), true};
        const ValueBounds exact = add(a, negate(multiply(b, whole)));
        result.min = std::max(result.min, exact.min);
        result.max = std::min(result.max, exact.max);
    }
    return result;
}

}  // namespace

ValueBounds intervalOf(double number) {
    if (std::isnan(number)) return kEmpty;
    const double rounding = static_cast<float>(number);
    return {std::min(number, rounding), std::max(number, rounding), true};
}

ValueBounds intervalOfCoordinate(double min, double max) {
    if (std::isnan(min) || std::isnan(max)) return {-kInfinity, kInfinity, false};
    return {std::min<double>(min, static_cast<float>(min)), std::max<double>(max, static_cast<float>(max)), true};
}

ValueBounds intervalOf(Operation operation, const ValueBounds& a, const ValueBounds& b, int exponent) {
    if (isEmpty(a) || (isBinary(operation) && isEmpty(b))) return kEmpty;
    switch (operation) {
        case Operation::constant:
        case Operation::variable:
        case Operation::copy:
            return a;
        case Operation::negate:
            return negate(a);
        case Operation::abs:
            return abs(a);
        case Operation::square:
            return square(a);
        case Operation::integer_power:
            return integerPower(a, exponent);
        case Operation::sqrt:
            return sqrt(a);
        case Operation::cbrt:
            return applyMonotonic([](double x) { return std::cbrt(x); }, a);
        case Operation::exp:
            return applyMonotonic([](double x) { return std::exp(x); }, a);
        case Operation::log:
            return log(a);
        case Operation::sin:
            return sineOrCosine([](double x) { return std::sin(x); }, pi / 2, a);
        case Operation::cos:
            return sineOrCosine([](double x) { return std::cos(x); }, 0, a);
        case Operation::tan:
            return tangent(a);
        case Operation::asin:
            return arcsineOrArccosine([](double x) { return std::asin(x); }, a);
        case Operation::acos:
            return arcsineOrArccosine([](double x) { return std::acos(x); }, a);
        case Operation::atan:
            return applyMonotonic([](double x) { return std::atan(x); }, a);
        case Operation::sinh:
            return applyMonotonic([](double x) { return std::sinh(x); }, a);
        case Operation::cosh:
            return hyperbolicCosine(a);
        case Operation::tanh:
            return applyMonotonic([](double x) { return std::tanh(x); }, a);
        case Operation::step:
        case Operation::sign:
        case Operation::floor:
            return {applyOperation(operation, a.min, 0), applyOperation(operation, a.max, 0), a.hasValueEverywhere};
        case Operation::add:
            return add(a, b);
        case Operation::subtract:
            return add(a, negate(b));
        case Operation::multiply:
            return multiply(a, b);
        case Operation::divide:
            return divide(a, b);
        case Operation::min:
            return {std::min(a.min, b.min), std::min(a.max, b.max), a.hasValueEverywhere && b.hasValueEverywhere};
        case Operation::max:
            return {std::max(a.min, b.min), std::max(a.max, b.max), a.hasValueEverywhere && b.hasValueEverywhere};
        case Operation::power:
            return power(a, b);
        case Operation::atan2:
            return arctangent2(a, b);
        case Operation::mod:
            return modulo(a, b);
    }
    return {-kInfinity, kInfinity, false};
}

}  // namespace oval4d::fields
