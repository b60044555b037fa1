#pragma once
// Computes a step of Newton's method that makes up to three functions zero at once.

#include <array>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace oval4d::slicing {

/// The shortest step from the current point to a point where up to three functions are zero, as if the functions were
/// linear. Ignores a function whose gradient is almost a linear combination of the gradients of the functions added
/// before.
class MinimumNormStep {
  public:
    /// Adds a function, by its gradient and its value at the current point. The gradient must be a unit vector; divide
    /// both by the length of the gradient if it is not.
    void addConstraint(const glm::dvec3& gradient, double value) {
        // The Gram–Schmidt process: basis_ is an orthonormal basis of the space that the gradients span. targets_ are
        // the components of the step along the vectors of basis_.
        constexpr double kIndependent = 0.05;
        glm::dvec3 rest = gradient;
        double target = -value;
        for (std::size_t i = 0; i < count_; ++i) {
            const double along = glm::dot(gradient, basis_[i]);
            rest -= along * basis_[i];
            target -= along * targets_[i];
        }
        const double length = glm::length(rest);
        if (count_ == basis_.size() || !(length > kIndependent)) return;
        basis_[count_] = rest / length;
        targets_[count_++] = target / length;
    }

    /// Returns the step. Returns 0 if no function was added.
    glm::dvec3 solve() const {
        glm::dvec3 step(0);
        for (std::size_t i = 0; i < count_; ++i) step += targets_[i] * basis_[i];
        return step;
    }

  private:
    std::array<glm::dvec3, 3> basis_{};
    std::array<double, 3> targets_{};
    std::size_t count_ = 0;
};

}  // namespace oval4d::slicing
