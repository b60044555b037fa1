#pragma once
// Planes and hyperplanes through points that have errors, and the search for groups of simplices that lie in one plane
// or hyperplane.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "polytopes/import/hull_frame.hpp"

namespace oval4d::polytopes {

/// A flat: a plane (Dimension 2) or hyperplane (3), through the corners of a simplex. Errors of the corners make its
/// position uncertain.
template <std::size_t Dimension>
class Flat {
  public:
    static constexpr std::size_t kCorners = Dimension + 1;
    using SimplexCorners = std::array<std::uint32_t, kCorners>;

    Flat(const SimplexCorners& corners, std::span<const glm::dvec4> points)
        : corners_(corners), origin_(points[corners[0]]) {
        for (std::size_t j = 0; j < Dimension; ++j) {
            glm::dvec4 rest = points[corners.at(j + 1)] - origin_;
            for (std::size_t i = 0; i < j; ++i) {
                edges_.at(j).at(i) = glm::dot(rest, axes_.at(i));
                rest -= edges_.at(j).at(i) * axes_.at(i);
            }
            const double length = glm::length(rest);
            edges_.at(j).at(j) = length;
            axes_.at(j) = length > 0 ? rest / length : glm::dvec4(0);
            volume_ *= length;
        }
    }

    const SimplexCorners& corners() const { return corners_; }
    /// Returns the volume of the simplex times the factorial of its dimension.
    double parallelotopeVolume() const { return volume_; }
    /// Returns one of the orthonormal vectors that span the flat; i is from 0 to Dimension − 1.
    const glm::dvec4& basisVector(std::size_t i) const { return axes_.at(i); }

    /// Projects p onto the flat. Returns the coordinates of the projection along the axes of the flat, relative to the
    /// first corner.
    std::array<double, Dimension> project(const glm::dvec4& p) const {
        glm::dvec4 rest = p - origin_;
        std::array<double, Dimension> along;
        for (std::size_t i = 0; i < Dimension; ++i) {
            along.at(i) = glm::dot(rest, axes_.at(i));
            rest -= along.at(i) * axes_.at(i);
        }
        return along;
    }

    /// Returns the factor by which an error of the flat at p can exceed the errors of the corners: the sum of the
    /// absolute values of the barycentric coordinates of p. Returns infinity if the corners span no simplex.
    double cornerErrorFactor(const glm::dvec4& p) const {
        std::array<double, Dimension> weights = project(p);
        double sum = 0, first = 1;
        for (std::size_t j = Dimension; j-- > 0;) {
            if (!(edges_.at(j).at(j) > 0)) return std::numeric_limits<double>::infinity();
            weights.at(j) /= edges_.at(j).at(j);
            for (std::size_t i = 0; i < j; ++i) weights.at(i) -= weights.at(j) * edges_.at(j).at(i);
            sum += std::abs(weights.at(j));
            first -= weights.at(j);
        }
        return sum + std::abs(first);
    }

    /// Returns whether the distance of p from the flat is at most `factor` times the sum of two error bounds. One is
    /// the error bound of p, HullFrame::errorBound(). The other is the error bound of the flat at p:
    /// HullFrame::errorBound() times cornerErrorFactor(), but at most times 16.
    bool contains(const glm::dvec4& p, const HullFrame& frame, double factor = 1) const {
        glm::dvec4 rest = p - origin_;
        for (const glm::dvec4& axis : axes_) rest -= glm::dot(rest, axis) * axis;
        const double distance = glm::length(rest);
        if (!(distance > 0)) return true;
        constexpr double kMaxAmplification = 16;  // the maximum of cornerErrorFactor() that counts, however far p is
                                                  // from the corners
        return distance <=
               factor * frame.errorBound(rest / distance) * (1 + std::min(cornerErrorFactor(p), kMaxAmplification));
    }

  private:
    SimplexCorners corners_;
    glm::dvec4 origin_;
    std::array<glm::dvec4, Dimension> axes_{};
    // Entry j holds the coordinates, along axes_, of the edge from corner 0 to corner j + 1.
    std::array<std::array<double, Dimension>, Dimension> edges_{};
    double volume_ = 1;
};

using PlaneThroughPoints = Flat<2>;
using HyperplaneThroughPoints = Flat<3>;

/// Chooses points among `from` that span a large simplex, and returns their indices. The first point is the farthest
/// from the mean of `from`. Each further point is the farthest from the flat through the points that were chosen
/// before.
template <std::size_t Count>
std::array<std::uint32_t, Count> largeSimplex(std::span<const std::uint32_t> from, std::span<const glm::dvec4> points) {
    glm::dvec4 middle(0);
    for (const std::uint32_t v : from) middle += points[v] / static_cast<double>(from.size());
    std::array<std::uint32_t, Count> chosen{};
    std::array<glm::dvec4, Count> axes{};
    for (std::size_t i = 0; i < Count; ++i) {
        double most = -1;
        for (const std::uint32_t v : from) {
            glm::dvec4 rest = points[v] - (i == 0 ? middle : points[chosen[0]]);
            for (std::size_t k = 1; k < i; ++k) rest -= glm::dot(rest, axes.at(k)) * axes.at(k);
            if (const double length = glm::dot(rest, rest); length > most) {
                most = length;
                chosen.at(i) = v;
                axes.at(i) = length > 0 ? rest / std::sqrt(length) : glm::dvec4(0);
            }
        }
    }
    return chosen;
}

/// Returns a group of neighboring simplices (triangles or tetrahedra) that lie in one flat, and sets `flat` to this
/// flat. `own` are the corners of one of the simplices; before the call, `flat` must be the flat through `own`.
/// grow(flat) returns the group that lies in a flat, and verticesOf(group) returns the vertices of a group.
///
/// First calls grow(flat). A larger simplex determines a flat more precisely. So if vertices of the group span a larger
/// simplex whose flat also contains `own`, sets `flat` to this flat and calls grow(flat) again, at most four times.
template <typename F, typename Corners, typename Grow, typename VerticesOf>
std::vector<std::uint32_t> growAndRefit(F& flat, const Corners& own, const Grow& grow, const VerticesOf& verticesOf,
                                        std::span<const glm::dvec4> points, const HullFrame& frame) {
    constexpr int kMaxRefits = 4;
    constexpr double kLarger = 1.01;
    std::vector<std::uint32_t> group = grow(flat);
    for (int i = 0; i < kMaxRefits && group.size() > 1; ++i) {
        const F wider(largeSimplex<F::kCorners>(verticesOf(group), points), points);
        const bool contains = std::ranges::all_of(own, [&](auto v) { return wider.contains(points[v], frame); });
        if (!(wider.parallelotopeVolume() > kLarger * flat.parallelotopeVolume()) || !contains) break;
        flat = wider;
        group = grow(flat);
    }
    return group;
}

}  // namespace oval4d::polytopes
