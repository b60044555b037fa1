#pragma once
// Normalized coordinates in which convex hulls are computed.

#include <span>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

namespace oval4d::polytopes {

/// An affine map that normalizes points to an extent of about 1 along each axis. Affine maps preserve convex hulls, so
/// hulls computed in the frame do not depend on translation, scale, rotation or flattening of the points.
///
/// The frame also knows the noise of the points: how far rounding may have moved them.
class HullFrame {
  public:
    /// `rounding` is the maximum rounding error of a coordinate along each axis. Throws an ImportError if the points,
    /// within the rounding, do not span four dimensions.
    HullFrame(std::span<const glm::dvec4> points, const glm::dvec4& rounding);

    /// Maps a point into the frame.
    glm::dvec4 operator()(const glm::dvec4& point) const;

    /// Returns the largest distance by which rounding may have moved a point, in the frame, along a unit vector of the
    /// frame.
    double noise(const glm::dvec4& direction) const;

    /// Returns an upper bound of the noise along all directions.
    double largestNoise() const;

    /// Adds to the noise a random perturbation, in the frame, of each coordinate by up to `amplitude`.
    void setPerturbation(double amplitude) { perturbation_ = amplitude; }

  private:
    glm::dvec4 origin_{0}, rounding_;
    glm::dmat4 axes_{0};        // orthonormal
    glm::dvec4 extents_{1};     // of the points along the axes
    glm::dvec4 arithmetic_{0};  // floating-point errors of coordinates in the frame
    double perturbation_ = 0;
};

}  // namespace oval4d::polytopes
