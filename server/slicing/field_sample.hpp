#pragma once
// A point of a field, and the values of its functions there.

#include <optional>

#include <glm/vec4.hpp>

#include "fields/field.hpp"
#include "geometry/rotation.hpp"

namespace oval4d::slicing {

/// A point of a field.
struct FieldSample {
    glm::dvec4 place{0};  ///< in the coordinates of the function
    /// The values of the function and of the second function. Empty outside the box, where the function has no finite
    /// value, and, for `secondValue`, if there is no second function.
    std::optional<double> value = {}, secondValue = {};
};

/// Returns the point of `field` that `orientation` turns to `point`, which is in the units of the object. A point that
/// rounding has moved out of the box, by up to 1/10,000 of its extent along an axis, is taken to be on the boundary of
/// the box. Throws std::runtime_error if the samples are in a file that can no longer be read.
FieldSample sampleField(const fields::Field& field, const geometry::Rotation& orientation, const glm::dvec4& point);

}  // namespace oval4d::slicing
