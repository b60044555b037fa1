#include "polytopes/import/rounding_estimator.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <glm/common.hpp>

namespace oval4d::polytopes {

namespace {

constexpr int kSingleBits = 24;              // the number of significant bits of a single-precision number
constexpr int kMinSingleExponent = -149;     // the least positive single-precision number is 2^−149
constexpr double kSingleRounding = 0x1p-24;  // the maximum relative rounding error of a single-precision number
// The least singleEvidence_ at which the coordinates count as single-precision numbers. Coordinates that are not
// single-precision numbers reach this value with a probability of at most 2^(−kSingleEvidence).
constexpr double kSingleEvidence = 10;
constexpr double kMaxExactUnits = 400;  // coordinates count as exact if half the diagonal of their bounding box is at
                                        // most this many units of the last digit

constexpr int kMaxExponent = 10'000;  // the largest absolute value of an exponent; larger exponents are clamped to it

// The precision with which a number is written in a text.
struct NumberPrecision {
    int significant = 0;  // the number of digits from the first nonzero digit to the last digit written
    int last = 0;         // the exponent of ten of the last digit written
    int lastNonzero = 0;  // the exponent of ten of the last digit other than 0
    bool whole = true;
};

NumberPrecision numberPrecisionOf(std::string_view word) {
    NumberPrecision result;
    bool decimals = false;
    int zeros = 0;  // the number of zeros at the end
    const std::size_t end = std::min(word.find_first_of("eE"), word.size());
    for (const char c : word.substr(0, end)) {
        if (c == '.') decimals = true;
        if (c < '0' || c > '9') continue;
        if (result.significant > 0 || c != '0') ++result.significant;
        zeros = c == '0' ? zeros + 1 : 0;
        if (decimals) --result.last;
    }
    result.whole = !decimals && end == word.size();
    if (end < word.size()) {
        word.remove_prefix(end + 1);
        if (word.starts_with('+')) word.remove_prefix(1);
        int exponent = 0;
        std::from_chars(word.data(), word.data() + word.size(), exponent);
        result.last += std::clamp(exponent, -kMaxExponent, kMaxExponent);
    }
    result.lastNonzero = result.last + zeros;
    return result;
}

// Returns the distance between neighboring single-precision numbers near `value`.
double float32SpacingAt(double value) {
    return std::ldexp(1.0, std::max(std::ilogb(value) + 1 - kSingleBits, kMinSingleExponent));
}

}  // namespace

void RoundingEstimator::add(std::string_view word, int axis, double value) {
    const NumberPrecision digits = numberPrecisionOf(word);
    largest_[axis] = std::max(largest_[axis], std::abs(value));
    whole_ = whole_ && digits.whole;
    if (digits.significant == 0) return;  // the digits of 0 do not show how it was rounded
    digits_ = std::max(digits_, digits.significant);
    lastPlace_ = std::min(lastPlace_, digits.last);
    if (single_ && value != 0) updateFloat32Evidence(digits.last, digits.lastNonzero, axis, value);
}

void RoundingEstimator::updateFloat32Evidence(int lastPlace, int lastNonzeroPlace, int axis, double value) {
    const double away = std::abs(static_cast<double>(static_cast<float>(value)) - value);
    single_ = away <= std::pow(10.0, lastPlace) / 2 + std::numeric_limits<double>::epsilon() * std::abs(value);
    fromSingle_[axis] = std::max(fromSingle_[axis], away);
    // `part` is the probability that a random decimal with the same last place is a rounded single-precision number:
    // the distance of neighboring decimals, divided by the distance of neighboring single-precision numbers. The last
    // place is that of the last digit other than 0. A number such as 0.50000000 is also a short decimal, so it is weak
    // evidence.
    const double part = std::pow(10.0, lastNonzeroPlace) / float32SpacingAt(value);
    if (part < 1) singleEvidence_ -= std::log2(part);
}

glm::dvec4 RoundingEstimator::lastDigitUnit() const {
    if (digits_ == 0) return glm::dvec4(0);
    glm::dvec4 unit(0);
    for (int axis = 0; axis < 4; ++axis) {
        double place = lastPlace_;
        if (largest_[axis] > 0) place = std::max(place, std::floor(std::log10(largest_[axis])) + 1 - digits_);
        unit[axis] = std::pow(10.0, place);
    }
    return unit;
}

glm::dvec4 RoundingEstimator::roundingErrorIfRounded() const {
    // Programs may write the single-precision number 0.100000001490116 as 0.1, the shortest decimal that is read back
    // as the same number. The error of this decimal is 1.5e-9, more than half a unit of the last digit of a longer
    // coordinate such as 0.102687284. Therefore fromSingle_, the largest such error, is a lower bound of the result.
    if (single_ && !whole_ && singleEvidence_ >= kSingleEvidence)
        return largest_ * kSingleRounding + glm::max(lastDigitUnit() / 2.0, fromSingle_);
    return lastDigitUnit() / 2.0;
}

glm::dvec4 RoundingEstimator::maxRoundingError(double size) const {
    const glm::dvec4 last = lastDigitUnit();
    const bool exact = size <= kMaxExactUnits * std::min({last.x, last.y, last.z, last.w});
    return exact ? glm::dvec4(0) : roundingErrorIfRounded();
}

}  // namespace oval4d::polytopes
