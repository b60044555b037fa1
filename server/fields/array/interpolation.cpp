#include "fields/array/interpolation.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "fields/array/cell.hpp"
#include "fields/array/interpolation_avx2.hpp"

namespace oval4d::fields {

namespace {

constexpr std::size_t kLanes = ScalarFunction::kLanes;

std::array<float, 4> pointAt(const PointBatch& points, std::size_t i) {
    return {points.x[i], points.y[i], points.z[i], points.w[i]};
}

bool isNan(const std::array<float, 4>& point) {
    return std::any_of(point.begin(), point.end(), [](float coordinate) { return std::isnan(coordinate); });
}

void interpolatePortably(const SampledLattice& from, const PointBatch& points, std::span<float> values) {
    const CellRowOffsets offsets = cellRowOffsets(from.lattice);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto point = pointAt(points, i);
        values[i] = isNan(point) ? kNoValue : CellPoint(from, offsets, point).value();
    }
}

void gradientPortably(const SampledLattice& from, const PointBatch& points, const GradientBatch& gradients) {
    const CellRowOffsets offsets = cellRowOffsets(from.lattice);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto point = pointAt(points, i);
        std::array<float, 4> gradient = CellPoint(from, offsets, point).valueAndDerivatives().derivatives;
        for (std::size_t axis = 0; axis < 4; ++axis) gradient[axis] *= from.lattice.axes[axis].scale;
        if (isNan(point) || !std::all_of(gradient.begin(), gradient.end(), isFinite)) gradient = {};
        gradients.x[i] = gradient[0];
        gradients.y[i] = gradient[1];
        gradients.z[i] = gradient[2];
        gradients.w[i] = gradient[3];
    }
}

template <typename Batch>
Batch subBatch(const Batch& batch, std::size_t begin, std::size_t count) {
    return {batch.x.subspan(begin, count), batch.y.subspan(begin, count), batch.z.subspan(begin, count),
            batch.w.subspan(begin, count)};
}

// A batch of fewer than kLanes points, followed by points at the origin up to kLanes points.
class PaddedPointBatch {
  public:
    explicit PaddedPointBatch(const PointBatch& points) {
        std::copy(points.x.begin(), points.x.end(), coordinates_[0].begin());
        std::copy(points.y.begin(), points.y.end(), coordinates_[1].begin());
        std::copy(points.z.begin(), points.z.end(), coordinates_[2].begin());
        std::copy(points.w.begin(), points.w.end(), coordinates_[3].begin());
    }
    PointBatch batch() const { return {coordinates_[0], coordinates_[1], coordinates_[2], coordinates_[3]}; }

  private:
    std::array<std::array<float, kLanes>, 4> coordinates_{};
};

void interpolateWithAvx2(const SampledLattice& from, const PointBatch& points, std::span<float> values,
                         const GradientBatch* gradients) {
    const std::size_t whole = points.size() / kLanes * kLanes, rest = points.size() - whole;
    avx2::interpolate(from, subBatch(points, 0, whole), values, gradients);
    if (rest == 0) return;
    const PaddedPointBatch padded(subBatch(points, whole, rest));
    std::array<float, kLanes> value{}, x{}, y{}, z{}, w{};
    const GradientBatch gradient{x, y, z, w};
    avx2::interpolate(from, padded.batch(), value, gradients != nullptr ? &gradient : nullptr);
    const auto give = [&](const std::array<float, kLanes>& numbers, std::span<float> to) {
        std::copy_n(numbers.begin(), rest, to.begin() + static_cast<std::ptrdiff_t>(whole));
    };
    give(value, values);
    if (gradients == nullptr) return;
    give(x, gradients->x);
    give(y, gradients->y);
    give(z, gradients->z);
    give(w, gradients->w);
}

}  // namespace

InstructionSet fastestInstructionSet() {
    static const auto fastest = avx2::isSupported() ? InstructionSet::avx2 : InstructionSet::portable;
    return fastest;
}

void interpolate(const SampledLattice& from, const PointBatch& points, std::span<float> values,
                 InstructionSet instructions) {
    assert(values.size() >= points.size());
    if (instructions == InstructionSet::avx2 && from.lattice.shape[0] > 1)
        interpolateWithAvx2(from, points, values, nullptr);
    else
        interpolatePortably(from, points, values);
}

void interpolateWithGradient(const SampledLattice& from, const PointBatch& points, std::span<float> values,
                             const GradientBatch& gradients, InstructionSet instructions) {
    assert(values.size() >= points.size() && gradients.x.size() >= points.size());
    if (instructions == InstructionSet::avx2 && from.lattice.shape[0] > 1) {
        interpolateWithAvx2(from, points, values, &gradients);
    } else {
        interpolatePortably(from, points, values);
        gradientPortably(from, points, gradients);
    }
}

}  // namespace oval4d::fields
