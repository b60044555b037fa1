#include "session/time_steps.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "fields/array_field.hpp"
#include "fields/formula_field.hpp"
#include "fields/readers/field_array.hpp"
#include "text/message_text.hpp"

namespace oval4d::session {

namespace {

// Returns the box of an array after its number of time steps has grown from `before` to `after`. `box` is the box for
// `before` time steps.
fields::Box boxWithTimeSteps(fields::Box box, std::size_t before, std::size_t after) {
    const double step = before > 1 ? (box.max.w - box.min.w) / static_cast<double>(before - 1) : 1;
    box.max.w = box.min.w + step * static_cast<double>(after - 1);
    return box;
}

}  // namespace

Result<slicing::Object> appendTimeSteps(const slicing::Object& field, const slicing::Object& added,
                                        const Limits& limits) {
    const fields::Field* const before = slicing::fieldIn(field);
    const fields::Field* const appended = slicing::fieldIn(added);
    if (before == nullptr || !before->array || appended == nullptr || !appended->array)
        return Error{ErrorCode::bad_field, "moments can be added only to an array, and must be an array"};
    const fields::Shape &old = before->array->shape(), &more = appended->array->shape();
    const auto sizes = [](const fields::Shape& shape) {
        return std::to_string(shape[0]) + " × " + std::to_string(shape[1]) + " × " + std::to_string(shape[2]);
    };
    if (!std::equal(old.begin(), old.begin() + 3, more.begin()))
        return Error{ErrorCode::bad_field,
                     "the moment has " + sizes(more) + " samples along x, y and z, but the field has " + sizes(old)};
    fields::FieldArray grown;
    grown.shape = old;
    grown.shape[3] += more[3];
    const fields::SecondFunction *const second = before->second.get(), *const values = appended->second.get();
    const bool hasArray = second != nullptr && second->array;
    if (hasArray && (values == nullptr || !values->array))
        return Error{ErrorCode::bad_field, "the field is colored by a second array, " +
                                               text::inQuotes(second->variable) +
                                               ", so moments need one, too, as values_variable"};
    const std::size_t most = limits.maxFieldBytes / sizeof(float) / (hasArray ? 2U : 1U);
    if (const std::size_t count = fields::sampleCount(grown.shape); count == 0 || count > most)
        return Error{ErrorCode::too_large, "of " + sizes(old) + " samples, at most " +
                                               std::to_string(most / (old[0] * old[1] * old[2])) +
                                               " moments are allowed (--max-field-bytes), but the field would have " +
                                               std::to_string(grown.shape[3]) + "; it stays as it was"};
    grown.box = boxWithTimeSteps(before->array->box(), old[3], grown.shape[3]);
    grown.samples = before->array->storage().withAppended(appended->array->samples());
    grown.units = before->units;
    grown.quantity = before->quantity;
    auto made = fields::fieldFromArray(before->name, grown);
    if (!made) return made.error();
    std::optional<Error> fault;
    if (hasArray) {
        grown.samples = second->array->storage().withAppended(values->array->samples());
        grown.quantity = second->quantity;
        fault = fields::setSecondArray(*made, grown, second->variable);
    } else if (second != nullptr) {
        fault = fields::setSecondFormula(*made, second->formula);
    }
    if (fault) return std::move(*fault);
    return slicing::Object(std::make_shared<const fields::Field>(std::move(*made)));
}

}  // namespace oval4d::session
