#include "slicing/closed_surfaces/field_lattice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "fields/array/array_function.hpp"

namespace oval4d::slicing {

namespace {

// Calls `visit` with each lattice point from `first` to `last`, both included, in the order in which x varies fastest.
template <typename Visit>
void forEachPoint(glm::ivec4 first, glm::ivec4 last, Visit visit) {
    glm::ivec4 p;
    for (p.w = first.w; p.w <= last.w; ++p.w) {
        for (p.z = first.z; p.z <= last.z; ++p.z) {
            for (p.y = first.y; p.y <= last.y; ++p.y) {
                for (p.x = first.x; p.x <= last.x; ++p.x) visit(p);
            }
        }
    }
}

float sampleOf(const fields::ArrayFunction& array, glm::ivec4 point) {
    const auto [nx, ny, nz, nw] = array.shape();
    const auto at = [](int i, std::size_t count) { return std::min(static_cast<std::size_t>(i), count - 1); };
    return array.samples()[at(point.x, nx) + nx * (at(point.y, ny) + ny * (at(point.z, nz) + nz * at(point.w, nw)))];
}

}  // namespace

FieldLattice::FieldLattice(const fields::Field& field, const geometry::Rotation& orientation, int cells)
    : field_(field) {
    const glm::dmat4 toSlice = orientation.matrix() * glm::inverse(field.toFunction);
    const glm::dvec4 size = field.box.max - field.box.min;
    std::array<double, 4> lengths{};  // per axis: the length of the domain's side, in the units of the object
    for (std::size_t axis = 0; axis < 4; ++axis) {
        const auto a = static_cast<int>(axis);
        lengths[axis] = size[a] * glm::length(toSlice[a]);
    }
    const double longest = *std::ranges::max_element(lengths);
    for (std::size_t axis = 0; axis < 4; ++axis) {
        const auto a = static_cast<int>(axis);
        pointCounts_[a] = field.array != nullptr
                              ? std::max(2, static_cast<int>(field.array->shape()[axis]))
                              : std::max(kMinCells, static_cast<int>(std::lround(cells * lengths[axis] / longest))) + 1;
        for (int i = 0; i < pointCounts_[a]; ++i) {
            const double t = static_cast<double>(i) / (pointCounts_[a] - 1);
            coordinates_[axis].push_back(glm::mix(field.box.min[a], field.box.max[a], t));
        }
        sides_[axis] = size[a] * toSlice[a];
    }
    // The gradient g satisfies dot(g, s) = rise for each step s from a lattice point to the next along an axis, where
    // `rise` is the difference of the function's values at the two points.
    glm::dmat4 steps(1);
    for (std::size_t axis = 0; axis < 4; ++axis) {
        const auto a = static_cast<int>(axis);
        steps[a] = sides_[axis] / static_cast<double>(pointCounts_[a] - 1);
    }
    fromRises_ = glm::inverse(glm::transpose(steps));
    positive_ = glm::determinant(toSlice) > 0;
    // Positions are relative to field.center, the origin of the object.
    shift_ = toSlice * (field.box.center() - field.center);
}

fields::ValueBounds FieldLattice::valueBounds(glm::ivec4 first, glm::ivec4 last) const {
    constexpr double kMargin = 1e-3;  // in lattice cells; allows for rounding of the positions of samples
    fields::Box region;
    for (std::size_t axis = 0; axis < 4; ++axis) {
        const auto a = static_cast<int>(axis);
        const std::vector<double>& all = coordinates_[axis];
        const double margin = kMargin * (all[1] - all[0]);
        region.min[a] = all[static_cast<std::size_t>(first[a])] - margin;
        region.max[a] = all[static_cast<std::size_t>(last[a])] + margin;
    }
    return field_.function->boundsIn(region);
}

void FieldLattice::sample(glm::ivec4 first, glm::ivec4 last, std::span<float> values) const {
    std::size_t count = 0;
    if (field_.array != nullptr) {
        forEachPoint(first, last, [&](glm::ivec4 p) { values[count++] = sampleOf(*field_.array, p); });
        return;
    }
    constexpr std::size_t kBatch = 1024;
    std::array<std::array<float, kBatch>, 4> at{};
    std::size_t done = 0;
    const auto evaluate = [&] {
        const auto part = [&](std::size_t axis) { return std::span<const float>(at[axis]).first(count); };
        const std::span<float> evaluated = values.subspan(done, count);
        field_.function->evaluate({part(0), part(1), part(2), part(3)}, evaluated);
        for (float& value : evaluated) {
            if (std::isinf(value)) value = std::copysign(std::numeric_limits<float>::max(), value);
        }
        done += count;
        count = 0;
    };
    forEachPoint(first, last, [&](glm::ivec4 p) {
        for (std::size_t axis = 0; axis < 4; ++axis) {
            const int i = p[static_cast<int>(axis)];
            at[axis][count] = static_cast<float>(coordinates_[axis][static_cast<std::size_t>(i)]);
        }
        if (++count == kBatch) evaluate();
    });
    if (count > 0) evaluate();
}

float FieldLattice::sample(glm::ivec4 point) const {
    float value = 0;
    sample(point, point, std::span(&value, 1));
    return value;
}

}  // namespace oval4d::slicing
