#include "fields/axis_units.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

namespace oval4d::fields {

PictureUnits pictureUnits(const Field& field, const geometry::Rotation& orientation) {
    constexpr double kTolerance = 1e-9;  // for the rounding errors of rotations
    PictureUnits units;
    if (std::ranges::all_of(field.units, &std::string::empty)) return units;
    const glm::dmat4 fromFunction = orientation.matrix() * glm::inverse(field.toFunction);
    for (int axis = 0; axis < 4; ++axis) {
        // The coordinate along the axis is the scalar product of these factors and the coordinates in the box.
        const glm::dvec4 factors(fromFunction[0][axis], fromFunction[1][axis], fromFunction[2][axis],
                                 fromFunction[3][axis]);
        const double size = glm::length(factors);
        const std::string* unit = nullptr;
        bool differ = false;
        for (int of = 0; of < 4; ++of) {
            if (std::abs(factors[of]) <= kTolerance * size) continue;
            const std::string& next = field.units.at(static_cast<std::size_t>(of));
            differ = differ || (unit != nullptr && *unit != next);
            unit = &next;
        }
        if (unit != nullptr && !differ && !unit->empty())
            units.at(static_cast<std::size_t>(axis)) = {*unit, std::abs(size - 1) <= kTolerance};
    }
    return units;
}

std::string lengthUnit(const PictureUnits& units) {
    const auto& [x, y, z, w] = units;
    return x.isToScale && x == y && y == z ? x.text : std::string();
}

std::string axisLabel(int axis, const PictureAxisUnit& unit) {
    std::string label(1, "xyzw"[axis]);
    if (!unit.text.empty()) label += ", " + unit.text;
    return label;
}

}  // namespace oval4d::fields
