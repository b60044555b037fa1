#pragma once
// Samples a field at one point.

#include <optional>

#include <glm/vec4.hpp>

#include "fields/field.hpp"
#include "geometry/rotation.hpp"

namespace oval4d::slicing {

/// A point of a field, and the values of the field's functions there.
struct FieldSample {
    glm::dvec4 place{0};  ///< the point, in the coordinates of the function
    /// The values of the field's function and of its second function at `place`. Both are empty if the point is outside
    /// the box. A value is also empty where its function has no finite value, and `secondValue` if there is no second
    /// function.
    std::optional<double> value = {}, secondValue = {};
};

/// Returns the point of `field` that `orientation` turns to `point`, with the values there. `point` is in the units of
/// the object. Rounding may have moved a point out of the box, by up to 1/10,000 of the box's extent along an axis;
/// such a point is taken to be on the boundary of the box. Throws std::runtime_error if the samples are in a file that
/// can no longer be read.
FieldSample sampleField(const fields::Field& field, const geometry::Rotation& orientation, const glm::dvec4& point);

}  // namespace oval4d::slicing
