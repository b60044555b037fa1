#pragma once

#include <optional>
#include <string>

#include "errors/error.hpp"
#include "fields/field.hpp"
#include "fields/readers/field_array.hpp"

namespace oval4d::fields {

/// Makes a field from an array. The initial level is the mean of the least and the greatest sample (see
/// ArrayFunction::statistics()); values above the level are inside. Let L be the length of the longest of the axes x, y
/// and z. The 4-D object has the length L along w, too, because a unit of time and a unit of length cannot be compared.
/// Along an axis with one sample, the object has the length L / 2. The texts of the units and of the quantity are
/// shortened by quantityText(). Error: `bad_field` if the box is not valid, or if no sample has a value.
Result<Field> fieldFromArray(std::string name, const FieldArray& array);

/// Adds a second array to `field`, which must be a field of an array (Field::array is not null). The values of the
/// second array can color the surfaces of the field. `variable` is the name of the second array in its file. Error:
/// `bad_field` if the shape or the box of the second array differs from that of the field's array, or if no sample of
/// the second array has a value.
std::optional<Error> setSecondArray(Field& field, const FieldArray& array, std::string variable);

}  // namespace oval4d::fields
