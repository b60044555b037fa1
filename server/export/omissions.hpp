#pragma once
// Warnings about slices that are not in a file.

#include <span>
#include <string>
#include <string_view>

#include "geometry/hyperplanes.hpp"

namespace oval4d::exports {

/// Returns a warning that a file lacks some of the slices in `planes`. `slices` are the indices of these slices, from 0
/// and in ascending order; there must be at least one. The warning states their number, the number of all slices, the
/// reason, and the values of w of the first of them, for example "2 of 5 slices are empty and left out: w = -2, 2".
/// `reason` is the reason without the verb: "empty". `origin`, the w of ObjectInfo::originInFile, is added to each w.
/// The text is ASCII and contains no semicolon.
std::string warningOfOmission(const geometry::Hyperplanes& planes, std::span<const int> slices, std::string_view reason,
                              double origin = 0);

}  // namespace oval4d::exports
