#include "geometry/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace oval4d::geometry {

namespace {

constexpr std::array<std::string_view, 6> kNames{"xy", "xz", "xw", "yz", "yw", "zw"};

// The quaternion of the vector (x, y, z, w) is x i + y j + z k + w. GLM's quaternion constructor takes (w, x, y, z).
glm::dquat asQuaternion(const glm::dvec4& v) { return {v.w, v.x, v.y, v.z}; }
glm::dvec4 asVector(const glm::dquat& q) { return {q.x, q.y, q.z, q.w}; }

// A pair of perpendicular planes: one without the w axis, and one with it. kPairs has one pair for each of the
// imaginary units i, j and k, which are the directions of the axes x, y and z. The plane with w contains this axis; the
// spatial plane contains the other two. The `sign` of the pair xz, yw is −1: a rotation in xz turns x toward z, but
// multiplication by exp(jθ) from the left turns z (k) toward x (i), by the cycle i → j → k → i.
struct PlanePair {
    Plane spatial, withW;
    double sign;
};
constexpr std::array<PlanePair, 3> kPairs{
    {{Plane::yz, Plane::xw, 1}, {Plane::xz, Plane::yw, -1}, {Plane::xy, Plane::zw, 1}}};

// Returns exp(v), where the vector v is the quaternion v.x i + v.y j + v.z k.
glm::dquat exponential(const glm::dvec3& v) {
    const double angle = glm::length(v);
    if (angle == 0) return {1, 0, 0, 0};
    return {std::cos(angle), v * (std::sin(angle) / angle)};
}

// Returns the shortest v with exp(v) = q, for a unit quaternion q. For q = −1, returns (π, 0, 0).
glm::dvec3 logarithm(const glm::dquat& q) {
    const glm::dvec3 imaginary(q.x, q.y, q.z);
    const double sine = glm::length(imaginary);
    if (sine == 0) return {q.w < 0 ? std::numbers::pi : 0, 0, 0};
    return imaginary * (std::atan2(sine, q.w) / sine);
}

// Returns the unit quaternion q to the power `fraction`: exp(u θ) becomes exp(u θ · fraction), for an imaginary unit u
// and θ from 0 to π.
glm::dquat powerOf(const glm::dquat& q, double fraction) {
    const glm::dvec3 imaginary(q.x, q.y, q.z);
    const double sine = glm::length(imaginary);
    if (sine == 0) return q;  // q is 1 or −1; q = −1 occurs for v ↦ −v, of which power() returns v ↦ −v itself
    const double angle = std::atan2(sine, q.w) * fraction;
    return {std::cos(angle), imaginary * (std::sin(angle) / sine)};
}

}  // namespace

std::string_view planeName(Plane plane) { return kNames[static_cast<std::size_t>(plane)]; }

std::optional<Plane> planeNamed(std::string_view text) {
    for (const Plane plane : kPlanes) {
        if (planeName(plane) == text) return plane;
    }
    return std::nullopt;
}

RotationAngles::RotationAngles(Plane plane, double alpha, std::optional<double> beta) {
    (*this)[plane] = alpha;
    (*this)[orthogonalComplement(plane)] = beta;
}

std::vector<Plane> RotationAngles::planes() const {
    std::vector<Plane> named;
    for (const Plane plane : kPlanes) {
        if ((*this)[plane]) named.push_back(plane);
    }
    return named;
}

RotationAngles RotationAngles::inverse() const { return scaled(-1); }

RotationAngles RotationAngles::scaled(double factor) const {
    RotationAngles result = *this;
    for (auto& angle : result.angles_) {
        if (angle) *angle *= factor;
    }
    return result;
}

RotationAngles operator+(const RotationAngles& a, const RotationAngles& b) {
    RotationAngles sum = a;
    for (const Plane plane : b.planes()) sum[plane] = a[plane].value_or(0) + *b[plane];
    return sum;
}

Rotation::Rotation(const glm::dquat& left, const glm::dquat& right)
    : left_(glm::normalize(left)), right_(glm::normalize(right)) {}

// Let u be one of the imaginary units i, j and k. Multiplication by exp(uθ) from the left rotates the plane of the
// other two imaginary units by θ, and the plane (w, u) by θ from w toward u. Multiplication by exp(uθ) from the right
// rotates the plane of the other two units by −θ, and the plane (w, u) by θ.
//
// A rotation by A in the plane of the other two units (from i toward j, from j toward k, or from k toward i) and by B
// from u toward w is the product of both multiplications, with θ = (A − B) / 2 on the left and θ = −(A + B) / 2 on the
// right. Multiplications from the left commute with those from the right. Therefore the rotation of the whole turn is
// v ↦ l·v·r. The logarithm of l is the sum of u θ over the three units u, with the θ on the left; the logarithm of r is
// this sum with the θ on the right.
Rotation::Rotation(const RotationAngles& turn) {
    glm::dvec3 left(0), right(0);
    for (int u = 0; u < 3; ++u) {
        const PlanePair& pair = kPairs.at(static_cast<std::size_t>(u));
        const double a = pair.sign * turn[pair.spatial].value_or(0), b = turn[pair.withW].value_or(0);
        left[u] = (a - b) / 2;
        right[u] = -(a + b) / 2;
    }
    left_ = exponential(left);
    right_ = exponential(right);
}

RotationAngles Rotation::smallestAngles() const {
    // The quaternions (−l, −r) give the same rotation as (l, r). `sign` is −1 if (−l, −r) give smaller angles.
    const double sign = left_.w + right_.w < 0 ? -1 : 1;
    const glm::dvec3 left = logarithm(sign * left_), right = logarithm(sign * right_);
    constexpr double kRounding = 1e-12;
    RotationAngles result;
    const auto set = [&](Plane plane, double angle) {
        if (std::abs(angle) > kRounding) result[plane] = angle;
    };
    for (int u = 0; u < 3; ++u) {
        const PlanePair& pair = kPairs.at(static_cast<std::size_t>(u));
        set(pair.spatial, pair.sign * (left[u] - right[u]));
        set(pair.withW, -(left[u] + right[u]));
    }
    return result;
}

std::optional<Rotation> Rotation::fromQuaternions(const glm::dquat& left, const glm::dquat& right) {
    const auto unit = [](const glm::dquat& q) { return std::abs(glm::length(q) - 1) < 1e-10; };  // false for NaN, too
    if (!unit(left) || !unit(right)) return std::nullopt;
    Rotation found;
    found.left_ = left;
    found.right_ = right;
    return found;
}

// A simple rotation that takes the unit vector a to the unit vector b is v ↦ (m ā) v (ā m). Here, ā is the conjugate of
// a, and m = (a + b) / |a + b| is half way between a and b. This rotation takes a to m ā a ā m = m ā m, the reflection
// of a in the line through 0 and m. This reflection is b.
Rotation Rotation::between(const glm::dvec4& from, const glm::dvec4& to) {
    const glm::dquat a = asQuaternion(glm::normalize(from));
    const glm::dquat b = asQuaternion(glm::normalize(to));
    const glm::dquat sum = a + b;
    constexpr double kOpposite = 1e-8;  // if a + b is shorter than this, rounding errors determine its direction
    glm::dquat middle = sum;
    if (glm::length(sum) < kOpposite) {
        // a·i is perpendicular to a, and half way between a and −a.
        middle = a * glm::dquat(0, 1, 0, 0);
    }
    middle = glm::normalize(middle);
    return {middle * glm::conjugate(a), glm::conjugate(a) * middle};
}

Rotation Rotation::inverse() const { return {glm::conjugate(left_), glm::conjugate(right_)}; }

// Let l = exp(u λ) and r = exp(u' ρ) for imaginary unit quaternions u and u'. The angles of the rotation in its two
// invariant planes are λ + ρ and λ − ρ. The pairs (l, r) and (−l, −r) give the same rotation; the pair with l.w + r.w ≥
// 0 has the smaller angles.
Rotation Rotation::power(double fraction) const {
    const double sign = left_.w + right_.w < 0 ? -1 : 1;
    return {powerOf(sign * left_, fraction), powerOf(sign * right_, fraction)};
}

double Rotation::largerAngle() const {
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

// The sixteen maps v ↦ e_i·v·e_j, where e_0 … e_3 are 1, i, j and k, form an orthogonal basis of the 4×4 matrices, each
// with the squared norm 4. In this basis, the rotation v ↦ l·v·r has the coordinates l_i r_j, which form a matrix of
// rank one. Therefore a column of this matrix is a multiple of l, and a row is a multiple of r.
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
