#pragma once
// Converts points of a slice to the points at which a function is evaluated.

#include <array>
#include <cstddef>
#include <span>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "fields/scalar_function.hpp"
#include "slicing/surfaces/field_section.hpp"

namespace oval4d::slicing {

/// Up to kCapacity points of a slice, in the coordinates of a function, as a structure of arrays. The functions below
/// take points in the slice's coordinates x, y, z, and convert them.
struct PointsInFunctionCoordinates {
    static constexpr std::size_t kCapacity = 512;
    std::array<std::array<float, kCapacity>, 4> coordinates;

    /// Sets point i to the point p of the slice.
    void setPoint(std::size_t i, const FieldSection& section, const glm::dvec3& p) {
        const glm::dvec4 at = section.origin + p.x * section.axes[0] + p.y * section.axes[1] + p.z * section.axes[2];
        for (int k = 0; k < 4; ++k) coordinates[static_cast<std::size_t>(k)][i] = static_cast<float>(at[k]);
    }
    /// Sets the points with the indices i … i + size.x · size.y · size.z − 1 to a box-shaped part of a lattice; x
    /// varies fastest. `first` is the point with the least x, y and z, in the slice's coordinates. `steps` are the
    /// vectors from a point to the next one along x, y and z of the slice, in the function's coordinates.
    void setPointsInBox(std::size_t i, const FieldSection& section, const glm::dvec3& first,
                        const std::array<glm::vec4, 3>& steps, const glm::ivec3& size) {
        setPoint(i, section, first);
        for (int c = 0; c < 4; ++c) {
            float* out = &coordinates[static_cast<std::size_t>(c)][i];
            const float origin = *out;
            for (int z = 0; z < size.z; ++z) {
                for (int y = 0; y < size.y; ++y) {
                    const float row =
                        origin + static_cast<float>(y) * steps[1][c] + static_cast<float>(z) * steps[2][c];
                    for (int x = 0; x < size.x; ++x) *out++ = row + static_cast<float>(x) * steps[0][c];
                }
            }
        }
    }
    /// Sets the points with the indices begin … begin + count − 1 to a row that begins at the point `first` of the
    /// slice. `step` is the vector from each point to the next, in the function's coordinates.
    void setPointsInRow(std::size_t begin, const FieldSection& section, const glm::dvec3& first, const glm::vec4& step,
                        std::size_t count) {
        setPoint(begin, section, first);
        for (int c = 0; c < 4; ++c) {
            float* out = &coordinates[static_cast<std::size_t>(c)][begin];
            const float origin = *out;
            for (std::size_t k = 0; k < count; ++k) out[k] = origin + static_cast<float>(k) * step[c];
        }
    }
    /// Returns the first `size` points, as spans of the arrays of this object.
    fields::PointBatch batch(std::size_t size) const {
        const auto span = [&](std::size_t k) { return std::span(coordinates[k]).first(size); };
        return {span(0), span(1), span(2), span(3)};
    }
};

}  // namespace oval4d::slicing
