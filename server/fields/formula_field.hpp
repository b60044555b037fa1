#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "errors/error.hpp"
#include "fields/field.hpp"

namespace oval4d::fields {

/// The default domain of a formula: from −2 to 2 along each axis.
inline constexpr Box kFormulaBox{glm::dvec4(-2), glm::dvec4(2)};

/// Makes a field from the formula `text` (see parseFormula() for the syntax). If `second` is not empty, it is the
/// formula of the second function (see SecondFunction), and may use the names that `text` defines. Errors:
/// `bad_expression`, with the position of the mistake; `out_of_range` if makeField() rejects the box. The message
/// begins with "values: " if the mistake is in `second`.
Result<Field> fieldFromFormula(std::string name, std::string_view text, const Box& box = kFormulaBox,
                               std::string_view second = {});

/// Sets the second function of a field to the formula `text`. The first function of the field may be a formula or an
/// array. `text` cannot use names that the first formula defines, unlike the second formula of fieldFromFormula().
/// Error: `bad_expression`; the message begins with "values: ".
std::optional<Error> setSecondFormula(Field& field, std::string_view text);

}  // namespace oval4d::fields
