#pragma once
// Finds critical points of w on the level sets of fields: points at which a level set is tangent to a hyperplane w =
// const.

#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "fields/scalar_function.hpp"

namespace oval4d::slicing {

/// A function f of the coordinates p of a rotated object: f(p) = function(center + toFunction · p).
struct TransformedFunction {
    const fields::ScalarFunction& function;
    glm::dmat4 toFunction;
    glm::dvec4 center;
    double radius;  ///< the circumradius of the object; findCriticalPoint() uses it as its unit of length
};

/// Finds a point near `start` at which a level set of f is tangent to a hyperplane w = const: a point where f = `level`
/// and ∂f/∂x = ∂f/∂y = ∂f/∂z = 0. Uses Newton's method with damped least squares, which converges even if such points
/// are not isolated. All lengths are in the units of the object. Returns an empty optional if the iteration leaves the
/// ball of radius `reach` around `start` or does not converge, or if ∂f/∂w is also 0 at the point.
std::optional<glm::dvec4> findCriticalPoint(const TransformedFunction& placed, double level, const glm::dvec4& start,
                                            double reach);

}  // namespace oval4d::slicing
