#pragma once
// What is stored of a field, and from which it can be made again.

#include <optional>
#include <string>

#include "errors/error.hpp"
#include "fields/field.hpp"
#include "fields/readers/field_array.hpp"
#include "geometry/object_info.hpp"
#include "serialization/stored_members.hpp"

namespace oval4d::fields {

/// From what the second function of a field is made: a formula or an array.
struct SecondFunctionDefinition {
    std::string formula;              ///< empty if the function is an array
    std::string variable;             ///< the name of the array in its file; empty if it has none
    std::optional<FieldArray> array;  ///< without units of the axes, which are those of the field
};
void visitStoredMembers(serialization::ReadOrWritten<SecondFunctionDefinition> auto& second, auto& visit) {
    auto& [formula, variable, array] = second;
    visit.member(0, formula);
    visit.member(1, variable);
    visit.member(2, array);
}

/// From what a field is made: a file in the server's data folder, a formula, or an array. The members of the other two
/// are empty.
struct FieldDefinition {
    geometry::ObjectInfo info;         ///< only the stored members, of which `originInFile` is 0
    std::optional<FileSource> source;  ///< the file; the definition then has no second function
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

/// Returns from what a field is made: its file if Field::source is not null; else its functions. `field` must not have
/// been made by transformedTo(). The samples of arrays are shared with the field, not copied.
FieldDefinition definitionOf(const Field& field);

/// Returns the same as definitionOf(), but the functions even if they are in a file.
FieldDefinition definitionByFunctions(const Field& field);

/// Makes a field of a formula or of an array. Errors: those of fieldFromFormula(), fieldFromArray(), setSecondFormula()
/// and setSecondArray(); `bad_field` if members contradict each other, such as a formula and an array, if the samples
/// of an array do not match its shape, if quantityText() would change a unit or a quantity, or if the definition refers
/// to a file.
Result<Field> fieldFromDefinition(const FieldDefinition& definition);

}  // namespace oval4d::fields
