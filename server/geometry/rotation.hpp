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

/// A coordinate plane; R_ab turns the +a axis toward the +b axis. The order is the one of the number keys.
enum class Plane : std::uint8_t { xy, xz, xw, yz, yw, zw };

inline constexpr std::array<Plane, 6> kPlanes{Plane::xy, Plane::xz, Plane::xw, Plane::yz, Plane::yw, Plane::zw};

/// The absolutely perpendicular plane: xy·zw, xz·yw, xw·yz.
constexpr Plane perpendicular(Plane plane) { return static_cast<Plane>(5 - static_cast<int>(plane)); }

/// "xy" … "zw".
std::string_view name(Plane plane);
std::optional<Plane> planeNamed(std::string_view text);

/// What one key press or `rotate` message asks for: R_plane(alpha), times R_perpendicular(beta) where beta is given.
/// Angles in radians.
struct Turn {
    Plane plane = Plane::xy;
    double alpha = 0;
    std::optional<double> beta;

    Turn inverse() const;
    /// The same turn by `factor` times its angles.
    Turn scaled(double factor) const;
    bool operator==(const Turn&) const = default;
};

/// An element of SO(4): v ↦ l·v·r, where v = x i + y j + z k + w and l, r are unit quaternions
/// (Conway and Smith, On Quaternions and Octonions, ch. 4). Composition is two quaternion products, and
/// normalising l and r is all that keeps it orthogonal.
class Rotation {
  public:
    Rotation() = default;
    Rotation(const glm::dquat& left, const glm::dquat& right);
    explicit Rotation(const Turn& turn);

    /// The rotation with this matrix (v' = M v), or nothing if M is not in SO(4) to within `tolerance`.
    static std::optional<Rotation> fromMatrix(const glm::dmat4& matrix, double tolerance = 1e-6);

    /// The rotation of which `left` and `right` gave exactly these, or nothing if they are not of unit length.
    static std::optional<Rotation> fromQuaternions(const glm::dquat& left, const glm::dquat& right);

    Rotation inverse() const;
    glm::dvec4 operator()(const glm::dvec4& v) const;
    glm::dmat4 matrix() const;

    const glm::dquat& left() const { return left_; }
    const glm::dquat& right() const { return right_; }
    bool operator==(const Rotation& other) const = default;

    /// First `first`, then `second`; normalised, so that a million products do not drift.
    friend Rotation operator*(const Rotation& second, const Rotation& first);

  private:
    glm::dquat left_{1, 0, 0, 0};
    glm::dquat right_{1, 0, 0, 0};
};

}  // namespace oval4d::geometry
