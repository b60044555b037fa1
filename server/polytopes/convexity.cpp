#include "polytopes/convexity.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>

namespace oval4d::polytopes {

namespace {

constexpr double kTolerance = 1e-9;  // the tolerance of distances, relative to maxDistanceFromMean()
// The angles around an edge or a vertex add up to 2π · n for an integer n ≥ 1, up to rounding. A sum below
// kMaxTurn, in radians, means n = 1, one full turn.
constexpr double kMaxTurn = 3 * std::numbers::pi;

// Returns the component of v perpendicular to a unit vector.
glm::dvec4 rejection(const glm::dvec4& v, const glm::dvec4& unit) { return v - glm::dot(v, unit) * unit; }

glm::dvec4 mean(const std::vector<glm::dvec4>& points) {
    glm::dvec4 sum(0);
    for (const glm::dvec4& point : points) sum += point;
    return sum / static_cast<double>(points.size());
}

class ConvexityTest {
  public:
    explicit ConvexityTest(const Polytope& polytope) : p_(polytope), extent_(maxDistanceFromMean(polytope)) {
        for (const glm::dvec4& v : p_.vertices) center_ += v;
        center_ /= static_cast<double>(p_.vertices.size());
    }

    bool isConvex() {
        return p_.convexFaces && isConnected() && findHyperplanes() && isLocallyConvex() && cellsAreConvex() &&
               surroundsEdgesOnce();
    }

  private:
    bool isConnected() const {
        std::vector<bool> reached(p_.cellCount());
        std::vector<std::uint32_t> waiting{0};
        reached[0] = true;
        std::size_t count = 0;
        while (!waiting.empty()) {
            const std::uint32_t cell = waiting.back();
            waiting.pop_back();
            ++count;
            for (const std::uint32_t f : p_.cells[cell]) {
                for (const std::uint32_t next : p_.faceCells[f]) {
                    if (!reached[next]) waiting.push_back(next);
                    reached[next] = true;
                }
            }
        }
        return count == p_.cellCount();
    }

    // Finds the foot of the perpendicular from center_ to each cell's hyperplane. Returns false if the points of a cell
    // do not span a hyperplane, or if the hyperplane of a cell contains center_.
    bool findHyperplanes() {
        for (std::size_t c = 0; c < p_.cellCount(); ++c) {
            points_.clear();
            for (const std::uint32_t f : p_.cells[c]) {
                for (const std::uint32_t v : p_.faces[f]) points_.push_back(p_.vertices[v] - center_);
            }
            centers_.push_back(mean(points_));
            const auto foot = footOfPerpendicular(3);
            if (!foot) return false;
            feet_.push_back(*foot);
        }
        return true;
    }

    // Returns the foot: the point nearest to the origin in the flat (affine subspace) through points_. `dimension`
    // is the dimension of this flat. Returns an empty optional if the points span only a flat of lower dimension,
    // or if the flat contains the origin. Overwrites points_.
    std::optional<glm::dvec4> footOfPerpendicular(int dimension) {
        glm::dvec4 foot = points_.front();
        for (glm::dvec4& point : points_) point -= foot;
        for (; dimension > 0; --dimension) {
            // Take the direction of the longest vector in points_, and remove the components in this direction from all
            // vectors in points_ and from the foot.
            const glm::dvec4 far = *std::max_element(
                points_.begin(), points_.end(),
                [](const glm::dvec4& a, const glm::dvec4& b) { return glm::dot(a, a) < glm::dot(b, b); });
            if (glm::length(far) <= kTolerance * extent_) return {};
            const glm::dvec4 unit = glm::normalize(far);
            for (glm::dvec4& point : points_) point = rejection(point, unit);
            foot = rejection(foot, unit);
        }
        if (glm::length(foot) <= kTolerance * extent_) return {};
        return foot;
    }

    // Returns whether each cell is convex. A cell is convex if none of its edges is reentrant, and if the 2-faces
    // around each vertex make one full turn about an axis. This axis leads from the mean of the cell's corners to the
    // vertex.
    bool cellsAreConvex() {
        std::vector<glm::dvec4> feet(p_.faces.size()), centers(p_.faces.size());
        std::vector<std::uint32_t> first(p_.edges.size());
        std::vector<bool> begun(p_.edges.size(), false);
        std::vector<double> turn(p_.vertices.size(), 0.0);
        for (std::size_t c = 0; c < p_.cellCount(); ++c) {
            const glm::dvec4 middle = center_ + centers_[c];
            for (const std::uint32_t f : p_.cells[c]) {
                points_.clear();
                for (const std::uint32_t v : p_.faces[f]) points_.push_back(p_.vertices[v] - middle);
                centers[f] = mean(points_);
                const auto foot = footOfPerpendicular(2);
                if (!foot) return false;
                feet[f] = *foot;
                addVertexAngles(p_.faces[f], middle, turn);
                for (const std::uint32_t e : p_.faceEdges[f]) {
                    if (begun[e] &&
                        (isBeyondFlat(feet[f], centers[first[e]]) || isBeyondFlat(feet[first[e]], centers[f])))
                        return false;
                    first[e] = f;
                    begun[e] = !begun[e];
                }
            }
            for (const std::uint32_t f : p_.cells[c]) {
                for (const std::uint32_t v : p_.faces[f]) {
                    if (turn[v] > kMaxTurn) return false;
                    turn[v] = 0;
                }
            }
        }
        return true;
    }

    // Adds to `turn`, for each vertex of a 2-face, the angle in radians that the 2-face spans around the axis from
    // `middle` to the vertex.
    void addVertexAngles(std::span<const std::uint32_t> loop, const glm::dvec4& middle,
                         std::vector<double>& turn) const {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const glm::dvec4& at = p_.vertices[loop[i]];
            const glm::dvec4 axis = glm::normalize(at - middle);
            const glm::dvec4 a = rejection(p_.vertices[loop[(i + 1) % loop.size()]] - at, axis);
            const glm::dvec4 b = rejection(p_.vertices[loop[(i + loop.size() - 1) % loop.size()]] - at, axis);
            turn[loop[i]] += std::acos(std::clamp(glm::dot(a, b) / (glm::length(a) * glm::length(b)), -1.0, 1.0));
        }
    }

    // Returns whether a flat separates `point` from the origin. `foot` is the point of the flat that is nearest to
    // the origin.
    bool isBeyondFlat(const glm::dvec4& foot, const glm::dvec4& point) const {
        return glm::dot(point - foot, foot) > kTolerance * extent_ * glm::length(foot);
    }

    // Returns whether no 2-face is reentrant: at each 2-face, the center of each of the two cells must lie on the inner
    // side of the hyperplane of the other cell, or in this hyperplane.
    bool isLocallyConvex() const {
        return std::none_of(p_.faceCells.begin(), p_.faceCells.end(), [&](const auto& pair) {
            return isBeyondFlat(feet_[pair[0]], centers_[pair[1]]) || isBeyondFlat(feet_[pair[1]], centers_[pair[0]]);
        });
    }

    // Returns whether the cells around every edge make one full turn. The test projects these cells onto the plane that
    // is perpendicular to the vectors from center_ to the ends of the edge. The projection of a cell fills a sector
    // between the projections of its two 2-faces at the edge. The angles of the sectors must add up to 2π.
    bool surroundsEdgesOnce() const {
        const std::size_t edges = p_.edges.size();
        std::vector<double> turn(edges, 0.0), first(edges);
        std::vector<bool> begun(edges, false);
        std::vector<std::array<glm::dvec4, 2>> planes;
        for (const auto& [a, b] : p_.edges) {
            const auto plane = orthogonalPlane(p_.vertices[a] - center_, p_.vertices[b] - center_);
            if (!plane) return false;
            planes.push_back(*plane);
        }
        for (std::size_t c = 0; c < p_.cellCount(); ++c) {
            for (const std::uint32_t f : p_.cells[c]) {
                glm::dvec4 center(0);
                for (const std::uint32_t v : p_.faces[f]) center += p_.vertices[v] - center_;
                for (const std::uint32_t e : p_.faceEdges[f]) {
                    const double angle = std::atan2(glm::dot(center, planes[e][1]), glm::dot(center, planes[e][0]));
                    if (begun[e]) {
                        const double between = std::abs(angle - first[e]);
                        turn[e] += std::min(between, 2 * std::numbers::pi - between);
                    }
                    first[e] = angle;
                    begun[e] = !begun[e];
                }
            }
        }
        return std::all_of(turn.begin(), turn.end(), [](double t) { return t < kMaxTurn; });
    }

    // Returns an orthonormal basis of the plane perpendicular to a and b, or an empty optional if a and b are parallel
    // or a is 0.
    static std::optional<std::array<glm::dvec4, 2>> orthogonalPlane(const glm::dvec4& a, const glm::dvec4& b) {
        const double length = glm::length(a);
        if (!(length > 0)) return {};
        const glm::dvec4 u = a / length;
        glm::dvec4 v = rejection(b, u);
        if (glm::length(v) <= kTolerance * length) return {};
        v = glm::normalize(v);
        std::array<glm::dvec4, 2> plane{};
        for (glm::dvec4& found : plane) {
            // Subtract from each coordinate axis its components along a, b and the vectors already found. The
            // longest of the four remainders is the most accurate new vector.
            double most = 0;
            for (int axis = 0; axis < 4; ++axis) {
                glm::dvec4 rest(0);
                rest[axis] = 1;
                rest = rejection(rejection(rest, u), v);
                if (&found == &plane[1]) rest = rejection(rest, plane[0]);
                if (const double left = glm::length(rest); left > most) {
                    most = left;
                    found = rest / left;
                }
            }
        }
        return plane;
    }

    const Polytope& p_;
    double extent_;
    glm::dvec4 center_{0};                    // the mean of the vertices
    std::vector<glm::dvec4> centers_, feet_;  // per cell, relative to center_: the mean of its corners, and the foot of
                                              // the perpendicular (see findHyperplanes())
    std::vector<glm::dvec4> points_;
};

}  // namespace

bool isConvex(const Polytope& polytope) { return ConvexityTest(polytope).isConvex(); }

}  // namespace oval4d::polytopes
