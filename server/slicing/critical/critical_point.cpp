#include "slicing/critical/critical_point.hpp"

#include <array>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace oval4d::slicing {

namespace {

// The distance from a point to the neighbors whose gradients give its second derivatives, in units of
// TransformedFunction::radius.
constexpr double kDifference = 2e-3;
// The damping of the least squares, divided by the mean diagonal entry of J Jᵀ, where J is the Jacobian.
constexpr double kDamping = 1e-6;
constexpr int kIterations = 30;
// Upper bounds of three values at a point that counts as critical. kSmallStep bounds the length of the next step.
// kTangent bounds the length of the gradient's component in the hyperplane, divided by the length of the gradient ∇f.
// kOnLevel bounds |f − level| / |∇f|, an estimate of the distance from the level set. The unit of length is
// TransformedFunction::radius.
constexpr double kSmallStep = 1e-5, kTangent = 1e-3, kOnLevel = 1e-5;

/// The value of the function f at a point, and its derivatives there. The unit of length is
/// TransformedFunction::radius.
struct TaylorExpansion {
    double value = 0;
    glm::dvec4 gradient{0};
    std::array<glm::dvec4, 3> second{};  // the derivatives of ∂f/∂x, ∂f/∂y and ∂f/∂z along x, y, z and w
};

// Computes the value and the gradient of the function at `point`, and its second derivatives as difference quotients of
// gradients. `point` is in units of TransformedFunction::radius.
TaylorExpansion taylorExpansionAt(const TransformedFunction& placed, const glm::dvec4& point) {
    // Point 0 of the batch is `point` itself. Points 1 … 8 are the two neighbors of `point` along each axis. The
    // remaining points repeat point 0 to fill the batch.
    constexpr std::size_t kPoints = 16;
    std::array<std::array<float, kPoints>, 4> at{}, slopes{};
    std::array<float, kPoints> values{};
    for (std::size_t i = 0; i < kPoints; ++i) {
        glm::dvec4 p = point;
        if (i >= 1 && i <= 8) p[static_cast<int>((i - 1) / 2)] += (i % 2 == 1 ? kDifference : -kDifference);
        const glm::dvec4 q = placed.center + placed.toFunction * (placed.radius * p);
        for (std::size_t axis = 0; axis < 4; ++axis) at[axis][i] = static_cast<float>(q[static_cast<int>(axis)]);
    }
    placed.function.evaluateWithGradient({at[0], at[1], at[2], at[3]}, values,
                                         {slopes[0], slopes[1], slopes[2], slopes[3]});
    const glm::dmat4 back = placed.radius * glm::transpose(placed.toFunction);
    const auto gradient = [&](std::size_t i) {
        return back * glm::dvec4(slopes[0][i], slopes[1][i], slopes[2][i], slopes[3][i]);
    };
    TaylorExpansion result{values[0], gradient(0), {}};
    for (int axis = 0; axis < 4; ++axis) {
        const std::size_t next = 2 * static_cast<std::size_t>(axis) + 1;
        const glm::dvec4 along = (gradient(next) - gradient(next + 1)) / (2 * kDifference);
        for (int i = 0; i < 3; ++i) result.second[static_cast<std::size_t>(i)][axis] = along[i];
    }
    return result;
}

}  // namespace

std::optional<glm::dvec4> findCriticalPoint(const TransformedFunction& placed, double level, const glm::dvec4& start,
                                            double reach) {
    const glm::dvec4 first = start / placed.radius;
    const double most = reach / placed.radius;
    glm::dvec4 point = first;
    double scale = 0;
    for (int i = 0; i < kIterations; ++i) {
        const TaylorExpansion f = taylorExpansionAt(placed, point);
        if (scale == 0) scale = glm::length(f.gradient);
        const glm::dvec4 residual = glm::dvec4(f.gradient.x, f.gradient.y, f.gradient.z, f.value - level) / scale;
        // The rows of the Jacobian are the gradients of the entries of `residual`. The GLM constructor takes columns,
        // so it makes the transpose of the Jacobian.
        const glm::dmat4 transposed =
            glm::dmat4(f.second[0], f.second[1], f.second[2], f.gradient) * glm::dmat4(1 / scale);
        const glm::dmat4 product = glm::transpose(transposed) * transposed;
        const double trace = product[0][0] + product[1][1] + product[2][2] + product[3][3];
        glm::dvec4 step = -(transposed * (glm::inverse(product + glm::dmat4(kDamping * trace / 4)) * residual));
        const double length = glm::length(step);
        if (!std::isfinite(length)) return std::nullopt;
        const double slope = glm::length(f.gradient);
        if (length < kSmallStep && glm::length(glm::dvec3(f.gradient)) < kTangent * slope &&
            std::abs(f.value - level) < kOnLevel * slope)
            return placed.radius * point;
        if (length > most / 2) step *= most / 2 / length;
        point += step;
        if (glm::distance(point, first) > most) return std::nullopt;
    }
    return std::nullopt;
}

}  // namespace oval4d::slicing
