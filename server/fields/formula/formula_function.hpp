#pragma once
// A formula as a scalar function.

#include <cstddef>
#include <span>

#include "fields/formula/formula.hpp"
#include "fields/formula/kernels.hpp"
#include "fields/scalar_function.hpp"

namespace oval4d::fields {

/// A formula as a scalar function, evaluated in single precision. Parts of the formula that consist only of numbers and
/// named constants are evaluated once, in double precision. At a kink, such as that of abs at 0, the gradient is the
/// gradient on one side, or 0. Where the gradient is infinite or undefined, evaluateWithGradient() writes (0, 0, 0, 0).
class FormulaFunction final : public ScalarFunction {
  public:
    explicit FormulaFunction(Formula formula, const TapeKernels& kernels = fastestKernels());

    const Formula& formula() const { return formula_; }

    void evaluate(const PointBatch& points, std::span<float> values) const override;
    void evaluateWithGradient(const PointBatch& points, std::span<float> values,
                              const GradientBatch& gradients) const override;
    /// Returns bounds that contain both the values that evaluate() returns and the exact real values. The bounds hold
    /// at all points of the region, and at these points rounded to 32-bit floats.
    ValueBounds boundsIn(const Box& region) const override;
    EvaluationCost cost() const override;
    std::size_t memoryBytes() const override;

  private:
    Formula formula_;
    TapeKernels kernels_;
};

}  // namespace oval4d::fields
