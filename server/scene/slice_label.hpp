#pragma once
// Writes the numbers in the labels of slices.

#include <string>

#include "geometry/hyperplanes.hpp"

namespace oval4d::scene {

/// If the labels have more decimals than this, labelNumber() writes small numbers with an exponent.
inline constexpr int kMaxPlainDecimals = 9;

/// Returns the number of decimals, from 2 to 300, with which labels show the w of the hyperplanes. The least distance
/// between two hyperplanes has at least two significant digits in this number of decimals.
int labelDecimals(const geometry::Hyperplanes& planes);

/// Returns w as text, rounded to `decimals` decimals, with a minus sign (U+2212) if it is negative; "0" if all digits
/// are 0. If `decimals` is greater than kMaxPlainDecimals, a number with an absolute value below 0.0001 has an exponent
/// ("5.0e-11"). No number then has more than 17 significant digits, the precision of a double.
std::string labelNumber(double w, int decimals);

}  // namespace oval4d::scene
