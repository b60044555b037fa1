#pragma once
// A 4-D array of samples as a function.

#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "fields/array/brick_bounds.hpp"
#include "fields/array/lattice.hpp"
#include "fields/array/sample_storage.hpp"
#include "fields/scalar_function.hpp"

namespace oval4d::fields {

/// A function that interpolates samples quadrilinearly. The samples lie on a regular 4-D lattice, which extends from
/// the min to the max of a box.
///
/// - Outside the box, the function has the value of the nearest point of the box. Along an axis with one sample, the
///   function is constant.
/// - Samples that are NaN or infinite are missing. The function has no value wherever a missing sample has a nonzero
///   weight. So if a corner of a cell is missing, the function has no value inside the cell, and none on the faces and
///   edges that contain this corner. It has values on the other faces of the cell.
/// - At a point with a NaN coordinate, the function has no value.
/// - Values are computed with 32-bit floats, and are the same on all processors, with and without AVX2. If all corners
///   of a cell have the same value, the function has exactly this value in the cell. Otherwise, its rounding error is
///   at most 2⁻¹⁹ times the difference between the greatest and the least corner.
class ArrayFunction final : public ScalarFunction {
  public:
    /// The default of the constructor's parameter `eagerSamples`, a number of samples.
    static constexpr std::size_t kEagerSamples = std::size_t{1} << 27U;
    /// Arrays of up to this many samples have no coarser version, because slicing them is fast without one.
    static constexpr std::size_t kMaxSamplesWithoutCoarser = std::size_t{1} << 15U;
    /// The maximum number of samples of a selection. downsampledForSteps() returns a selection for an array that the
    /// constructor does not read.
    static constexpr std::size_t kSelectedSamples = std::size_t{1} << 20U;

    /// Makes the interpolant of `samples`, in which x varies fastest (see Lattice). Reads all samples if there are at
    /// most `eagerSamples`. Otherwise, each sample is read when it is needed (see BrickBounds). Throws
    /// std::invalid_argument if the constructor of Lattice does, or if there are not sampleCount(shape) samples.
    ArrayFunction(const Shape& shape, const Box& box, SampleStorage samples, std::size_t eagerSamples = kEagerSamples);

    /// Writes the value at each point (see ScalarFunction). Does not allocate memory. Takes about 4 ns per point with
    /// AVX2 if the samples are in the processor's cache.
    void evaluate(const PointBatch& points, std::span<float> values) const override;

    /// Writes the value and the gradient at each point (see ScalarFunction). The gradient belongs to the cell that
    /// contains the point; on a face between two cells, to the cell with the greater coordinates. Outside the box, it
    /// is the gradient at the nearest point of the box, so the gradient does not jump at the surface of the box. The
    /// gradient is (0, 0, 0, 0) if a corner of the cell is missing. Its component along an axis with one sample is 0.
    void evaluateWithGradient(const PointBatch& points, std::span<float> values,
                              const GradientBatch& gradients) const override;

    /// Returns bounds of the values in a region (see ScalarFunction). The result is the bounds of all bricks that meet
    /// the region (see BrickBounds), widened by the rounding error of the interpolation. `hasValueEverywhere` is false
    /// if a sample of these bricks may be missing. `hasValueEverywhere` is also false if the difference of the bounds
    /// exceeds the largest float, because an interpolated value may then be NaN. A region whose minimum or maximum
    /// along an axis is NaN extends along the whole axis.
    ValueBounds boundsIn(const Box& region) const override;

    /// Returns this array or a downsampled version: the coarsest version in which each step is at least one cell long.
    /// If a step is shorter than a cell of this array, returns this array. However, if the constructor has not read
    /// this array, returns a selection of at most kSelectedSamples of its samples, or a downsampled version of this
    /// selection.
    const ScalarFunction& downsampledForSteps(std::span<const glm::dvec4> steps) const override;

    /// Releases the resident pages of the samples (see MappedFile::releasePages()). Does nothing if the samples are not
    /// in a mapped file, or if the constructor has read them.
    void releasePages() const override;

    EvaluationCost cost() const override { return {10, 25, 100}; }

    /// Returns the memory used, in bytes: by the BrickBounds, by the downsampled versions (at most about 1/15 of the
    /// memory of the samples), and by the samples unless they are in a mapped file. For an array that the constructor
    /// has not read, includes the maximum that the BrickBounds and the selection of downsampledForSteps() may take.
    std::size_t memoryBytes() const override;

    const Shape& shape() const { return lattice_.shape; }
    const Box& box() const { return lattice_.box; }
    std::span<const float> samples() const { return samples_.values(); }
    const SampleStorage& storage() const { return samples_; }

    /// Returns the least and the greatest sample and the number of missing samples. If statisticsAreExact() is false,
    /// considers only a selection of about 260,000 samples.
    const SampleStatistics& statistics() const { return bricks_.statistics(); }
    /// Returns whether statistics() considers all samples.
    bool statisticsAreExact() const { return hasReadSamples(); }

    /// Returns a coarser array with the same box and half as many cells along each axis, rounded up. A sample of the
    /// result is the mean of the interpolant over a box around the sample. Along each axis, this box is as long as a
    /// coarse cell, or has no extent if the sample is the first or the last one on the axis. Missing samples are left
    /// out of a mean; if all samples of a mean are missing, the result is missing. Reads all samples once, in order.
    /// Returns an equal array if no axis has more than one cell.
    std::shared_ptr<const ArrayFunction> downsampled() const;

  private:
    // Returns whether the constructor has read the samples.
    bool hasReadSamples() const { return samples().size() <= eagerSamples_; }
    Shape sampleSelectionShape() const;
    const ArrayFunction& sampleSelection() const;

    const Lattice lattice_;
    const std::size_t eagerSamples_;
    const SampleStorage samples_;
    const BrickBounds bricks_;
    const std::shared_ptr<const ArrayFunction> coarser_;  // the result of downsampled(); null for small arrays, and
                                                          // unless hasReadSamples()
    // The selection for downsampledForSteps(), which is made when it is first needed; always null if hasReadSamples().
    mutable std::once_flag selected_;
    mutable std::shared_ptr<const ArrayFunction> selection_;
};

}  // namespace oval4d::fields
