#pragma once

#include <optional>
#include <string>

#include "errors/error.hpp"
#include "fields/field.hpp"
#include "fields/readers/field_array.hpp"

namespace oval4d::fields {

/// Makes a field from an array. The initial level is the mean of the least and the greatest sample (see
/// ArrayFunction::statistics()); points where the value is above the level are inside. The 4-D object is as long along
/// w as along the longest of the axes x, y and z, because a unit of time and a unit of length cannot be compared. Along
/// an axis with one sample, the object is half as long. sanitizeQuantityText() is applied to the texts of the units and
/// of the quantity. Error: `bad_field` if the box is not valid, or if all samples are missing.
Result<Field> fieldFromArray(std::string name, const FieldArray& array);

/// Sets the second function of `field` (see SecondFunction) to an array. `field` must be a field of an array
/// (Field::array is not null). `variable` is the name of the second array in its file. Error: `bad_field` if the second
/// array has another shape or box than the array of the field, or if all of its samples are missing.
std::optional<Error> setSecondArray(Field& field, const FieldArray& array, std::string variable);

}  // namespace oval4d::fields
