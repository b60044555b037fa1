#include "polytopes/import/written_precision.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <glm/common.hpp>

namespace oval4d::polytopes {

namespace {

// Nine significant digits tell any two single-precision numbers apart (IEEE 754, 5.12.2).
constexpr int kSingleDigits = 9;
constexpr double kSingleRounding = 0x1p-24;  // the maximum rounding error of single precision, relative to the number
constexpr double kMaxExactUnits = 400;  // coordinates are exact if their size is at most this many last-digit units

// The precision of a single number.
struct Digits {
    int significant = 0;  // the number of digits from the first nonzero digit to the last digit written
    int last = 0;         // the exponent of ten of the last digit written
    bool whole = true;
};

Digits digitsOf(std::string_view word) {
    Digits result;
    bool decimals = false;
    const std::size_t end = std::min(word.find_first_of("eE"), word.size());
    for (const char c : word.substr(0, end)) {
        if (c == '.') decimals = true;
        if (c < '0' || c > '9') continue;
        if (result.significant > 0 || c != '0') ++result.significant;
        if (decimals) --result.last;
    }
    result.whole = !decimals && end == word.size();
    if (end < word.size()) {
        word.remove_prefix(end + 1);
        if (word.starts_with('+')) word.remove_prefix(1);
        int exponent = 0;
        std::from_chars(word.data(), word.data() + word.size(), exponent);
        result.last += exponent;
    }
    return result;
}

// Returns whether the number is a single-precision number that was written with these digits.
bool isSingle(const Digits& digits, double value) {
    const double nearest = static_cast<float>(value);
    if (digits.significant <= kSingleDigits) return nearest == value;
    const double error = 0.5 * std::pow(10.0, digits.last) + std::numeric_limits<double>::epsilon() * std::abs(value);
    return std::abs(nearest - value) <= error;
}

}  // namespace

void WrittenPrecision::add(std::string_view word, int axis, double value) {
    const Digits digits = digitsOf(word);
    largest_[axis] = std::max(largest_[axis], std::abs(value));
    whole_ = whole_ && digits.whole;
    if (digits.significant == 0) return;  // a zero does not show how it was rounded
    single_ = single_ && isSingle(digits, value);
    digits_ = std::max(digits_, digits.significant);
    lastPlace_ = std::min(lastPlace_, digits.last);
}

glm::dvec4 WrittenPrecision::maxRoundingError(double size) const {
    if (digits_ == 0) return glm::dvec4(0);
    if (single_ && digits_ > kSingleDigits) return largest_ * kSingleRounding;
    glm::dvec4 unit(0);
    double least = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 4; ++axis) {
        double place = lastPlace_;
        if (largest_[axis] > 0) place = std::max(place, std::floor(std::log10(largest_[axis])) + 1 - digits_);
        unit[axis] = std::pow(10.0, place);
        least = std::min(least, unit[axis]);
    }
    return size <= kMaxExactUnits * least ? glm::dvec4(0) : unit / 2.0;
}

}  // namespace oval4d::polytopes
