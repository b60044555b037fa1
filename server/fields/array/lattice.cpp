#include "fields/array/lattice.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace oval4d::fields {

namespace {

constexpr double kMaxCoordinate = 1e30;

LatticeAxis latticeAxisOf(std::size_t samples, std::size_t stride, double min, double max) {
    if (!(std::abs(min) <= kMaxCoordinate && std::abs(max) <= kMaxCoordinate && min <= max))
        throw std::invalid_argument("the box must have finite coordinates within ±1e30, and min must not exceed max");
    LatticeAxis axis;
    axis.origin = static_cast<float>(min);
    if (samples == 1) return axis;
    const double scale = static_cast<double>(samples - 1) / (max - min);
    axis.scale = static_cast<float>(scale);
    axis.shift = static_cast<float>((static_cast<double>(axis.origin) - min) * scale);
    axis.last = static_cast<float>(samples - 1);
    axis.lastCell = static_cast<float>(samples - 2);
    axis.stride = stride;
    if (!std::isnormal(axis.scale) || static_cast<float>(max) <= axis.origin)
        throw std::invalid_argument("the box is too thin for an axis of " + std::to_string(samples) + " samples");
    return axis;
}

}  // namespace

Lattice::Lattice(const Shape& latticeShape, const Box& latticeBox) : shape(latticeShape), box(latticeBox) {
    if (sampleCount(shape) == 0)
        throw std::invalid_argument(
            "an array must have from 1 to 2^24 samples along each axis, and at most 2^44 in all");
    std::size_t stride = 1;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const auto axis = static_cast<glm::length_t>(i);
        axes.at(i) = latticeAxisOf(shape.at(i), stride, box.min[axis], box.max[axis]);
        stride *= shape.at(i);
    }
}

}  // namespace oval4d::fields
