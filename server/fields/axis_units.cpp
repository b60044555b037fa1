#include "fields/axis_units.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "text/message_text.hpp"

namespace oval4d::fields {

namespace {

constexpr double kTolerance = 1e-9;  // allows for the rounding errors of rotation matrices

// Returns the linear map from coordinates in the box, relative to its center, to coordinates in the picture.
glm::dmat4 boxToPicture(const Field& field, const geometry::Rotation& orientation) {
    return orientation.matrix() * glm::inverse(field.toFunction);
}

// Returns the factors by which the four coordinates in the box are multiplied. The sum of the products is the
// coordinate along the axis `axis` of the picture.
glm::dvec4 coordinateCoefficients(const glm::dmat4& toPicture, int axis) {
    return {toPicture[0][axis], toPicture[1][axis], toPicture[2][axis], toPicture[3][axis]};
}

}  // namespace

PictureUnits pictureUnits(const Field& field, const geometry::Rotation& orientation) {
    PictureUnits units;
    if (std::ranges::all_of(field.units, &std::string::empty)) return units;
    const glm::dmat4 fromFunction = boxToPicture(field, orientation);
    for (int axis = 0; axis < 4; ++axis) {
        const glm::dvec4 factors = coordinateCoefficients(fromFunction, axis);
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

bool ConstantSliceCoordinate::isW() const { return axis == 3 && center == 0 && std::abs(scale - 1) <= kTolerance; }

std::optional<ConstantSliceCoordinate> constantSliceCoordinate(const Field& field,
                                                               const geometry::Rotation& orientation) {
    const glm::dvec4 factors = coordinateCoefficients(boxToPicture(field, orientation), 3);
    const double size = glm::length(factors);
    std::optional<ConstantSliceCoordinate> found;
    for (int axis = 0; axis < 4; ++axis) {
        if (std::abs(factors[axis]) <= kTolerance * size) continue;
        if (found) return {};
        found = {axis, field.center[axis], 1 / factors[axis]};
    }
    return found;
}

std::string constantSliceCoordinateText(const Field& field, const geometry::Rotation& orientation, double w,
                                        double spacing) {
    const auto coordinate = constantSliceCoordinate(field, orientation);
    if (!coordinate) return {};
    const std::string& unit = field.units.at(static_cast<std::size_t>(coordinate->axis));
    if (unit.empty() && coordinate->isW()) return {};
    // The text shows two digits of the distance between neighboring slices. It has at most 15 decimals, because a
    // double holds 15 digits.
    const double step = std::abs(coordinate->scale) * spacing, value = coordinate->coordinateAt(w);
    const double decimals = step > 0 ? std::clamp(1 - std::floor(std::log10(step)), 0.0, 15.0) : 3;
    const double unitOfLastDigit = std::pow(10, -decimals);
    std::string text = text::roundedDecimal(std::round(value / unitOfLastDigit) * unitOfLastDigit);
    if (coordinate->axis != 3 || unit.empty()) text.insert(0, std::string("box ") + "xyzw"[coordinate->axis] + " = ");
    if (!unit.empty()) text.append(" ").append(unit);
    return text;
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
