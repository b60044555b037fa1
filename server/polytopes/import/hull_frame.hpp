#pragma once
// Normalized coordinates in which convex hulls are computed.

#include <span>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

namespace oval4d::polytopes {

/// A frame: an affine map that normalizes points to an extent of about 1 along each axis. Affine maps preserve convex
/// hulls. Therefore hulls that are computed in the frame do not depend on the position, scale and rotation of the
/// points, or on how flat the set of points is.
///
/// The frame also gives the noise of the points: how far rounding, floating-point errors and a perturbation may have
/// moved them.
class HullFrame {
  public:
    /// Fits the frame to the points. `rounding` is the maximum rounding error of a coordinate along each axis. Throws
    /// an ImportError if the points do not span four dimensions, or do so only due to the rounding.
    HullFrame(std::span<const glm::dvec4> points, const glm::dvec4& rounding);

    /// Returns the coordinates of a point in the frame.
    glm::dvec4 operator()(const glm::dvec4& point) const;

    /// Returns the largest distance by which a point may have been moved along `direction`, a unit vector. The distance
    /// and the direction are in the coordinates of the frame.
    double noise(const glm::dvec4& direction) const;

    /// Returns an upper bound of the noise along any direction.
    double largestNoise() const;

    /// Sets the amplitude of a random perturbation of each coordinate in the frame. The perturbation is part of the
    /// noise.
    void setPerturbation(double amplitude) { perturbation_ = amplitude; }

  private:
    glm::dvec4 origin_{0}, rounding_;
    glm::dmat4 axes_{0};        // orthonormal
    glm::dvec4 extents_{1};     // the extents of the points along the axes
    glm::dvec4 arithmetic_{0};  // the floating-point errors of coordinates in the frame
    double perturbation_ = 0;
};

}  // namespace oval4d::polytopes
