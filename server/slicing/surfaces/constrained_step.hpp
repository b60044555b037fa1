#pragma once
// A step of Newton's method for several equations.

#include <array>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace oval4d::slicing {

/// Computes the shortest step from the current point to a point where up to three functions are zero, as if the
/// functions were linear. Ignores a function whose gradient is almost a linear combination of the gradients of the
/// functions added before.
class ConstrainedStep {
  public:
    /// Adds a function with this gradient, which must be a unit vector, and this value at the current point.
    void add(const glm::dvec3& gradient, double value) {
        // Gram–Schmidt: basis_ is orthonormal, and targets_ are the components of the step along the vectors of basis_.
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

    /// Returns the step; 0 if no function was added.
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
