#include "slicing/surfaces/slice_fog.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "slicing/surfaces/function_points.hpp"

namespace oval4d::slicing {

namespace {

std::uint8_t quantizeToByte(float value, double least, double scale) {
    if (std::isnan(value)) return 0;
    const double above = (value - least) * scale;
    // If `scale` is infinite, `above` is 0 · ∞ = NaN for the value `least`. NaN > 0 is false, so the result is 1, as it
    // must be.
    return static_cast<std::uint8_t>(above > 0 ? 1 + std::lround(std::min(above, 254.0)) : 1);
}

}  // namespace

glm::ivec3 fogLatticeSize(const glm::dvec3& min, const glm::dvec3& max, double step) {
    return glm::ivec3(glm::ceil(max / step) - glm::floor(min / step)) + 1;
}

void sampleFog(const fields::ScalarFunction& function, const FieldSection& section, double least, double greatest,
               double step, SliceFog& out) {
    out.clear();
    if (glm::any(glm::greaterThanEqual(section.min, section.max))) return;
    const glm::dvec3 extent = section.max - section.min;
    out.step = std::max(step, std::max({extent.x, extent.y, extent.z}) / (SliceFog::kMaxPoints - 3));
    out.size = fogLatticeSize(section.min, section.max, out.step);
    const glm::dvec3 first = glm::floor(section.min / out.step);
    out.min = out.step * first;
    out.walls = section.walls;
    out.values.resize(static_cast<std::size_t>(out.size.x) * out.size.y * out.size.z);

    const double scale = 254 / (greatest - least);
    const glm::vec4 along(out.step * section.axes[0]);
    PointsInFunctionCoordinates points;
    std::array<float, PointsInFunctionCoordinates::kCapacity> values{};
    std::size_t waiting = 0, done = 0;
    const auto evaluate = [&] {
        function.evaluate(points.batch(waiting), std::span(values).first(waiting));
        for (std::size_t i = 0; i < waiting; ++i) out.values[done++] = quantizeToByte(values[i], least, scale);
        waiting = 0;
    };
    for (int k = 0; k < out.size.z; ++k) {
        for (int j = 0; j < out.size.y; ++j) {
            for (int i = 0; i < out.size.x;) {
                const auto count = std::min(static_cast<std::size_t>(out.size.x - i), values.size() - waiting);
                points.setPointsInRow(waiting, section, out.step * (first + glm::dvec3(i, j, k)), along, count);
                waiting += count;
                i += static_cast<int>(count);
                if (waiting == values.size()) evaluate();
            }
        }
    }
    evaluate();
}

}  // namespace oval4d::slicing
