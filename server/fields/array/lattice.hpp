#pragma once
// The positions of the samples of an array on a regular 4-D lattice.

#include <array>
#include <cstddef>

#include "fields/array/shape.hpp"
#include "fields/scalar_function.hpp"

namespace oval4d::fields {

/// One axis of a lattice. Maps a coordinate to a position: the first sample has the position 0, the second 1, and so
/// on.
struct LatticeAxis {
    float origin = 0;        ///< the first sample's coordinate, rounded to a float
    float scale = 0;         ///< the number of positions per unit of length; 0 for an axis with one sample
    float shift = 0;         ///< corrects the position for the rounding of `origin`
    float last = 0;          ///< the last sample's position
    float lastCell = 0;      ///< the position of the last cell's first sample; 0 for an axis with one sample
    std::size_t stride = 0;  ///< the distance of neighbors in memory, in samples; 0 for an axis with one sample

    /// Returns the position of a coordinate, clamped to 0 … last; 0 for NaN. The function is monotonic even with
    /// rounding: the positions of all coordinates in an interval lie between the positions of its ends.
    float continuousIndex(float coordinate) const {
        float position = (coordinate - origin) * scale + shift;
        position = position > 0 ? position : 0;
        return position < last ? position : last;
    }
};

/// A regular 4-D lattice, with the first sample at the min of the box and the last sample at the max. In memory, the
/// sample with the indices i, j, k, l along x, y, z, w is at i + nx · (j + ny · (k + nz · l)), where nx, ny, nz are the
/// first three sizes in `shape`.
struct Lattice {
    Shape shape{1, 1, 1, 1};
    Box box;
    std::array<LatticeAxis, 4> axes;

    /// Throws std::invalid_argument if sampleCount(shape) is 0, if a coordinate of the box is not within ±1e30, or if
    /// min exceeds max. Along an axis with several samples, also throws if min and max are equal or too close together
    /// for 32-bit floats.
    Lattice(const Shape& shape, const Box& box);
};

}  // namespace oval4d::fields
