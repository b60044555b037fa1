#pragma once

#include <optional>
#include <string>

#include "errors/error.hpp"
#include "fields/field.hpp"
#include "fields/readers/read_field.hpp"

namespace oval4d::fields {

/// Makes a field from an array. The initial level is the mean of the least and the greatest sample (see
/// ArrayFunction::statistics()); values above it are inside. The axis w is scaled to the length of the longest of the
/// axes x, y and z, because a unit of time and a unit of length cannot be compared. An axis with one sample gets half
/// of this length. Error: `bad_field` if the box is not valid, or if no sample has a value.
Result<Field> fieldFromArray(std::string name, const ReadField& array);

/// Sets a second array, whose values can color the surfaces of `field`, which must be the field of an array. `variable`
/// is the name of the second array in its file. Error: `bad_field` if the shape or the box of the second array differs
/// from that of the field, or if no sample of the second array has a value.
std::optional<Error> setSecondArray(Field& field, const ReadField& array, std::string variable);

}  // namespace oval4d::fields
