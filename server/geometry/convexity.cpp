#include "geometry/convexity.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>

namespace oval4d::geometry {

namespace {

constexpr double kFlat = 1e-9;                  // of the circumradius
constexpr double kOnce = 3 * std::numbers::pi;  // between one full turn and two

glm::dvec4 without(const glm::dvec4& v, const glm::dvec4& unit) { return v - glm::dot(v, unit) * unit; }

glm::dvec4 mean(const std::vector<glm::dvec4>& points) {
    glm::dvec4 sum(0);
    for (const glm::dvec4& point : points) sum += point;
    return sum / static_cast<double>(points.size());
}

class ConvexityTest {
  public:
    explicit ConvexityTest(const Polytope& polytope) : p_(polytope) {
        for (const glm::dvec4& v : p_.vertices) middle_ += v;
        middle_ /= static_cast<double>(p_.vertices.size());
    }

    bool run() {
        return p_.convexFaces && isConnected() && findHyperplanes() && bendsInward() && cellsAreConvex() &&
               coversOnce();
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

    // The foot of the perpendicular from the middle onto each cell's hyperplane: none may be the middle itself.
    bool findHyperplanes() {
        for (std::size_t c = 0; c < p_.cellCount(); ++c) {
            points_.clear();
            for (const std::uint32_t f : p_.cells[c]) {
                for (const std::uint32_t v : p_.faces[f]) points_.push_back(p_.vertices[v] - middle_);
            }
            centres_.push_back(mean(points_));
            const auto foot = footOf(3);
            if (!foot) return false;
            feet_.push_back(*foot);
        }
        return true;
    }

    // The point nearest to the origin in the flat of this dimension through points_, which are used up; nothing where
    // they span less, or the origin lies in it.
    std::optional<glm::dvec4> footOf(int dimension) {
        glm::dvec4 foot = points_.front();
        for (glm::dvec4& point : points_) point -= foot;
        for (; dimension > 0; --dimension) {
            // The direction in which they reach farthest, taken away from all.
            const glm::dvec4 far = *std::max_element(
                points_.begin(), points_.end(),
                [](const glm::dvec4& a, const glm::dvec4& b) { return glm::dot(a, a) < glm::dot(b, b); });
            if (glm::length(far) <= kFlat * p_.circumradius) return {};
            const glm::dvec4 unit = glm::normalize(far);
            for (glm::dvec4& point : points_) point = without(point, unit);
            foot = without(foot, unit);
        }
        if (glm::length(foot) <= kFlat * p_.circumradius) return {};
        return foot;
    }

    // The same for each cell alone, in its own space: its 2-faces bend inward at every edge, and seen from its middle
    // those around a vertex make one full turn.
    bool cellsAreConvex() {
        std::vector<glm::dvec4> feet(p_.faces.size()), centres(p_.faces.size());
        std::vector<std::uint32_t> first(p_.edges.size());
        std::vector<bool> begun(p_.edges.size(), false);
        std::vector<double> turn(p_.vertices.size(), 0.0);
        for (std::size_t c = 0; c < p_.cellCount(); ++c) {
            const glm::dvec4 middle = middle_ + centres_[c];
            for (const std::uint32_t f : p_.cells[c]) {
                points_.clear();
                for (const std::uint32_t v : p_.faces[f]) points_.push_back(p_.vertices[v] - middle);
                centres[f] = mean(points_);
                const auto foot = footOf(2);
                if (!foot) return false;
                feet[f] = *foot;
                addTurns(p_.faces[f], middle, turn);
                for (const std::uint32_t e : p_.faceEdges[f]) {
                    if (begun[e] && (above(feet[f], centres[first[e]]) || above(feet[first[e]], centres[f])))
                        return false;
                    first[e] = f;
                    begun[e] = !begun[e];
                }
            }
            for (const std::uint32_t f : p_.cells[c]) {
                for (const std::uint32_t v : p_.faces[f]) {
                    if (turn[v] > kOnce) return false;
                    turn[v] = 0;
                }
            }
        }
        return true;
    }

    // By how much a 2-face turns about the axis from `middle` through each of its vertices.
    void addTurns(std::span<const std::uint32_t> loop, const glm::dvec4& middle, std::vector<double>& turn) const {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const glm::dvec4& at = p_.vertices[loop[i]];
            const glm::dvec4 axis = glm::normalize(at - middle);
            const glm::dvec4 a = without(p_.vertices[loop[(i + 1) % loop.size()]] - at, axis);
            const glm::dvec4 b = without(p_.vertices[loop[(i + loop.size() - 1) % loop.size()]] - at, axis);
            turn[loop[i]] += std::acos(std::clamp(glm::dot(a, b) / (glm::length(a) * glm::length(b)), -1.0, 1.0));
        }
    }

    bool above(const glm::dvec4& foot, const glm::dvec4& point) const {
        return glm::dot(point - foot, foot) > kFlat * p_.circumradius * glm::length(foot);
    }

    // Beside each of its 2-faces a cell has its neighbour on the side of the middle.
    bool bendsInward() const {
        return std::none_of(p_.faceCells.begin(), p_.faceCells.end(), [&](const auto& pair) {
            return above(feet_[pair[0]], centres_[pair[1]]) || above(feet_[pair[1]], centres_[pair[0]]);
        });
    }

    // Seen along an edge from the middle, the cells around it are sectors of a plane that make one full turn.
    bool coversOnce() const {
        const std::size_t edges = p_.edges.size();
        std::vector<double> turn(edges, 0.0), first(edges);
        std::vector<bool> begun(edges, false);
        std::vector<std::array<glm::dvec4, 2>> planes;
        for (const auto& [a, b] : p_.edges) {
            const auto plane = across(p_.vertices[a] - middle_, p_.vertices[b] - middle_);
            if (!plane) return false;
            planes.push_back(*plane);
        }
        for (std::size_t c = 0; c < p_.cellCount(); ++c) {
            for (const std::uint32_t f : p_.cells[c]) {
                glm::dvec4 centre(0);
                for (const std::uint32_t v : p_.faces[f]) centre += p_.vertices[v] - middle_;
                for (const std::uint32_t e : p_.faceEdges[f]) {
                    const double angle = std::atan2(glm::dot(centre, planes[e][1]), glm::dot(centre, planes[e][0]));
                    if (begun[e]) {
                        const double between = std::abs(angle - first[e]);
                        turn[e] += std::min(between, 2 * std::numbers::pi - between);
                    }
                    first[e] = angle;
                    begun[e] = !begun[e];
                }
            }
        }
        return std::all_of(turn.begin(), turn.end(), [](double t) { return t < kOnce; });
    }

    // Two unit vectors that span the plane perpendicular to a and b, unless these are parallel.
    static std::optional<std::array<glm::dvec4, 2>> across(const glm::dvec4& a, const glm::dvec4& b) {
        const double length = glm::length(a);
        if (!(length > 0)) return {};
        const glm::dvec4 u = a / length;
        glm::dvec4 v = without(b, u);
        if (glm::length(v) <= kFlat * length) return {};
        v = glm::normalize(v);
        std::array<glm::dvec4, 2> plane{};
        for (glm::dvec4& found : plane) {
            // Of the axes, the one with the most left.
            double most = 0;
            for (int axis = 0; axis < 4; ++axis) {
                glm::dvec4 rest(0);
                rest[axis] = 1;
                rest = without(without(rest, u), v);
                if (&found == &plane[1]) rest = without(rest, plane[0]);
                if (const double left = glm::length(rest); left > most) {
                    most = left;
                    found = rest / left;
                }
            }
        }
        return plane;
    }

    const Polytope& p_;
    glm::dvec4 middle_{0};
    std::vector<glm::dvec4> centres_, feet_;  // of the cells, from the middle
    std::vector<glm::dvec4> points_;
};

}  // namespace

bool isConvex(const Polytope& polytope) { return ConvexityTest(polytope).run(); }

}  // namespace oval4d::geometry
