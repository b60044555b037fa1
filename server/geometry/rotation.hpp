#pragma once
// Rotations of 4-D space as pairs of unit quaternions.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

namespace oval4d::geometry {

/// A coordinate plane. The rotation R_ab turns the +a axis toward the +b axis. The order is that of the number keys.
enum class Plane : std::uint8_t { xy, xz, xw, yz, yw, zw };

inline constexpr std::array<Plane, 6> kPlanes{Plane::xy, Plane::xz, Plane::xw, Plane::yz, Plane::yw, Plane::zw};

/// Returns the absolutely perpendicular plane. The pairs are xy and zw, xz and yw, xw and yz.
constexpr Plane perpendicular(Plane plane) { return static_cast<Plane>(5 - static_cast<int>(plane)); }

/// Returns "xy" … "zw".
std::string_view name(Plane plane);

/// Returns the plane with this name, or nothing.
std::optional<Plane> planeNamed(std::string_view text);

/// A simple rotation R_plane(alpha), or a double rotation R_plane(alpha) · R_perpendicular(beta) if beta is given: the
/// rotation requested by one key press or `rotate` message. Angles are in radians.
struct Turn {
    Plane plane = Plane::xy;
    double alpha = 0;
    std::optional<double> beta;

    Turn inverse() const;
    /// Returns the turn with all angles multiplied by `factor`.
    Turn scaled(double factor) const;
    bool operator==(const Turn&) const = default;
};

/// An element of SO(4): v ↦ l·v·r, where v = x i + y j + z k + w and l, r are unit quaternions
/// (Conway and Smith, On Quaternions and Octonions, ch. 4). Composition takes two quaternion products; normalizing l
/// and r suffices to keep the map orthogonal.
class Rotation {
  public:
    Rotation() = default;
    Rotation(const glm::dquat& left, const glm::dquat& right);
    explicit Rotation(const Turn& turn);

    /// Returns the rotation with the matrix M (v' = M v), or nothing unless every entry of M is within `tolerance` of
    /// that of a matrix in SO(4).
    static std::optional<Rotation> fromMatrix(const glm::dmat4& matrix, double tolerance = 1e-6);

    /// Returns the rotation with exactly these quaternions, which are not normalized again, or nothing if they are not
    /// of unit length to within 1e-9.
    static std::optional<Rotation> fromQuaternions(const glm::dquat& left, const glm::dquat& right);

    Rotation inverse() const;
    glm::dvec4 operator()(const glm::dvec4& v) const;
    glm::dmat4 matrix() const;

    const glm::dquat& left() const { return left_; }
    const glm::dquat& right() const { return right_; }
    bool operator==(const Rotation& other) const = default;

    /// Returns the rotation by `first`, then `second`. The result is normalized, so that a million products do not
    /// drift.
    friend Rotation operator*(const Rotation& second, const Rotation& first);

  private:
    glm::dquat left_{1, 0, 0, 0};
    glm::dquat right_{1, 0, 0, 0};
};

}  // namespace oval4d::geometry
