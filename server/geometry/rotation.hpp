#pragma once
// Rotations of 4-D space as pairs of unit quaternions.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

namespace oval4d::geometry {

/// A coordinate plane of 4-D space. The rotation R_ab in the plane ab turns the +a axis toward the +b axis. The
/// enumerators are in the order of the number keys 2 … 7 that select the planes. Stored sessions contain the numbers of
/// the enumerators, so these numbers must not change.
enum class Plane : std::uint8_t { xy = 0, xz = 1, xw = 2, yz = 3, yw = 4, zw = 5 };

inline constexpr std::array<Plane, 6> kPlanes{Plane::xy, Plane::xz, Plane::xw, Plane::yz, Plane::yw, Plane::zw};

/// Returns the plane of the two axes that are not in `plane`. The pairs are xy and zw, xz and yw, xw and yz.
constexpr Plane orthogonalComplement(Plane plane) { return static_cast<Plane>(5 - static_cast<int>(plane)); }

/// Returns the name of a plane, from "xy" to "zw".
std::string_view planeName(Plane plane);

/// Returns the plane with this name, or an empty optional if no plane has this name.
std::optional<Plane> planeNamed(std::string_view text);

/// A turn: a rotation that is described by angles in coordinate planes, in radians. The rotation turns in all these
/// planes at the same time. It is exp(Σ θ_ab G_ab), where θ_ab is the angle in the plane ab, and G_ab is the matrix for
/// which exp(θ G_ab) is the simple rotation R_ab(θ). Angles in two perpendicular planes give a double rotation. Angles
/// in planes that share an axis give a rotation in oblique planes.
class RotationAngles {
  public:
    /// Makes the turn that gives the identity: no plane has an angle.
    RotationAngles() = default;
    /// Makes the turn by `alpha` in `plane`: a simple rotation. If `beta` is given, the turn is the double rotation
    /// that also turns by `beta` in the perpendicular plane. The angles are in radians.
    RotationAngles(Plane plane, double alpha, std::optional<double> beta = {});

    /// Returns the angle in a plane, in radians. Returns an empty optional if the turn has no angle in this plane.
    const std::optional<double>& operator[](Plane plane) const { return angles_[static_cast<std::size_t>(plane)]; }
    std::optional<double>& operator[](Plane plane) { return angles_[static_cast<std::size_t>(plane)]; }

    /// Returns the planes that have an angle, in the order of kPlanes.
    std::vector<Plane> planes() const;
    /// Returns the turn that undoes this one.
    RotationAngles inverse() const;
    /// Returns the turn with all angles multiplied by `factor`.
    RotationAngles scaled(double factor) const;
    /// Returns the turn whose angle in each plane is the sum of the angles of a and b. In general, the sum is not the
    /// composition of the rotations a and b.
    friend RotationAngles operator+(const RotationAngles& a, const RotationAngles& b);
    bool operator==(const RotationAngles&) const = default;

  private:
    std::array<std::optional<double>, kPlanes.size()> angles_;
};

/// A rotation of 4-D space, stored as two unit quaternions l and r: it maps v to l·v·r, where the vector v is the
/// quaternion x i + y j + z k + w (Conway and Smith, On Quaternions and Octonions, ch. 4). The composition of two
/// rotations takes two quaternion products. Normalizing l and r keeps the map orthogonal in spite of rounding errors.
class Rotation {
  public:
    /// Makes the identity.
    Rotation() = default;
    /// Makes the rotation v ↦ left·v·right. Normalizes both quaternions, which must not be 0.
    Rotation(const glm::dquat& left, const glm::dquat& right);
    /// Makes the rotation exp(Σ θ_ab G_ab) that `turn` describes (see RotationAngles).
    explicit Rotation(const RotationAngles& turn);

    /// Returns the rotation with the matrix M (v' = M v), or an empty optional if M is not a rotation matrix. M counts
    /// as a rotation matrix if each of its entries differs by at most `tolerance` from the corresponding entry of the
    /// matrix of the returned rotation.
    static std::optional<Rotation> fromMatrix(const glm::dmat4& matrix, double tolerance = 1e-6);

    /// Returns the rotation with exactly these quaternions. Does not normalize the quaternions again, so that a stored
    /// rotation is restored bit by bit. Returns an empty optional if the length of a quaternion differs from 1 by 1e-10
    /// or more.
    static std::optional<Rotation> fromQuaternions(const glm::dquat& left, const glm::dquat& right);

    /// Returns the simple rotation by the smallest angle that takes the direction of `from` to the direction of `to`.
    /// If the directions are opposite, returns one of the many rotations by π that do this. Neither vector may be 0.
    static Rotation between(const glm::dvec4& from, const glm::dvec4& to);

    /// Returns the rotation that undoes this one.
    Rotation inverse() const;
    /// Returns this rotation with the angles in its two invariant planes multiplied by `fraction`: 0 gives the
    /// identity, and 1 gives this rotation. The angles that are multiplied are from −π to π. Exception: the invariant
    /// planes of the rotation v ↦ −v are not determined, so every `fraction`, even 0, gives v ↦ −v.
    Rotation power(double fraction) const;
    /// Returns the larger of the absolute values of the angles in the two invariant planes, in radians: from 0 to π.
    double largerAngle() const;
    /// Returns the turn with the smallest angles that gives this rotation. Where an angle would be 0 except for
    /// rounding errors, the turn has no angle, so the turn of the identity has no angles. For the rotation v ↦ −v,
    /// returns one of several turns.
    RotationAngles smallestAngles() const;
    /// Returns the image of v.
    glm::dvec4 operator()(const glm::dvec4& v) const;
    /// Returns the matrix M of this rotation, with v' = M v.
    glm::dmat4 matrix() const;

    const glm::dquat& leftQuaternion() const { return left_; }
    const glm::dquat& rightQuaternion() const { return right_; }
    bool operator==(const Rotation& other) const = default;

    /// Returns the composition: rotates by `first`, then by `second`. Normalizes the quaternions of the result, so that
    /// rounding errors do not accumulate over many products.
    friend Rotation operator*(const Rotation& second, const Rotation& first);

  private:
    glm::dquat left_{1, 0, 0, 0};
    glm::dquat right_{1, 0, 0, 0};
};

}  // namespace oval4d::geometry
