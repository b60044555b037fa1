#include "fields/field_definition.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "fields/array/array_function.hpp"
#include "fields/array_field.hpp"
#include "fields/formula_field.hpp"

namespace oval4d::fields {

namespace {

/// Returns the array of a function, without its quantity and units.
FieldArray arrayOf(const ArrayFunction& function) {
    FieldArray array;
    array.shape = function.shape();
    array.box = function.box();
    array.samples = function.storage();
    return array;
}

SecondFunctionDefinition definitionOf(const SecondFunction& second) {
    const auto& [function, formula, array, variable, quantity] = second;  // `function` is not stored, because the other
                                                                          // members determine it
    SecondFunctionDefinition definition{formula, variable, {}};
    if (array) {
        definition.array = arrayOf(*array);
        definition.array->quantity = quantity;
    }
    return definition;
}

std::optional<Error> validationErrorOf(const FieldArray& array) {
    const std::size_t count = sampleCount(array.shape);
    if (count == 0 || array.samples.values().size() != count) return badFieldError("samples of an array are missing");
    if (!std::ranges::all_of(array.units, isQuantityText) || !isQuantityText(array.quantity.name) ||
        !isQuantityText(array.quantity.unit))
        return badFieldError("a unit or the name of a quantity is too long or is not printable UTF-8");
    const auto& [level, levels, finer] = array.imageLevel;
    if (level >= std::max(levels, 1U) || finer > level)
        return badFieldError("an image does not have the level of the array");
    return {};
}

}  // namespace

// Members of Field that the definition leaves out: `shared`, which says whether sessions share the field; and function,
// center, toFunction, domain, isTransformed, initialLevel, initialInside and coloringRange, which are computed.
static_assert(serialization::HasOwnMembers<Field, geometry::ObjectInfo, 18>, "the definition considers each member");
FieldDefinition definitionOf(const Field& field) {
    if (!field.source) return definitionByFunctions(field);
    FieldDefinition definition;
    definition.info = static_cast<const geometry::ObjectInfo&>(field);
    definition.source = *field.source;
    return definition;
}

FieldDefinition definitionByFunctions(const Field& field) {
    FieldDefinition definition;
    definition.info = static_cast<const geometry::ObjectInfo&>(field);
    definition.formula = field.formula;
    if (field.array) {
        FieldArray& array = definition.array.emplace(arrayOf(*field.array));
        array.units = field.units;
        array.quantity = field.quantity;
        array.isPart = field.isPart;
        array.imageLevel = field.imageLevel;
    } else {
        definition.box = field.box;
    }
    if (field.second) definition.second = definitionOf(*field.second);
    return definition;
}

Result<Field> fieldFromDefinition(const FieldDefinition& definition) {
    const auto& [info, source, formula, box, array, second] = definition;
    if (source) return badFieldError("the samples are in a file");
    if (second && second->array.has_value() != second->formula.empty())
        return badFieldError("the second function is neither a formula nor an array, or both");
    if (!array) {
        if (second && second->array) return badFieldError("a formula has an array");
        return fieldFromFormula(info.name, formula, box, second ? second->formula : std::string());
    }
    if (!formula.empty()) return badFieldError("it is both a formula and an array");
    if (auto fault = validationErrorOf(*array)) return std::move(*fault);
    if (second && second->array) {
        if (auto fault = validationErrorOf(*second->array)) return std::move(*fault);
    }
    Result<Field> field = fieldFromArray(info.name, *array);
    if (!field || !second) return field;
    auto error = second->array ? setSecondArray(*field, *second->array, second->variable)
                               : setSecondFormula(*field, second->formula);
    if (error) return std::move(*error);
    return field;
}

}  // namespace oval4d::fields
