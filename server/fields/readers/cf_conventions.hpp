#pragma once
// The axes of the dimensions of an array, by the CF conventions (cfconventions.org, version 1.10, chapter 4).

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace oval4d::fields {

/// What a file states about a dimension: its name, and the attributes of its coordinate variable. A text is empty if
/// the file does not state it.
struct CfDimension {
    std::string name, axis, standardName, units, positive;
};

/// Returns the axis of a dimension, 0 … 3 for x, y, z, t. Returns an empty optional if `dimension` does not determine
/// the axis.
std::optional<std::size_t> cfAxis(const CfDimension& dimension);

/// Returns the axes of a variable's dimensions: at most 4, ordered from the slowest to the fastest. First, each
/// dimension gets the axis that the file states for it, unless an earlier dimension has this axis. Then each dimension
/// without an axis, from the fastest to the slowest, gets the first of x, y, z, t that no dimension has.
std::vector<std::size_t> axisOfEachDimension(std::span<const CfDimension> dimensions);

/// The first and the last of the coordinates along a dimension.
struct FirstAndLastCoordinate {
    double first, last;
};

/// Returns the first and the last of the coordinates `at` along the dimension `name`. `at` must not be empty. If the
/// coordinates are not strictly monotonic, adds a warning and returns an empty optional. If the coordinates are not
/// evenly spaced, adds a warning.
std::optional<FirstAndLastCoordinate> endsOfCoordinates(std::span<const double> at, const std::string& name,
                                                        std::vector<std::string>& warnings);

/// Shifts coordinates that are too close together for their distance from 0, such as hours since 1900: 32-bit floats,
/// with which functions are evaluated, hardly distinguish places between neighboring coordinates. `count` is the number
/// of coordinates from ends.first to ends.last. They are too close if their mean distance is less than 2·10⁻⁵ times the
/// greater absolute value of the two ends. In this case, subtracts the least coordinate from both ends, adds a warning
/// with this coordinate, and removes " since …" from `unit`. `name` is the name of the dimension.
void subtractLeastCoordinateIfFar(FirstAndLastCoordinate& ends, std::size_t count, const std::string& name,
                                  std::string& unit, std::vector<std::string>& warnings);

}  // namespace oval4d::fields
