#pragma once

#include <cstddef>
#include <vector>

namespace oval4d::geometry {

/// The least and the greatest value of Hyperplanes::spacing that a user may choose, in circumradii of the object.
inline constexpr double kMinSpacing = 1e-6, kMaxSpacing = 10;
/// The greatest absolute value of Hyperplanes::offset that a user may choose, in circumradii of the object.
inline constexpr double kMaxOffset = 10;

/// A list of parallel hyperplanes of 4-D space. For the integers n = first … first + count − 1, hyperplane n has
/// the equation w = offset + n · spacing or, if `listed` is not empty, w = listed[n − first].
struct Hyperplanes {
    int first = -10;
    int count = 21;
    double spacing = 0.1;  ///< the distance of neighboring hyperplanes, greater than 0, in the units of the object
    double offset = 0;     ///< w of the hyperplane n = 0, in the units of the object
    /// The w coordinates of the `count` hyperplanes, in any order and in the units of the object; empty if the
    /// hyperplanes are evenly spaced. If `listed` is not empty, `offset` is not used, and `spacing` is used only as the
    /// thickness of the slices of a point cloud.
    std::vector<double> listed = {};

    /// Returns the w coordinate of the hyperplane with the index i (0 … count − 1), for which n = first + i.
    double w(int i) const {
        return listed.empty() ? offset + (first + i) * spacing : listed[static_cast<std::size_t>(i)];
    }
    bool operator==(const geometry::Hyperplanes&) const = default;
};

}  // namespace oval4d::geometry
