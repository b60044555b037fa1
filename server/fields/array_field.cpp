#include "fields/array_field.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace oval4d::fields {

Result<Field> fieldFromArray(std::string name, const FieldArray& array) {
    auto function = array.function();
    if (!function) return function.error();
    const SampleStatistics& samples = (*function)->statistics();
    if (samples.min > samples.max) return Error{ErrorCode::bad_field, "no sample of the array has a value"};
    Box box = array.box;
    double longest = 0;
    for (int axis = 0; axis < 3; ++axis) longest = std::max(longest, box.max[axis] - box.min[axis]);
    if (longest == 0) longest = box.max.w > box.min.w ? box.max.w - box.min.w : 1;
    glm::dvec4 scale(1);
    for (int axis = 0; axis < 4; ++axis) {
        if (array.shape[static_cast<std::size_t>(axis)] == 1) {
            // Along this axis, the object extends from −reach to reach, and the box from middle − inBox to middle +
            // inBox. If `middle` is far from 0, 32-bit floats might not distinguish middle − reach from middle + reach;
            // then inBox is made greater than reach. A longer box makes no difference, because the function is constant
            // along this axis.
            constexpr double kMinRelativeReach = 1e-4;
            const double middle = box.center()[axis], reach = 0.25 * longest;
            const double inBox = std::max(reach, kMinRelativeReach * std::abs(middle));
            box.min[axis] = middle - inBox;
            box.max[axis] = middle + inBox;
            scale[axis] = reach / inBox;
        } else if (axis == 3) {
            scale.w = longest / (box.max.w - box.min.w);
        }
    }
    try {
        Field field = makeField(std::move(name), *function, box, scale);
        field.array = *function;
        std::ranges::transform(array.units, field.units.begin(), sanitizeQuantityText);
        field.quantity = {sanitizeQuantityText(array.quantity.name), sanitizeQuantityText(array.quantity.unit)};
        field.isPart = array.isPart;
        field.imageLevel = array.imageLevel;
        field.initialLevel = 0.5 * (static_cast<double>(samples.min) + samples.max);
        field.initialInside = BodySide::above;
        return field;
    } catch (const std::invalid_argument& fault) {
        return Error{ErrorCode::bad_field, fault.what()};
    }
}

std::optional<Error> setSecondArray(Field& field, const FieldArray& array, std::string variable) {
    const auto sizes = [](const Shape& shape) {
        std::string text;
        for (const std::size_t samples : shape) text += (text.empty() ? "" : " × ") + std::to_string(samples);
        return text;
    };
    const ArrayFunction& first = *field.array;
    if (array.shape != first.shape()) {
        return Error{ErrorCode::bad_field, "the array of the values has " + sizes(array.shape) +
                                               " samples along x, y, z and w, but the field has " +
                                               sizes(first.shape())};
    }
    constexpr double kTolerance = 1e-6;
    const Box& box = first.box();
    for (int axis = 0; axis < 4; ++axis) {
        const double most = kTolerance * std::max(box.max[axis] - box.min[axis], std::abs(box.max[axis]));
        if (std::abs(array.box.min[axis] - box.min[axis]) <= most &&
            std::abs(array.box.max[axis] - box.max[axis]) <= most)
            continue;
        return Error{ErrorCode::bad_field, std::string("the array of the values has another range of ") + "xyzw"[axis] +
                                               " than the field; a box applies to both"};
    }
    const auto function = array.function();
    if (!function) return function.error();
    if ((*function)->statistics().min > (*function)->statistics().max)
        return Error{ErrorCode::bad_field, "no sample of the array of the values has a value"};
    setSecondFunction(field, {*function,
                              {},
                              *function,
                              std::move(variable),
                              {sanitizeQuantityText(array.quantity.name), sanitizeQuantityText(array.quantity.unit)}});
    return {};
}

}  // namespace oval4d::fields
