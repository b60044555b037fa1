#pragma once
// The numbers in the labels of slices.

#include <string>

#include "geometry/hyperplanes.hpp"

namespace oval4d::scene {

/// Returns the number of decimals, from 2 to 9, at which the values of w of neighboring hyperplanes differ.
int labelDecimals(const geometry::Hyperplanes& planes);

/// Returns w, rounded to this number of decimals, with a minus sign (U+2212) if it is negative; "0" if all digits are
/// 0.
std::string labelNumber(double w, int decimals);

}  // namespace oval4d::scene
