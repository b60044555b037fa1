#pragma once
// Warnings about slices that an exported file lacks.

#include <span>
#include <string>
#include <string_view>

#include "geometry/hyperplanes.hpp"

namespace oval4d::exports {

/// Returns a warning that a file lacks some of the slices in `planes`. `slices` are the indices of the missing slices,
/// from 0 and in ascending order; there must be at least one. The warning states how many of the slices are missing,
/// the reason, and the w of the first missing ones, for example "2 of 5 slices are empty and left out: w = −2, 2".
/// `reason` is the reason without the verb: "empty". `origin`, the w of ObjectInfo::originInFile, is added to each w.
/// The text contains no semicolon. Its only character outside of ASCII is the minus sign U+2212.
std::string warningOfOmission(const geometry::Hyperplanes& planes, std::span<const int> slices, std::string_view reason,
                              double origin = 0);

}  // namespace oval4d::exports
