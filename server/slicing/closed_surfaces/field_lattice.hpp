#pragma once
// The lattice on which ClosedSurfaceSlicer, which extracts closed surfaces from the slices of a field, samples the
// field.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/gtc/type_precision.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "fields/field.hpp"
#include "geometry/rotation.hpp"

namespace oval4d::slicing {

/// A regular 4-D lattice of points that fills the domain of a field. If the field is an array, its samples are the
/// lattice points; along an axis with one sample, there are two lattice points with the same value. Positions of points
/// are coordinates after the rotation of the object.
class FieldLattice {
  public:
    /// Makes the lattice of `field`, rotated by `orientation`. For a formula, the lattice has `cells` cells along the
    /// longest side of the domain. Along each other side, it has cells of about the same length, but at least kMinCells
    /// of them. For an array, `cells` is ignored. `field` must outlive this object.
    FieldLattice(const fields::Field& field, const geometry::Rotation& orientation, int cells);
    static constexpr int kMinCells = 4;

    /// Returns the number of points along each axis, at least 2.
    glm::ivec4 pointCounts() const { return pointCounts_; }
    /// Returns a number less than 2⁴⁶ that identifies the lattice point with these indices along the axes.
    std::uint64_t index(glm::ivec4 point) const {
        const glm::u64vec4 p(point), n(pointCounts_);
        return p.x + n.x * (p.y + n.y * (p.z + n.z * p.w));
    }
    /// Returns the coordinates of a lattice point, in the rotated object: the sum of positionTerm() over the four axes.
    glm::dvec4 position(glm::ivec4 point) const {
        return (positionTerm(0, point.x) + positionTerm(1, point.y)) +
               (positionTerm(2, point.z) + positionTerm(3, point.w));
    }
    /// Returns the term that the index of a lattice point along `axis` adds to the coordinates of the point. The term
    /// of axis 0 also contains the center of the domain.
    glm::dvec4 positionTerm(std::size_t axis, int index) const {
        const double fraction = static_cast<double>(index) / (pointCounts_[static_cast<int>(axis)] - 1);
        const glm::dvec4 term = (fraction - 0.5) * sides_[axis];
        return axis == 0 ? term + shift_ : term;
    }
    /// Returns the gradient of a linear function, in the coordinates of the rotated object. Entry a of `rises` says how
    /// much the function rises from one lattice point to the next along axis a.
    glm::dvec4 gradientOf(const std::array<double, 4>& rises) const {
        return fromRises_ * glm::dvec4(rises[0], rises[1], rises[2], rises[3]);
    }
    /// Returns whether the axes of the lattice are a positively oriented basis in the coordinates of the rotated
    /// object.
    bool isPositivelyOriented() const { return positive_; }

    /// Returns bounds of the function's values at the lattice points in the box from `first` to `last`, both included.
    fields::ValueBounds valueBounds(glm::ivec4 first, glm::ivec4 last) const;
    /// Writes to `values` the samples at the lattice points in the box from `first` to `last`, both included; x varies
    /// fastest. `values` must have room for all of them. A formula may be infinite at a pole, such as 1/(x²+y²+z²+w²)
    /// at the origin. There, the sample is the finite float of the greatest magnitude with the same sign, so that it is
    /// above or below all levels. In an array, an infinite sample stands for a missing value, and remains infinite.
    void sample(glm::ivec4 first, glm::ivec4 last, std::span<float> values) const;
    /// Returns the sample at a lattice point.
    float sample(glm::ivec4 point) const;

  private:
    const fields::Field& field_;
    glm::ivec4 pointCounts_{2};
    std::array<glm::dvec4, 4> sides_{};  // the side vectors of the domain, in the coordinates of the rotated object
    glm::dvec4 shift_{0};                // the center of the domain, in the coordinates of the rotated object
    // coordinates_[axis][i]: the coordinate along `axis`, as the function takes it, of the lattice points with the
    // index i
    std::array<std::vector<double>, 4> coordinates_;
    glm::dmat4 fromRises_{1};  // maps differences of values along the lattice axes to a gradient (see gradientOf())
    bool positive_ = true;
};

}  // namespace oval4d::slicing
