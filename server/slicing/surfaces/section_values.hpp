#pragma once
// Evaluates functions at the points of a slice.

#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "fields/field.hpp"
#include "slicing/surfaces/surface_extractor.hpp"

namespace oval4d::slicing {

/// Sets `origin`, `axes` and `normal` of `section` for the hyperplane at `w` that cuts a rotated field. `toFunction`
/// must be Field::toFunction times the inverse of the rotation matrix.
void placeSection(const fields::Field& field, const glm::dmat4& toFunction, double w, FieldSection& section);

/// Sets `values` to the values of `function` at `points`, which are given by their coordinates x, y and z in the slice.
/// A value is NaN where the function has no value.
void evaluateInSection(const fields::ScalarFunction& function, const FieldSection& section,
                       std::span<const glm::vec3> points, std::vector<float>& values);
void evaluateInSection(const fields::ScalarFunction& function, const FieldSection& section,
                       std::span<const glm::dvec3> points, std::vector<float>& values);

}  // namespace oval4d::slicing
