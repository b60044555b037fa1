#include "slicing/field_sample.hpp"

#include <cmath>
#include <span>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

namespace oval4d::slicing {

namespace {

std::optional<double> valueAt(const fields::ScalarFunction& function, const glm::dvec4& place) {
    const glm::vec4 p(place);
    float value = 0;
    function.evaluate({std::span(&p.x, 1), std::span(&p.y, 1), std::span(&p.z, 1), std::span(&p.w, 1)},
                      std::span(&value, 1));
    function.releasePages();
    return std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

}  // namespace

FieldSample sampleField(const fields::Field& field, const geometry::Rotation& orientation, const glm::dvec4& point) {
    constexpr double kRounding = 1e-4;
    FieldSample sample{field.center + field.toFunction * orientation.inverse()(point)};
    const glm::dvec4 within = glm::clamp(sample.place, field.box.min, field.box.max);
    const glm::dvec4 distance = glm::abs(sample.place - within);
    if (glm::any(glm::greaterThan(distance, kRounding * (field.box.max - field.box.min)))) return sample;
    sample.place = within;
    sample.value = valueAt(*field.function, within);
    if (field.second != nullptr) sample.secondValue = valueAt(*field.second->function, within);
    field.requireReadable();
    return sample;
}

}  // namespace oval4d::slicing
