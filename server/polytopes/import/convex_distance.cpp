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

constexpr double kNoise = 2;        // times HullFrame::noise: the noise of the point plus that of the hull
constexpr int kMaxIterations = 64;  // a safeguard: the method usually ends after a few rounds

// A corner of the current simplex, which contains the nearest point found so far, and the barycentric weight of the
// corner in this point.
struct Corner {
    glm::dvec4 place;
    double weight;
};

// Finds the barycentric weights of the point nearest to the origin in the affine hull of the corners. Returns false if
// the corners are affinely dependent.
bool nearestWeights(const std::vector<Corner>& corners, std::array<double, 5>& weights) {
    const std::size_t n = corners.size() - 1;
    std::array<std::array<double, 5>, 4> rows{};  // the normal equations
    const glm::dvec4& base = corners[0].place;
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec4 a = corners[i + 1].place - base;
        for (std::size_t j = 0; j < n; ++j) rows.at(i).at(j) = glm::dot(a, corners[j + 1].place - base);
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

glm::dvec4 sumOf(const std::vector<Corner>& corners) {
    glm::dvec4 sum(0);
    for (const Corner& corner : corners) sum += corner.weight * corner.place;
    return sum;
}

// Moves the weights to the nearest point of the simplex and removes the corners that do not contribute to it. Returns
// false if the corners become affinely dependent.
bool moveToNearest(std::vector<Corner>& corners) {
    std::array<double, 5> goal{};
    while (nearestWeights(corners, goal)) {
        double step = 1;
        std::size_t least = corners.size();
        for (std::size_t i = 0; i < corners.size(); ++i) {
            if (goal.at(i) > 0) continue;
            const double until = corners[i].weight / (corners[i].weight - goal.at(i));
            if (least == corners.size() || until < step) {
                step = until;
                least = i;
            }
        }
        for (std::size_t i = 0; i < corners.size(); ++i) corners[i].weight += step * (goal.at(i) - corners[i].weight);
        if (least == corners.size()) return true;
        corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(least));
    }
    return false;
}

}  // namespace

bool liesInHull(const glm::dvec4& point, std::span<const glm::dvec4> others, const HullFrame& frame) {
    if (others.empty()) return false;
    std::vector<Corner> corners{{others[0] - point, 1}};
    for (int round = 0; round < kMaxIterations; ++round) {
        const glm::dvec4 nearest = sumOf(corners);
        const double distance = glm::length(nearest);
        if (!(distance > 0)) return true;
        const glm::dvec4 outward = -nearest / distance;
        const double noise = kNoise * frame.noise(outward);
        if (distance <= noise) return true;
        const glm::dvec4 farthest = *std::max_element(others.begin(), others.end(),
                                                      [&](const glm::dvec4& a, const glm::dvec4& b) {
                                                          return glm::dot(a, outward) < glm::dot(b, outward);
                                                      }) -
                                    point;
        const double beyond = -glm::dot(farthest, outward);
        if (beyond > noise) return false;
        const bool known =
            std::any_of(corners.begin(), corners.end(), [&](const Corner& corner) { return corner.place == farthest; });
        if (known || corners.size() == 5) return false;
        corners.push_back({farthest, 0});
        if (!moveToNearest(corners)) return false;
    }
    return false;
}

}  // namespace oval4d::polytopes
