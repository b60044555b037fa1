#pragma once
// Warnings about slices that are missing in an exported file.

#include <span>
#include <string>
#include <string_view>

#include "geometry/hyperplanes.hpp"

namespace oval4d::exports {

/// Returns a warning that a file lacks some slices, for example "2 of 5 slices are empty and left out: w = −2, 2". The
/// warning states the number of missing slices, the reason, and the w of the first twelve of them. `slices` are the
/// indices of the missing slices in `planes`, from 0, in ascending order; there must be at least one. `reason` follows
/// the word "are", for example "empty". `origin` is the w of ObjectInfo::originInFile, and is added to each w. The text
/// contains no semicolon. Its only character outside of ASCII is the minus sign U+2212.
std::string omittedSlicesWarning(const geometry::Hyperplanes& planes, std::span<const int> slices,
                                 std::string_view reason, double origin = 0);

}  // namespace oval4d::exports
