#include "slicing/surfaces/section_values.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace oval4d::slicing {

namespace {

template <typename Point>
void evaluateAt(const fields::ScalarFunction& function, const FieldSection& section, std::span<const Point> points,
                std::vector<float>& values) {
    constexpr std::size_t kBatch = 512;
    std::array<std::array<float, kBatch>, 4> batch;
    values.resize(points.size());
    for (std::size_t begin = 0; begin < points.size(); begin += kBatch) {
        const std::size_t size = std::min(kBatch, points.size() - begin);
        for (std::size_t i = 0; i < size; ++i) {
            const glm::dvec3 p(points[begin + i]);
            const glm::dvec4 at =
                section.origin + p.x * section.axes[0] + p.y * section.axes[1] + p.z * section.axes[2];
            for (int axis = 0; axis < 4; ++axis)
                batch[static_cast<std::size_t>(axis)][i] = static_cast<float>(at[axis]);
        }
        const auto along = [&](std::size_t axis) { return std::span<const float>(batch[axis]).first(size); };
        function.evaluate({along(0), along(1), along(2), along(3)}, std::span(values).subspan(begin, size));
    }
}

}  // namespace

void placeSection(const fields::Field& field, const glm::dmat4& toFunction, double w, FieldSection& section) {
    for (int i = 0; i < 3; ++i) section.axes[static_cast<std::size_t>(i)] = toFunction[i];
    section.normal = toFunction[3];
    section.origin = field.center + w * section.normal;
}

void evaluateInSection(const fields::ScalarFunction& function, const FieldSection& section,
                       std::span<const glm::vec3> points, std::vector<float>& values) {
    evaluateAt(function, section, points, values);
}

void evaluateInSection(const fields::ScalarFunction& function, const FieldSection& section,
                       std::span<const glm::dvec3> points, std::vector<float>& values) {
    evaluateAt(function, section, points, values);
}

}  // namespace oval4d::slicing
