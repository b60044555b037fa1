#pragma once
// The interface of 4-D scalar functions f(x, y, z, w), which formulas and arrays implement. Slicing evaluates fields
// only through this interface, except that slicing::FieldLattice also reads the samples of arrays.

#include <cstddef>
#include <limits>
#include <span>

#include <glm/vec4.hpp>

#include "geometry/range.hpp"
#include "serialization/stored_members.hpp"

namespace oval4d::fields {

/// An axis-parallel box in R⁴; every coordinate of `min` is at most that of `max`.
struct Box {
    glm::dvec4 min{-1}, max{1};

    glm::dvec4 center() const { return 0.5 * (min + max); }
    bool operator==(const Box&) const = default;
};
void visitStoredMembers(serialization::ReadOrWritten<Box> auto& box, auto& visit) {
    auto& [min, max] = box;
    visit.member(0, min, geometry::NumberRange::ofFiniteNumbers());
    visit.member(1, max, geometry::NumberRange::ofFiniteNumbers());
}

/// Bounds of the values of a function in a region. min > max means that the function has no value at any point of the
/// region.
struct ValueBounds {
    double min = std::numeric_limits<double>::infinity(), max = -std::numeric_limits<double>::infinity();
    bool hasValueEverywhere = true;  ///< false if the function may have no value (NaN) somewhere in the region

    /// Returns whether the function may take the value `level`, or may have no value, somewhere in the region.
    bool mayCross(double level) const { return !hasValueEverywhere || (min <= level && level <= max); }
};

/// Points as a structure of arrays: point i is (x[i], y[i], z[i], w[i]). All arrays must have the same size.
struct PointBatch {
    std::span<const float> x, y, z, w;

    std::size_t size() const { return x.size(); }
};

/// Memory for gradients as a structure of arrays. `x` holds the derivatives with respect to x; likewise `y`, `z` and
/// `w`. All arrays must have the same size.
struct GradientBatch {
    std::span<float> x, y, z, w;
};

/// Estimated times of evaluations, in nanoseconds on one core of a processor from 2020. The estimates depend only on
/// the function, not on the processor that runs the program.
struct EvaluationCost {
    double value = 1, gradient = 5;  ///< for one point
    double bounds = 100;             ///< for one region
};

/// A function from R⁴ to the real numbers. Where the function has no value, evaluate() writes NaN. The value at a point
/// does not depend on the other points of a batch. Immutable, so any number of threads may use a function at the same
/// time.
class ScalarFunction {
  public:
    /// Batches are fastest if their size is a multiple of this number, and at least 64.
    static constexpr std::size_t kLanes = 8;

    ScalarFunction() = default;
    ScalarFunction(const ScalarFunction&) = delete;
    ScalarFunction& operator=(const ScalarFunction&) = delete;
    virtual ~ScalarFunction() = default;

    /// Writes the value of f at each point to `values`. Values may be infinite.
    virtual void evaluate(const PointBatch& points, std::span<float> values) const = 0;

    /// Writes the value of f and its gradient at each point. Where the gradient does not exist, writes (0, 0, 0, 0).
    virtual void evaluateWithGradient(const PointBatch& points, std::span<float> values,
                                      const GradientBatch& gradients) const = 0;

    /// Returns bounds that contain every value that evaluate() can return in `region`. The bounds need not be tight.
    virtual ValueBounds boundsIn(const Box& region) const = 0;

    /// Returns the function to evaluate on lattices with these steps: this function, or a coarser version of this
    /// function. A coarser version is faster, but may lack details that are smaller than the steps. The result lives as
    /// long as this object. `steps` are the vectors between neighboring points of the lattices, in the function's
    /// coordinates.
    virtual const ScalarFunction& downsampledForSteps(std::span<const glm::dvec4> /*steps*/) const { return *this; }

    /// Releases memory that the next evaluations can restore quickly, such as pages of a mapped file that are also in
    /// the system's cache.
    virtual void releasePages() const {}

    virtual EvaluationCost cost() const = 0;

    /// Returns the memory used, in bytes.
    virtual std::size_t memoryBytes() const = 0;
};

}  // namespace oval4d::fields
