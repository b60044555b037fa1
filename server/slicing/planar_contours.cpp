#include "slicing/planar_contours.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "geometry/index.hpp"
#include "slicing/surfaces/section_values.hpp"

namespace oval4d::slicing {

namespace {

// Returns the point between p and q at which a function is 0. The function is linear from p to q, with the value `a` at
// p and `b` at q; exactly one of these values is negative. The result does not depend on the order of p and q. So the
// two lattice cells that share the segment find the same point. If a value is infinite, returns the middle of p and q.
glm::dvec2 zeroOnSegment(glm::dvec2 p, glm::dvec2 q, double a, double b) {
    if (std::tie(q.x, q.y) < std::tie(p.x, p.y)) {
        std::swap(p, q);
        std::swap(a, b);
    }
    const double t = std::isfinite(a) && std::isfinite(b) ? a / (a - b) : 0.5;
    return (1 - t) * p + t * q;
}

glm::dvec2 withoutZ(const glm::dvec3& p) { return {p.x, p.y}; }

}  // namespace

double contourStep(const fields::Field& field, double side, double pixels, Quality quality) {
    constexpr double kPerPoint = 3;  // nanoseconds to place a lattice point, and to follow the contours beside it
    const double perPoint = field.function->cost().value + kPerPoint;
    const double affordable = std::sqrt(maxContourTime(quality) / (static_cast<double>(kPlaneAxes.size()) * perPoint));
    const double wanted = quality == Quality::file ? kMaxContourSquares : pixels / pixelsPerCube(quality);
    return side / std::clamp(std::min(wanted, affordable), kMinContourSquares, kMaxContourSquares);
}

double PlanarContourTracer::HalfPlane::depthOf(const glm::dvec2& p) const { return offset - glm::dot(normal, p); }

void PlanarContourTracer::trace(const fields::Field& field, const geometry::Rotation& orientation,
                                const glm::dvec4& point, std::span<const double> levels, double step, Quality quality,
                                MatrixContours& out) {
    const glm::dmat4 toFunction = field.toFunction * orientation.inverse().matrix();
    const double coarsest = std::max(step, 4 * 2 * field.circumradius / kMaxContourSquares);
    for (std::size_t i = 0; i < kPlaneAxes.size(); ++i) {
        out[i].clear();
        setSectionPlane(field, toFunction, kPlaneAxes[i], point);
        if (!findBoxSides(field, toFunction)) continue;
        const double reach = 1.01 * field.circumradius;  // half the side of a square that contains the domain
        const std::vector<glm::dvec2> square{{-reach, -reach}, {reach, -reach}, {reach, reach}, {-reach, reach}};
        for (double size = step;; size = std::min(2 * size, coarsest)) {
            polygon_ = square;
            cutBySides();
            if (polygon_.empty()) break;
            layOutLattice(size);
            const std::array<glm::dvec4, 2> steps{size * section_.axes[0], size * section_.axes[1]};
            const fields::ScalarFunction& function =
                quality == Quality::draft ? field.function->downsampledForSteps(steps) : *field.function;
            evaluateInSection(function, section_, std::span<const glm::dvec3>(points_), values_);
            out[i].clear();
            for (std::size_t level = 0; level < levels.size(); ++level) {
                segments_.clear();
                for (std::size_t cell = 0; cell + 1 < cellBegin_.size(); ++cell) {
                    const std::uint32_t begin = cellBegin_[cell], end = cellBegin_[cell + 1];
                    addSegments(std::span<const std::uint32_t>(cellCorners_).subspan(begin, end - begin),
                                levels[level]);
                }
                joinSegments(static_cast<std::uint32_t>(level), out[i]);
            }
            if (out[i].points.size() <= kMaxContourPoints || size >= coarsest) break;
        }
    }
    field.function->releasePages();
}

// Sets section_ to the plane through `point` that is parallel to the two coordinate axes `axes`.
void PlanarContourTracer::setSectionPlane(const fields::Field& field, const glm::dmat4& toFunction,
                                          const std::array<int, 2>& axes, const glm::dvec4& point) {
    glm::dvec4 origin = point;
    for (const int axis : axes) origin[axis] = 0;
    section_.origin = field.center + toFunction * origin;
    section_.axes = {toFunction[axes[0]], toFunction[axes[1]], glm::dvec4(0)};
}

// Sets sides_ to one half-plane for each facet of the box that is not parallel to the plane of the contours. Returns
// false if the plane is parallel to a facet and lies outside the box.
bool PlanarContourTracer::findBoxSides(const fields::Field& field, const glm::dmat4& toFunction) {
    constexpr double kParallel = 1e-12;
    sides_.clear();
    for (int axis = 0; axis < 4; ++axis) {
        const glm::dvec2 row(section_.axes[0][axis], section_.axes[1][axis]);
        const glm::dvec4 whole(toFunction[0][axis], toFunction[1][axis], toFunction[2][axis], toFunction[3][axis]);
        const double length = glm::length(row);
        const double least = field.box.min[axis] - section_.origin[axis],
                     most = field.box.max[axis] - section_.origin[axis];
        if (length <= kParallel * glm::length(whole)) {
            const double tolerance = kOnPlaneTolerance * (most - least);
            if (least > tolerance || most < -tolerance) return false;
            continue;
        }
        sides_.push_back({row / length, most / length});
        sides_.push_back({-row / length, -least / length});
    }
    return true;
}

bool PlanarContourTracer::isInDomain(const glm::dvec2& p) const {
    return std::ranges::all_of(sides_, [&](const HalfPlane& side) { return side.depthOf(p) >= 0; });
}

// Cuts the convex polygon polygon_ by all half-planes of sides_ (I. E. Sutherland and G. W. Hodgman, "Reentrant polygon
// clipping", 1974). The remaining polygon is the part in the domain, and may be empty.
void PlanarContourTracer::cutBySides() {
    for (const HalfPlane& side : sides_) {
        cutPolygon_.clear();
        for (std::size_t i = 0; i < polygon_.size(); ++i) {
            const glm::dvec2 &p = polygon_[i], &q = polygon_[i + 1 < polygon_.size() ? i + 1 : 0];
            const double here = side.depthOf(p), next = side.depthOf(q);
            if (here >= 0) cutPolygon_.push_back(p);
            if ((here < 0) != (next < 0)) cutPolygon_.push_back(zeroOnSegment(p, q, here, next));
        }
        std::swap(polygon_, cutPolygon_);
    }
}

// Sets the points and the cells of a square lattice that covers polygon_, the part of the plane in the domain. The
// coordinates of lattice points are multiples of `step`, so that the lattice stays in place while the object turns.
void PlanarContourTracer::layOutLattice(double step) {
    glm::dvec2 min = polygon_[0], max = polygon_[0];
    for (const glm::dvec2& p : polygon_) {
        min = glm::min(min, p);
        max = glm::max(max, p);
    }
    const glm::dvec2 first = glm::floor(min / step);
    const auto size = [&](int axis) { return static_cast<std::size_t>(std::ceil(max[axis] / step) - first[axis]) + 1; };
    const std::size_t columns = size(0), rows = size(1);
    const auto placeOf = [&](std::size_t column, std::size_t row) {
        return step * (first + glm::dvec2(static_cast<double>(column), static_cast<double>(row)));
    };
    points_.clear();
    latticePoints_.clear();
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t column = 0; column < columns; ++column) {
            const glm::dvec2 p = placeOf(column, row);
            const bool isInside = isInDomain(p);
            latticePoints_.push_back(isInside ? static_cast<std::uint32_t>(points_.size()) : geometry::kNone);
            if (isInside) points_.emplace_back(p, 0);
        }
    }
    cellBegin_.assign(1, 0);
    cellCorners_.clear();
    for (std::size_t row = 0; row + 1 < rows; ++row) {
        for (std::size_t column = 0; column + 1 < columns; ++column) {
            const std::size_t below = row * columns + column, above = below + columns;
            addCell(
                {placeOf(column, row), placeOf(column + 1, row), placeOf(column + 1, row + 1),
                 placeOf(column, row + 1)},
                {latticePoints_[below], latticePoints_[below + 1], latticePoints_[above + 1], latticePoints_[above]});
        }
    }
}

// Adds the part in the domain of one lattice square, if there is such a part. `indices` has the indices of the four
// corners in points_, or kNone for a corner outside the domain.
void PlanarContourTracer::addCell(const std::array<glm::dvec2, 4>& corners,
                                  const std::array<std::uint32_t, 4>& indices) {
    if (std::ranges::find(indices, geometry::kNone) == indices.end()) {
        cellCorners_.insert(cellCorners_.end(), indices.begin(), indices.end());
    } else {
        polygon_.assign(corners.begin(), corners.end());
        cutBySides();
        if (polygon_.size() < 3) return;
        for (const glm::dvec2& p : polygon_) {
            const auto known = static_cast<std::size_t>(std::ranges::find(corners, p) - corners.begin());
            if (known < corners.size() && indices[known] != geometry::kNone) {
                cellCorners_.push_back(indices[known]);
                continue;
            }
            cellCorners_.push_back(static_cast<std::uint32_t>(points_.size()));
            points_.emplace_back(p, 0);
        }
    }
    cellBegin_.push_back(static_cast<std::uint32_t>(cellCorners_.size()));
}

// Adds the segments of the contour of `level` in one lattice cell. `corners` has the indices of the cell's corners, in
// their order around the cell.
void PlanarContourTracer::addSegments(std::span<const std::uint32_t> corners, double level) {
    crossings_.clear();
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::uint32_t a = corners[i], b = corners[i + 1 < corners.size() ? i + 1 : 0];
        const double here = values_[a] - level, next = values_[b] - level;
        if (std::isnan(here) || std::isnan(next)) return;
        sum += here;
        if ((here < 0) != (next < 0))
            crossings_.push_back(zeroOnSegment(withoutZ(points_[a]), withoutZ(points_[b]), here, next));
    }
    // If there are more than two crossings, corners below the level alternate with corners above the level. The sign of
    // `middle` then decides which corners are connected within the cell:
    // - In a square, `middle` is the value at the saddle point of the bilinear interpolation, minus the level (G. M.
    //   Nielson and B. Hamann, "The asymptotic decider", 1991).
    // - In any other cell, `middle` has the sign of the mean of all corners, minus the level.
    //
    // Corners on the same side of the level as the middle are connected. On the other side, a segment separates each
    // run of successive corners from the middle.
    double middle = sum;
    if (corners.size() == 4 && crossings_.size() == 4) {
        const auto value = [&](std::size_t i) { return values_[corners[i]] - level; };
        middle = (value(0) * value(2) - value(1) * value(3)) / (value(0) + value(2) - value(1) - value(3));
    }
    const bool startsBelow = values_[corners[0]] - level < 0;
    const std::size_t first = startsBelow == (middle < 0) ? 0 : 1, count = crossings_.size();
    for (std::size_t i = 0; i < count; i += 2) {
        const glm::dvec2 &from = crossings_[(first + i) % count], &to = crossings_[(first + i + 1) % count];
        if (from != to) segments_.push_back({{from, to}});
    }
}

// Joins the segments of segments_ at their common ends to lines, and adds these lines to `out`, with the level index
// `level`. A line ends at a place that is the end of only one segment, or of more than two segments.
void PlanarContourTracer::joinSegments(std::uint32_t level, PlanarContours& out) {
    ends_.clear();
    for (std::uint32_t s = 0; s < segments_.size(); ++s)
        for (std::uint32_t k = 0; k < 2; ++k) ends_.push_back({segments_[s].ends[k], 2 * s + k});
    std::ranges::sort(ends_, {}, [](const SegmentEnd& e) { return std::tuple(e.at.x, e.at.y, e.end); });
    nodeOf_.resize(ends_.size());
    nodeBegin_.clear();
    for (std::uint32_t i = 0; i < ends_.size(); ++i) {
        if (i == 0 || ends_[i].at != ends_[i - 1].at) nodeBegin_.push_back(i);
        nodeOf_[ends_[i].end] = static_cast<std::uint32_t>(nodeBegin_.size() - 1);
    }
    const auto nodes = static_cast<std::uint32_t>(nodeBegin_.size());
    nodeBegin_.push_back(static_cast<std::uint32_t>(ends_.size()));
    const auto isPassed = [&](std::uint32_t node) { return nodeBegin_[node + 1] - nodeBegin_[node] == 2; };
    isJoined_.assign(segments_.size(), 0);
    // Adds the line that begins at the segment end with the number `end` (see SegmentEnd).
    const auto addLine = [&](std::uint32_t end) {
        out.points.push_back(segments_[end / 2].ends[end % 2]);
        for (;;) {
            isJoined_[end / 2] = 1;
            const std::uint32_t far = end ^ 1U, node = nodeOf_[far];
            out.points.push_back(segments_[far / 2].ends[far % 2]);
            if (!isPassed(node)) break;
            const std::uint32_t at = nodeBegin_[node];
            end = ends_[at].end == far ? ends_[at + 1].end : ends_[at].end;
            if (isJoined_[end / 2] != 0) break;  // back at the start of a closed line
        }
        out.begin.push_back(static_cast<std::uint32_t>(out.points.size()));
        out.level.push_back(level);
    };
    for (std::uint32_t node = 0; node < nodes; ++node) {
        if (isPassed(node)) continue;
        for (std::uint32_t i = nodeBegin_[node]; i < nodeBegin_[node + 1]; ++i)
            if (isJoined_[ends_[i].end / 2] == 0) addLine(ends_[i].end);
    }
    for (std::uint32_t s = 0; s < segments_.size(); ++s)
        if (isJoined_[s] == 0) addLine(2 * s);
}

}  // namespace oval4d::slicing
