#include "fields/array/array_function.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "fields/array/downsampling.hpp"
#include "fields/array/interpolation.hpp"

namespace oval4d::fields {

namespace {

SampleStorage checkSamplesAndAdviseAccess(SampleStorage samples, const Shape& shape, bool eager) {
    if (samples.values().size() != sampleCount(shape))
        throw std::invalid_argument("the number of samples does not match the shape of the array");
    samples.adviseAccessOrder(eager ? SampleStorage::AccessOrder::sequential : SampleStorage::AccessOrder::random);
    return samples;
}

// Interpolated values at coordinates from `min` to `max` depend only on a range of samples of the axis. Returns the
// indices of the first and the last sample of this range. Rounding to floats and LatticeAxis::continuousIndex() are
// monotonic, so every float from `min` to `max` has a position between those of the two rounded ends. If `min` or `max`
// is NaN, the range is the whole axis.
std::pair<std::size_t, std::size_t> sampleIndicesBetween(const LatticeAxis& axis, double min, double max) {
    const auto position = [&](double coordinate) { return axis.continuousIndex(static_cast<float>(coordinate)); };
    const float first = std::isnan(min) || std::isnan(max) ? 0 : std::floor(position(min));
    const float last = std::isnan(min) || std::isnan(max) ? axis.last : std::ceil(position(max));
    return {static_cast<std::size_t>(first), static_cast<std::size_t>(std::max(first, last))};
}

}  // namespace

ArrayFunction::ArrayFunction(const Shape& shape, const Box& box, SampleStorage samples, std::size_t eagerSamples)
    : lattice_(shape, box),
      eagerSamples_(eagerSamples),
      samples_(checkSamplesAndAdviseAccess(std::move(samples), shape, sampleCount(shape) <= eagerSamples)),
      bricks_({lattice_, samples_.values().data()}, hasReadSamples()),
      coarser_(hasReadSamples() && this->samples().size() > kMaxSamplesWithoutCoarser ? downsampled() : nullptr) {
    samples_.adviseAccessOrder(SampleStorage::AccessOrder::random);
    releasePages();
}

void ArrayFunction::evaluate(const PointBatch& points, std::span<float> values) const {
    interpolate({lattice_, samples_.values().data()}, points, values, fastestInstructionSet());
}

void ArrayFunction::evaluateWithGradient(const PointBatch& points, std::span<float> values,
                                         const GradientBatch& gradients) const {
    interpolateWithGradient({lattice_, samples_.values().data()}, points, values, gradients, fastestInstructionSet());
}

ValueBounds ArrayFunction::boundsIn(const Box& region) const {
    SampleIndexRange range{};
    for (std::size_t i = 0; i < 4; ++i) {
        const auto axis = static_cast<glm::length_t>(i);
        std::tie(range.first[i], range.last[i]) =
            sampleIndicesBetween(lattice_.axes[i], region.min[axis], region.max[axis]);
    }
    ValueBounds bounds = bricks_.boundsOf(range);
    if (!(bounds.min < bounds.max)) return bounds;
    // Interpolation takes four steps, one along each axis. A step has a rounding error of at most 4.3 · 2⁻²⁴ · extent,
    // and the four steps together of less than 2⁻¹⁹ · extent. The summand 2⁻¹⁴⁶ allows for underflow. If the extent is
    // greater than the largest float, an interpolated value may be NaN.
    const double extent = bounds.max - bounds.min, rounding = extent * 0x1p-19 + 0x1p-146;
    if (extent > double{std::numeric_limits<float>::max()}) bounds.hasValueEverywhere = false;
    bounds.min -= rounding;
    bounds.max += rounding;
    return bounds;
}

Shape ArrayFunction::sampleSelectionShape() const {
    return selectionShape(shape(), std::min(kSelectedSamples, eagerSamples_));
}

const ArrayFunction& ArrayFunction::sampleSelection() const {
    std::call_once(selected_, [&] {
        const Shape size = sampleSelectionShape();
        selection_ =
            std::make_shared<ArrayFunction>(size, box(), SampleStorage(selectSamples(shape(), samples_, size)));
        releasePages();
    });
    return *selection_;
}

const ScalarFunction& ArrayFunction::downsampledForSteps(std::span<const glm::dvec4> steps) const {
    if (!hasReadSamples()) return sampleSelection().downsampledForSteps(steps);
    const bool areLong = std::ranges::all_of(steps, [this](const glm::dvec4& step) {
        double squaredLength = 0;  // the squared length of the step, in cells
        for (std::size_t i = 0; i < 4; ++i) {
            const double along = step[static_cast<glm::length_t>(i)] * lattice_.axes[i].scale;
            squaredLength += along * along;
        }
        return squaredLength >= 4;
    });
    return coarser_ != nullptr && areLong ? coarser_->downsampledForSteps(steps) : *this;
}

void ArrayFunction::releasePages() const {
    // Samples that the constructor has read stay resident: reading them again would take longer than the interpolation.
    if (!hasReadSamples() && samples_.file()) samples_.file()->releasePages();
}

std::size_t ArrayFunction::memoryBytes() const {
    std::size_t coarser = coarser_ == nullptr ? 0 : coarser_->memoryBytes();
    if (!hasReadSamples()) {
        const std::size_t bytes = sampleCount(sampleSelectionShape()) * sizeof(float);
        coarser = bytes + bytes / 10;  // the selection, and a tenth more for its BrickBounds and its downsampled
                                       // versions
    }
    return samples_.memoryBytes() + bricks_.memoryBytes() + coarser;
}

std::shared_ptr<const ArrayFunction> ArrayFunction::downsampled() const {
    const Shape coarse = downsampledShape(lattice_.shape);
    samples_.adviseAccessOrder(SampleStorage::AccessOrder::sequential);
    SampleStorage means(downsample(lattice_.shape, samples_.values()));
    samples_.adviseAccessOrder(SampleStorage::AccessOrder::random);
    return std::make_shared<ArrayFunction>(coarse, lattice_.box, std::move(means), eagerSamples_);
}

}  // namespace oval4d::fields
