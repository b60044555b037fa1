#pragma once
// Frames of reference: linear maps of 4-D space whose axis w is time.

#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "geometry/range.hpp"
#include "serialization/stored_members.hpp"

namespace oval4d::geometry {

/// Returns the Galilean transformation r' = r − v w, w' = w, where r is (x, y, z) and v is `velocity`. An object with
/// the velocity v is at rest after this transformation. The unit of v is one unit of x, y and z per unit of w. The
/// determinant of the map is 1, and its inverse is galileanTransformation(−v).
glm::dmat4 galileanTransformation(const glm::dvec3& velocity);

/// Returns the Lorentz boost to the rest frame of an observer with the velocity v = `velocity` (Jackson, Classical
/// Electrodynamics, §11.3). The speed of light is 1, and |v| must be less than 1. The boost preserves the quantity
/// w² − x² − y² − z². The determinant of the boost is 1, and its inverse is lorentzBoost(−v).
glm::dmat4 lorentzBoost(const glm::dvec3& velocity);

/// A frame of reference for objects whose axis w is time. It applies three maps in this order: a Galilean
/// transformation, after which an object with the velocity `follow` is at rest; a scaling of w, which turns one unit of
/// time into `pace` units of length; and the Lorentz boost with the velocity `boost`. The default frame maps every
/// point to itself.
struct ReferenceFrame {
    static constexpr NumberRange kPaceRange{1e-3, 1e3};
    static constexpr NumberRange kFollowRange{-1000, 1000};  ///< the allowed range of each component of `follow`
    static constexpr double kMaxBoost = 0.999;               ///< the greatest allowed length of `boost`

    double pace = 1;
    glm::dvec3 follow{0};  ///< the velocity of objects that this frame shows at rest, in units of x, y and z per unit
                           ///< of w, before `pace` scales w
    glm::dvec3 boost{0};   ///< the velocity of the observer, as a fraction of the speed of light, which is 1 after
                           ///< `pace` has scaled w

    /// Returns the linear map M from the object's own coordinates to those of this frame. Its determinant is `pace`.
    glm::dmat4 matrix() const;
    /// Returns the inverse of matrix().
    glm::dmat4 inverse() const;
    bool operator==(const ReferenceFrame&) const = default;
};
void visitStoredMembers(serialization::ReadOrWritten<ReferenceFrame> auto& frame, auto& visit) {
    auto& [pace, follow, boost] = frame;
    visit.member(0, pace, ReferenceFrame::kPaceRange);
    visit.member(1, follow, ReferenceFrame::kFollowRange);
    visit.member(2, boost, NumberRange::ofAbsoluteValuesUpTo(ReferenceFrame::kMaxBoost));
}

/// Replaces each point p by map · p. Returns the largest distance of a new point from the origin.
double mapPoints(const glm::dmat4& map, std::vector<glm::dvec4>& points);

}  // namespace oval4d::geometry
