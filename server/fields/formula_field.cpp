#include "fields/formula_field.hpp"

#include <memory>
#include <stdexcept>
#include <utility>

#include "fields/formula/formula_function.hpp"

namespace oval4d::fields {

namespace {

std::optional<Error> parseAndSetSecondFormula(Field& field, std::string_view text, const Formula* shared) {
    auto formula = parseFormula(text, nullptr, {}, shared);
    if (!formula) return Error{formula.error().code, "values: " + formula.error().message};
    std::string normalized = formula->text();
    setSecondFunction(field, {std::make_shared<const FormulaFunction>(std::move(*formula)), std::move(normalized)});
    return {};
}

}  // namespace

Result<Field> fieldFromFormula(std::string name, std::string_view text, const Box& box, std::string_view second) {
    auto formula = parseFormula(text);
    if (!formula) return formula.error();
    const Formula shared = *formula;
    try {
        Field field = makeField(std::move(name), std::make_shared<const FormulaFunction>(std::move(*formula)), box);
        field.formula = shared.text();
        if (second.empty()) return field;
        if (auto error = parseAndSetSecondFormula(field, second, &shared)) return std::move(*error);
        return field;
    } catch (const std::invalid_argument& fault) {
        return Error{ErrorCode::out_of_range, fault.what()};
    }
}

std::optional<Error> setSecondFormula(Field& field, std::string_view text) {
    return parseAndSetSecondFormula(field, text, nullptr);
}

}  // namespace oval4d::fields
