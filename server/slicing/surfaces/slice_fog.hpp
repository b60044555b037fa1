#pragma once
// The fog in one slice of a field: values of the field on a lattice, which a picture shows as opacity and color.

#include <cstdint>
#include <vector>

#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include "fields/scalar_function.hpp"
#include "slicing/surfaces/field_section.hpp"

namespace oval4d::slicing {

/// The fog in one slice: the values of a field at the points min + step · (i, j, k) of a lattice, as bytes.
struct SliceFog {
    /// The maximum number of lattice points along each axis.
    static constexpr int kMaxPoints = 128;

    glm::ivec3 size{0};  ///< the number of lattice points along x, y and z; 0 if there is no fog
    glm::dvec3 min{0};   ///< the lattice point with i = j = k = 0, in the units of the object
    double step = 1;     ///< the distance between neighboring points, in the units of the object
    std::vector<FieldSection::HalfSpace> walls;  ///< the fog is in the intersection of these half-spaces
    /// One byte per lattice point; x varies fastest. 0 means that the field has no value at the point. 1 … 255 mean
    /// values from the least to the greatest in even steps (see sampleFog()).
    std::vector<std::uint8_t> values;

    bool empty() const { return values.empty(); }
    void clear() {
        size = glm::ivec3(0);
        walls.clear();
        values.clear();
    }
};

/// Returns the number of points along x, y and z of a lattice that covers the box from `min` to `max`. The coordinates
/// of lattice points are multiples of `step`. On each side, at most one layer of points lies outside the box.
glm::ivec3 fogLatticeSize(const glm::dvec3& min, const glm::dvec3& max, double step);

/// Samples a function on a lattice in a section. The coordinates of lattice points are multiples of the step, so that
/// the lattice stays in place while an object turns. Enlarges `step` if necessary, so that no axis has more than
/// SliceFog::kMaxPoints points. The value `least` and all lower values become the byte 1; `greatest`, which must be
/// greater than `least`, and all higher values become the byte 255. Overwrites `out`, which is empty if the section
/// does not meet the domain.
void sampleFog(const fields::ScalarFunction& function, const FieldSection& section, double least, double greatest,
               double step, SliceFog& out);

}  // namespace oval4d::slicing
