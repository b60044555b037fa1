#include "polytopes/import/convex_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

namespace oval4d::polytopes {

namespace {

constexpr double kErrorBounds = 2;  // the tolerance of a distance, in error bounds: one for the point and one for the
                                    // hull
constexpr int kMaxIterations = 64;  // the maximum number of iterations; usually, a few suffice

// A vertex of the simplex that Wolfe's method has reached, and the weight of the vertex. The point of the simplex
// nearest to the origin is the weighted sum of the vertices; the weights are its barycentric coordinates.
struct WeightedVertex {
    glm::dvec4 position;
    double weight;
};

// Finds the point nearest to the origin in the affine hull of the vertices, and writes its barycentric coordinates to
// `weights`. Returns false if the vertices are affinely dependent.
bool weightsOfPointNearestOrigin(const std::vector<WeightedVertex>& vertices, std::array<double, 5>& weights) {
    const std::size_t n = vertices.size() - 1;
    std::array<std::array<double, 5>, 4> rows{};  // the matrix and the right side of the normal equations
    const glm::dvec4& base = vertices[0].position;
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec4 a = vertices[i + 1].position - base;
        for (std::size_t j = 0; j < n; ++j) rows.at(i).at(j) = glm::dot(a, vertices[j + 1].position - base);
        rows.at(i).at(n) = -glm::dot(a, base);
    }
    for (std::size_t i = 0; i < n; ++i) {
        std::size_t pivot = i;
        for (std::size_t k = i + 1; k < n; ++k) {
            if (std::abs(rows.at(k).at(i)) > std::abs(rows.at(pivot).at(i))) pivot = k;
        }
        if (!(std::abs(rows.at(pivot).at(i)) > 0)) return false;
        std::swap(rows.at(i), rows.at(pivot));
        for (std::size_t k = 0; k < n; ++k) {
            if (k == i) continue;
            const double factor = rows.at(k).at(i) / rows.at(i).at(i);
            for (std::size_t j = i; j <= n; ++j) rows.at(k).at(j) -= factor * rows.at(i).at(j);
        }
    }
    weights[0] = 1;
    for (std::size_t i = 0; i < n; ++i) {
        weights.at(i + 1) = rows.at(i).at(n) / rows.at(i).at(i);
        weights[0] -= weights.at(i + 1);
    }
    return true;
}

glm::dvec4 weightedSum(const std::vector<WeightedVertex>& vertices) {
    glm::dvec4 sum(0);
    for (const WeightedVertex& vertex : vertices) sum += vertex.weight * vertex.position;
    return sum;
}

// Sets the weights to the barycentric coordinates of the point nearest to the origin in the simplex of the vertices.
// Removes the vertices whose weight becomes 0. Returns false if the vertices become affinely dependent.
bool moveToPointNearestOrigin(std::vector<WeightedVertex>& vertices) {
    std::array<double, 5> goal{};
    while (weightsOfPointNearestOrigin(vertices, goal)) {
        double step = 1;
        std::size_t least = vertices.size();
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            if (goal.at(i) > 0) continue;
            const double until = vertices[i].weight / (vertices[i].weight - goal.at(i));
            if (least == vertices.size() || until < step) {
                step = until;
                least = i;
            }
        }
        for (std::size_t i = 0; i < vertices.size(); ++i)
            vertices[i].weight += step * (goal.at(i) - vertices[i].weight);
        if (least == vertices.size()) return true;
        vertices.erase(vertices.begin() + static_cast<std::ptrdiff_t>(least));
    }
    return false;
}

}  // namespace

bool liesInHull(const glm::dvec4& point, std::span<const glm::dvec4> others, const HullFrame& frame) {
    if (others.empty()) return false;
    std::vector<WeightedVertex> vertices{{others[0] - point, 1}};
    for (int round = 0; round < kMaxIterations; ++round) {
        const glm::dvec4 nearest = weightedSum(vertices);
        const double distance = glm::length(nearest);
        if (!(distance > 0)) return true;
        const glm::dvec4 outward = -nearest / distance;
        const double tolerance = kErrorBounds * frame.errorBound(outward);
        if (distance <= tolerance) return true;
        const glm::dvec4 farthest = *std::max_element(others.begin(), others.end(),
                                                      [&](const glm::dvec4& a, const glm::dvec4& b) {
                                                          return glm::dot(a, outward) < glm::dot(b, outward);
                                                      }) -
                                    point;
        const double beyond = -glm::dot(farthest, outward);
        if (beyond > tolerance) return false;
        const bool known = std::any_of(vertices.begin(), vertices.end(),
                                       [&](const WeightedVertex& vertex) { return vertex.position == farthest; });
        if (known || vertices.size() == 5) return false;
        vertices.push_back({farthest, 0});
        if (!moveToPointNearestOrigin(vertices)) return false;
    }
    return false;
}

}  // namespace oval4d::polytopes
