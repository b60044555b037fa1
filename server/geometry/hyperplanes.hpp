#pragma once

namespace oval4d::geometry {

/// The parallel hyperplanes w = n · spacing for n = first … first + count − 1.
struct Hyperplanes {
    int first = -10;
    int count = 21;
    double spacing = 0.1;

    /// The w of hyperplane number i, counted from 0.
    double w(int i) const { return (first + i) * spacing; }
    bool operator==(const geometry::Hyperplanes&) const = default;
};

}  // namespace oval4d::geometry
