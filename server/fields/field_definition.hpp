#pragma once
// Definitions of fields: the data that are stored of a field, and from which the field can be made again.

#include <optional>
#include <string>

#include "errors/error.hpp"
#include "fields/field.hpp"
#include "fields/readers/field_array.hpp"
#include "geometry/object_info.hpp"
#include "serialization/stored_members.hpp"

namespace oval4d::fields {

/// The definition of the second function of a field: a formula or an array.
struct SecondFunctionDefinition {
    std::string formula;              ///< empty if the function is an array
    std::string variable;             ///< the name of the array in its file; empty if it has none
    std::optional<FieldArray> array;  ///< the array, without units of the axes, because the axes are those of the field
};
void visitStoredMembers(serialization::ReadOrWritten<SecondFunctionDefinition> auto& second, auto& visit) {
    auto& [formula, variable, array] = second;
    visit.member(0, formula);
    visit.member(1, variable);
    visit.member(2, array);
}

/// The definition of a field: a file in the server's data folder, a formula, or an array. The members for the other two
/// are empty.
struct FieldDefinition {
    geometry::ObjectInfo info;              ///< the stored members of the field's ObjectInfo; `originInFile` is 0
    std::optional<FieldFileSource> source;  ///< the file; if it is set, the definition has no second function
    std::string formula;
    Box box;  ///< the domain of the formula
    std::optional<FieldArray> array;
    std::optional<SecondFunctionDefinition> second;
};
void visitStoredMembers(serialization::ReadOrWritten<FieldDefinition> auto& definition, auto& visit) {
    auto& [info, source, formula, box, array, second] = definition;
    visit.member(0, info);
    visit.member(1, source);
    visit.member(2, formula);
    visit.member(3, box);
    visit.member(4, array);
    visit.member(5, second);
}

/// Returns the definition of a field: its file if Field::source is not null, otherwise its functions. `field` must not
/// be a result of transformedTo(). Shares the samples of arrays with the field, without copying them.
FieldDefinition definitionOf(const Field& field);

/// Returns the definition of a field by its functions, even if Field::source is not null.
FieldDefinition definitionByFunctions(const Field& field);

/// Makes the field of a formula or an array from its definition. Errors: those of fieldFromFormula(), fieldFromArray(),
/// setSecondFormula() and setSecondArray(). Also `bad_field` if the definition refers to a file, if members contradict
/// each other (such as a formula and an array), if the number of samples does not match the shape, or if
/// sanitizeQuantityText() would change a unit or a quantity.
Result<Field> fieldFromDefinition(const FieldDefinition& definition);

}  // namespace oval4d::fields
