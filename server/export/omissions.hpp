#pragma once
// Warnings about slices that are not in a file.

#include <span>
#include <string>
#include <string_view>

#include "geometry/hyperplanes.hpp"

namespace oval4d::exports {

/// Returns a warning that a file lacks the slices in these hyperplanes, which are given by their indices, in ascending
/// order; there must be at least one. It says how many of how many slices they are, the reason, and the values of
/// w of the first ones, for example "2 of 5 slices are empty and left out: w = -2, 2". `reason` is the reason without
/// the verb: "empty". `origin` is added to each w: ObjectInfo::originInFile. The text is ASCII and contains no
/// semicolon.
std::string warningOfOmission(const geometry::Hyperplanes& planes, std::span<const int> slices, std::string_view reason,
                              double origin = 0);

}  // namespace oval4d::exports
