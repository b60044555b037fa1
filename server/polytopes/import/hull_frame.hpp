#pragma once
// Normalized coordinates in which convex hulls are computed.

#include <span>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

namespace oval4d::polytopes {

/// An affine map to coordinates in which a set of points has an extent of about 1 along each axis. Affine maps preserve
/// convex hulls, so a hull can be computed in these coordinates. The result then does not depend on where the points
/// lie, or on how large, rotated or flat the set of points is.
///
/// The frame also bounds the errors of the points, that is, how far the points may have been moved by the rounding of
/// their coordinates, by floating-point errors and by a random perturbation.
class HullFrame {
  public:
    /// Fits the frame to the points, of which there must be at least one. `rounding` is the maximum rounding error of a
    /// coordinate along each axis. Throws a FileError if the points do not span four dimensions, or if they may span
    /// four dimensions only because of rounding errors.
    HullFrame(std::span<const glm::dvec4> points, const glm::dvec4& rounding);

    /// Converts a point to the coordinates of the frame.
    glm::dvec4 operator()(const glm::dvec4& point) const;

    /// Returns the maximum distance by which errors may have moved a point along the unit vector `direction`. The
    /// distance and the direction are in the coordinates of the frame.
    double errorBound(const glm::dvec4& direction) const;

    /// Returns an upper bound of errorBound() for all directions.
    double largestErrorBound() const;

    /// Makes the error bounds include a random perturbation of the points by at most `amplitude` along each axis of the
    /// frame. Replaces an earlier amplitude. Does not perturb the points.
    void allowForPerturbation(double amplitude) { perturbation_ = amplitude; }

  private:
    glm::dvec4 origin_{0}, rounding_;
    glm::dmat4 axes_{0};        // the axes of the frame: orthonormal vectors
    glm::dvec4 extents_{1};     // the extents of the points along the axes
    glm::dvec4 arithmetic_{0};  // per axis: the maximum floating-point error of a coordinate
    double perturbation_ = 0;
};

}  // namespace oval4d::polytopes
