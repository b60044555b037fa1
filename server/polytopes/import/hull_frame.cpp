#include "polytopes/import/hull_frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "text_files/file_error.hpp"

namespace oval4d::polytopes {

using text_files::throwFileError;

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// The assumed ratio of the error of a hyperplane, far from the points through which it passes, to the rounding errors
// of these points.
constexpr double kTilt = 8;

bool isShorter(const glm::dvec4& a, const glm::dvec4& b) { return glm::dot(a, a) < glm::dot(b, b); }

}  // namespace

HullFrame::HullFrame(std::span<const glm::dvec4> points, const glm::dvec4& rounding) : rounding_(rounding) {
    glm::dvec4 low = points[0], high = points[0];
    for (const glm::dvec4& p : points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::dvec4 middle = low + (high - low) / 2.0;
    const glm::dvec4 largest = glm::max(glm::abs(low), glm::abs(high));
    // The points may have been rotated, so the floating-point error of each coordinate depends on the largest
    // coordinate.
    rounding_ += 2 * kEpsilon * std::max({largest.x, largest.y, largest.z, largest.w});

    origin_ = *std::max_element(points.begin(), points.end(),
                                [&](const auto& a, const auto& b) { return isShorter(a - middle, b - middle); });
    std::vector<glm::dvec4> rest(points.begin(), points.end());
    for (glm::dvec4& p : rest) p -= origin_;
    for (int k = 0; k < 4; ++k) {
        const glm::dvec4 farthest = *std::max_element(rest.begin(), rest.end(), isShorter);
        const double extent = glm::length(farthest);
        const glm::dvec4 axis = extent > 0 ? farthest / extent : glm::dvec4(0);
        const double error = kTilt * (glm::dot(glm::abs(axis), rounding_) + kEpsilon * extents_[0]);
        if (!(extent > error)) {
            static constexpr std::array kFlats{"are the same point", "lie on one line", "lie in one plane",
                                               "lie in one hyperplane"};
            const bool exact = rounding == glm::dvec4(0);
            throwFileError(0, std::string("all points ") + kFlats.at(static_cast<std::size_t>(k)) +
                                  (exact ? "" : ", to the precision of their coordinates"));
        }
        axes_[k] = axis;
        extents_[k] = extent;
        for (glm::dvec4& p : rest) p -= glm::dot(p, axis) * axis;
    }
    arithmetic_ = 4 * kEpsilon * extents_[0] / extents_;
}

glm::dvec4 HullFrame::operator()(const glm::dvec4& point) const {
    glm::dvec4 rest = point - origin_;
    glm::dvec4 result;
    for (int k = 0; k < 4; ++k) {
        const double along = glm::dot(rest, axes_[k]);
        rest -= along * axes_[k];
        result[k] = along / extents_[k];
    }
    return result;
}

double HullFrame::errorBound(const glm::dvec4& direction) const {
    return glm::dot(glm::abs(axes_ * (direction / extents_)), rounding_) +
           glm::dot(glm::abs(direction), arithmetic_ + perturbation_);
}

double HullFrame::largestErrorBound() const {
    double sum = 0;
    for (int k = 0; k < 4; ++k) {
        glm::dvec4 axis(0);
        axis[k] = 1;
        sum += errorBound(axis) * errorBound(axis);
    }
    return std::sqrt(sum);
}

}  // namespace oval4d::polytopes
