#include "geometry/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace oval4d::geometry {

namespace {

constexpr std::array<std::string_view, 6> kNames{"xy", "xz", "xw", "yz", "yw", "zw"};

// v = x i + y j + z k + w; GLM's quaternion constructor takes (w, x, y, z).
glm::dquat asQuaternion(const glm::dvec4& v) { return {v.w, v.x, v.y, v.z}; }
glm::dvec4 asVector(const glm::dquat& q) { return {q.x, q.y, q.z, q.w}; }

// Returns exp(u · angle). The imaginary unit u depends on the pair of perpendicular planes to which `plane` belongs: it
// is i for yz and xw, j for xz and yw, and k for xy and zw.
glm::dquat exponential(Plane plane, double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    switch (plane) {
        case Plane::xw:
        case Plane::yz:
            return {c, s, 0, 0};
        case Plane::xz:
        case Plane::yw:
            return {c, 0, s, 0};
        case Plane::xy:
        case Plane::zw:
            break;
    }
    return {c, 0, 0, s};
}

// Returns the unit quaternion q to the power `fraction`: exp(u θ) becomes exp(u θ · fraction), for θ from 0 to π.
glm::dquat powerOf(const glm::dquat& q, double fraction) {
    const glm::dvec3 imaginary(q.x, q.y, q.z);
    const double sine = glm::length(imaginary);
    if (sine == 0) return q;  // ±1; power() avoids −1, except for the rotation v ↦ −v, which has no unique power
    const double angle = std::atan2(sine, q.w) * fraction;
    return {std::cos(angle), imaginary * (std::sin(angle) / sine)};
}

bool containsW(Plane plane) { return plane == Plane::xw || plane == Plane::yw || plane == Plane::zw; }

}  // namespace

std::string_view name(Plane plane) { return kNames[static_cast<std::size_t>(plane)]; }

std::optional<Plane> planeNamed(std::string_view text) {
    for (const Plane plane : kPlanes) {
        if (name(plane) == text) return plane;
    }
    return std::nullopt;
}

Turn Turn::inverse() const { return scaled(-1); }

Turn Turn::scaled(double factor) const {
    Turn result{plane, alpha * factor, std::nullopt};
    if (beta) result.beta = *beta * factor;
    return result;
}

Rotation::Rotation(const glm::dquat& left, const glm::dquat& right)
    : left_(glm::normalize(left)), right_(glm::normalize(right)) {}

// Multiplication by exp(uθ) from the left rotates the plane of the other two imaginary units by θ, and the plane (w, u)
// by θ from w toward u; multiplication from the right rotates the first plane by −θ and the second by θ. So with the
// angle A in the plane without w (counted i→j, j→k, k→i) and the angle B from u toward w, the left angle is (A − B) / 2
// and the right angle −(A + B) / 2.
Rotation::Rotation(const Turn& turn) {
    double a = turn.alpha;
    double b = turn.beta.value_or(0);
    if (containsW(turn.plane)) std::swap(a, b);
    const Plane spatial = containsW(turn.plane) ? perpendicular(turn.plane) : turn.plane;
    if (spatial == Plane::xz) a = -a;  // R_xz turns x toward z, but the cycle is z → x
    left_ = exponential(spatial, (a - b) / 2);
    right_ = exponential(spatial, -(a + b) / 2);
}

std::optional<Rotation> Rotation::fromQuaternions(const glm::dquat& left, const glm::dquat& right) {
    const auto unit = [](const glm::dquat& q) { return std::abs(glm::length(q) - 1) < 1e-10; };  // also false for NaN
    if (!unit(left) || !unit(right)) return std::nullopt;
    Rotation found;
    found.left_ = left;
    found.right_ = right;
    return found;
}

// A simple rotation that takes a to b is v ↦ (m ā) v (ā m), where m = (a + b) / |a + b| is half way: a becomes
// m ā a ā m = m ā m, which is a reflected in m, that is b.
Rotation Rotation::between(const glm::dvec4& from, const glm::dvec4& to) {
    const glm::dquat a = asQuaternion(glm::normalize(from));
    const glm::dquat b = asQuaternion(glm::normalize(to));
    const glm::dquat sum = a + b;
    constexpr double kOpposite = 1e-8;  // the length of a + b below which its direction is lost to rounding
    glm::dquat middle = sum;
    if (glm::length(sum) < kOpposite) {
        // a·i is perpendicular to a, and half way between a and −a.
        middle = a * glm::dquat(0, 1, 0, 0);
    }
    middle = glm::normalize(middle);
    return {middle * glm::conjugate(a), glm::conjugate(a) * middle};
}

Rotation Rotation::inverse() const { return {glm::conjugate(left_), glm::conjugate(right_)}; }

// With the left angle λ and the right angle ρ, the rotation angles are λ + ρ and λ − ρ. (l, r) and (−l, −r) are the
// same rotation; the pair with the smaller angles is the one whose real parts have a sum that is not negative.
Rotation Rotation::power(double fraction) const {
    const double sign = left_.w + right_.w < 0 ? -1 : 1;
    return {powerOf(sign * left_, fraction), powerOf(sign * right_, fraction)};
}

double Rotation::angle() const {
    const auto halfAngle = [](const glm::dquat& q) { return std::atan2(glm::length(glm::dvec3(q.x, q.y, q.z)), q.w); };
    const double sum = halfAngle(left_) + halfAngle(right_);
    return std::min(sum, 2 * std::numbers::pi - sum);
}

glm::dvec4 Rotation::operator()(const glm::dvec4& v) const { return asVector(left_ * asQuaternion(v) * right_); }

glm::dmat4 Rotation::matrix() const {
    glm::dmat4 m;
    for (int axis = 0; axis < 4; ++axis) {
        glm::dvec4 unit(0);
        unit[axis] = 1;
        m[axis] = (*this)(unit);
    }
    return m;
}

// The sixteen maps v ↦ e_i·v·e_j form an orthogonal basis of the 4×4 matrices, each with the squared norm 4. In this
// basis a rotation has the coordinates l_i r_j, which form a matrix of rank one.
std::optional<Rotation> Rotation::fromMatrix(const glm::dmat4& matrix, double tolerance) {
    const std::array<glm::dquat, 4> units{glm::dquat(1, 0, 0, 0), glm::dquat(0, 1, 0, 0), glm::dquat(0, 0, 1, 0),
                                          glm::dquat(0, 0, 0, 1)};
    std::array<std::array<double, 4>, 4> product{};
    std::size_t row = 0;
    std::size_t column = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            const glm::dmat4 basis = Rotation(units[i], units[j]).matrix();
            for (int k = 0; k < 4; ++k) product[i][j] += glm::dot(matrix[k], basis[k]) / 4;
            if (std::abs(product[i][j]) > std::abs(product[row][column])) {
                row = i;
                column = j;
            }
        }
    }
    const auto quaternion = [](double w, double x, double y, double z) { return glm::dquat(w, x, y, z); };
    const glm::dquat left = quaternion(product[0][column], product[1][column], product[2][column], product[3][column]);
    const glm::dquat right = quaternion(product[row][0], product[row][1], product[row][2], product[row][3]);
    if (!(glm::length(left) > 0.1 && glm::length(right) > 0.1)) return std::nullopt;
    Rotation result(left, right);
    // l and r are each determined up to sign; the sign of the largest product l_i r_j fixes their relative sign.
    const auto component = [](const glm::dquat& q, std::size_t i) {
        return std::array<double, 4>{q.w, q.x, q.y, q.z}.at(i);
    };
    if (component(result.left_, row) * component(result.right_, column) * product[row][column] < 0) {
        result.right_ = -result.right_;
    }
    const glm::dmat4 made = result.matrix();
    for (int k = 0; k < 4; ++k) {
        for (int i = 0; i < 4; ++i) {
            if (!(std::abs(made[k][i] - matrix[k][i]) <= tolerance)) return std::nullopt;
        }
    }
    return result;
}

Rotation operator*(const Rotation& second, const Rotation& first) {
    return {second.left_ * first.left_, first.right_ * second.right_};
}

}  // namespace oval4d::geometry
