#include "slicing/projected_cells.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

namespace oval4d::slicing {

namespace {

// Tolerances, as fractions of the size of the projection. They are large compared with rounding errors.
constexpr double kDepthTolerance = 3e-9;  // a point at most this far below a cell's hyperplane is not hidden by it
constexpr double kBoxMargin = 1e-7;       // a segment may cross a triangle this far outside its bounding box
constexpr double kLeastExtent = 1e-9;     // a cell whose extent in a direction is less than this hides nothing

constexpr double kLeastSlope = 1e-9;  // the least upward component of the normal of a cell that can hide something
// As a fraction of a segment: a shorter part of the segment does not count as visible.
constexpr double kVisibleGap = 1e-6;

// The corners of a regular tetrahedron with the center 0. For any direction, at least one of these corners is less than
// 90° away from it.
const std::array<glm::dvec3, 4> kTetrahedron{glm::dvec3(1, 1, 1), glm::dvec3(1, -1, -1), glm::dvec3(-1, 1, -1),
                                             glm::dvec3(-1, -1, 1)};

}  // namespace

int windingOfSide(const glm::dvec2& a, const glm::dvec2& b) {
    if ((a.y > 0) == (b.y > 0)) return 0;
    const bool upward = b.y > 0;
    const glm::dvec2 &low = upward ? a : b, &high = upward ? b : a;
    if (!(low.x * high.y - low.y * high.x > 0)) return 0;
    return upward ? 1 : -1;
}

bool ProjectedCells::Box::intersects(const Box& other) const {
    return glm::all(glm::lessThanEqual(least, other.most)) && glm::all(glm::lessThanEqual(other.least, most));
}

void ProjectedCells::Box::include(const glm::dvec3& point) {
    least = glm::min(least, point);
    most = glm::max(most, point);
}

double ProjectedCells::Occluder::depthOf(const glm::dvec4& point) const {
    return offset - glm::dot(normal, point) - tolerance;
}

void ProjectedCells::countSteps(std::size_t steps) {
    if (steps > stepsLeft_) exhausted_ = true;
    stepsLeft_ -= std::min(steps, stepsLeft_);
}

void ProjectedCells::setCells(const geometry::CellComplex& complex, std::span<const glm::dvec4> images,
                              const std::vector<bool>& hides, std::size_t steps) {
    stepsLeft_ = steps;
    exhausted_ = false;
    if (object_ != complex.serial) findIncidences(complex);
    // The axes of the turned space are arbitrary, so that they have no relation to those of the object.
    const glm::dvec3 x = glm::normalize(glm::dvec3(0.8131, 0.4713, -0.3419));
    const glm::dvec3 y = glm::normalize(glm::cross(x, glm::dvec3(0.2917, 0.5701, 0.7681)));
    const glm::dvec3 z = glm::cross(x, y);
    points_.clear();
    size_ = 0;
    for (const glm::dvec4& image : images) {
        const glm::dvec3 p(image);
        points_.emplace_back(glm::dot(x, p), glm::dot(y, p), glm::dot(z, p), image.w);
        size_ = std::max(size_, glm::length(image));
    }
    findOccluders(hides);
}

// Sets the members that depend only on which elements of the complex contain which others.
void ProjectedCells::findIncidences(const geometry::CellComplex& complex) {
    object_ = complex.serial;
    triangles_.clear();
    triangleBegin_.assign(1, 0);
    std::vector<std::vector<std::uint32_t>> ofVertex(complex.vertices.size()), ofEdge(complex.edges.size());
    const auto add = [](std::vector<std::uint32_t>& list, std::uint32_t cell) {
        if (list.empty() || list.back() != cell) list.push_back(cell);
    };
    for (std::uint32_t c = 0; c < complex.cells.size(); ++c) {
        for (std::uint32_t at = complex.cells.begin[c]; at < complex.cells.begin[c + 1]; ++at) {
            const std::uint32_t face = complex.cells.items[at];
            const auto loop = complex.faces[face];
            const bool forward = complex.cellSigns[at] > 0;
            for (std::size_t i = 1; i + 1 < loop.size(); ++i)
                triangles_.push_back({loop[0], loop[forward ? i : i + 1], loop[forward ? i + 1 : i]});
            for (const std::uint32_t v : loop) add(ofVertex[v], c);
            for (const std::uint32_t e : complex.faceEdges[face]) add(ofEdge[e], c);
        }
        triangleBegin_.push_back(static_cast<std::uint32_t>(triangles_.size()));
    }
    cellsOfVertex_ = {};
    cellsOfEdge_ = {};
    for (const auto& cells : ofVertex) cellsOfVertex_.add(cells);
    for (const auto& cells : ofEdge) cellsOfEdge_.add(cells);
    excludedIn_.assign(complex.cells.size(), 0);
    test_ = 0;
}

std::span<const ProjectedCells::Triangle> ProjectedCells::trianglesOf(std::uint32_t cell) const {
    return std::span(triangles_).subspan(triangleBegin_[cell], triangleBegin_[cell + 1] - triangleBegin_[cell]);
}

// Returns the unit normal of the hyperplane that contains the corners of `triangles`. Returns an empty optional if the
// corners do not span a hyperplane.
std::optional<glm::dvec4> ProjectedCells::normalOf(std::span<const Triangle> triangles) const {
    const glm::dvec4 origin = points_[triangles[0][0]];
    std::array<glm::dvec4, 3> axes{};  // orthonormal vectors that span the hyperplane
    const auto rejected = [&](glm::dvec4 vector, int count) {
        for (int round = 0; round < 2; ++round) {  // done twice, because of rounding errors
            for (int i = 0; i < count; ++i) vector -= glm::dot(vector, axes.at(i)) * axes.at(i);
        }
        return vector;
    };
    for (int i = 0; i < 3; ++i) {
        glm::dvec4 longest(0);
        for (const Triangle& triangle : triangles) {
            for (const std::uint32_t v : triangle) {
                const glm::dvec4 rest = rejected(points_[v] - origin, i);
                if (glm::dot(rest, rest) > glm::dot(longest, longest)) longest = rest;
            }
        }
        const double length = glm::length(longest);
        if (length <= kLeastExtent * size_) return std::nullopt;
        axes.at(i) = longest / length;
    }
    glm::dvec4 normal(0);
    for (int i = 0; i < 4; ++i) {
        glm::dvec4 axis(0);
        axis[i] = 1;
        const glm::dvec4 rest = rejected(axis, 3);
        if (glm::dot(rest, rest) > glm::dot(normal, normal)) normal = rest;
    }
    return glm::normalize(normal);
}

void ProjectedCells::findOccluders(const std::vector<bool>& hides) {
    occluders_.clear();
    for (std::uint32_t c = 0; c + 1 < triangleBegin_.size(); ++c) {
        if (!hides[c]) continue;
        const auto triangles = trianglesOf(c);
        countSteps(triangles.size());
        auto normal = normalOf(triangles);
        if (!normal || std::abs(normal->w) < kLeastSlope) continue;
        if (normal->w < 0) *normal = -*normal;
        const glm::dvec4 origin = points_[triangles[0][0]];
        Occluder occluder{c, {glm::dvec3(origin), glm::dvec3(origin)}, origin.w, *normal, glm::dot(*normal, origin), 0};
        double deviation = 0;
        for (const Triangle& triangle : triangles) {
            for (const std::uint32_t v : triangle) {
                occluder.box.include(glm::dvec3(points_[v]));
                occluder.top = std::max(occluder.top, points_[v].w);
                deviation = std::max(deviation, std::abs(occluder.depthOf(points_[v])));
            }
        }
        occluder.tolerance = kDepthTolerance * size_ + 2 * deviation;
        occluders_.push_back(occluder);
    }
    allOccluders_.resize(occluders_.size());
    std::iota(allOccluders_.begin(), allOccluders_.end(), 0U);
    lastHiding_ = 0;
}

void ProjectedCells::excludeCells(std::span<const std::uint32_t> cells) {
    ++test_;
    for (const std::uint32_t c : cells) excludedIn_[c] = test_;
}

bool ProjectedCells::isHidden(const Segment& segment, std::span<const std::uint32_t> candidates) {
    visible_.clear();
    return std::ranges::all_of(kTetrahedron, [&](const glm::dvec3& corner) {
        return findCovered(shifted(segment, corner), candidates) || (!exhausted_ && !addVisible());
    });
}

// A point is visible if it is visible after one of the shifts.
void ProjectedCells::findVisibleParts(const Segment& segment, std::span<const std::uint32_t> candidates,
                                      std::vector<SegmentPart>& out) {
    visible_.clear();
    for (const glm::dvec3& corner : kTetrahedron) {
        if (findCovered(shifted(segment, corner), candidates)) continue;
        if (exhausted_) break;
        addVisible();
        if (!visible_.empty() && visible_.back() == SegmentPart(0, 1)) break;
    }
    std::ranges::sort(visible_);
    out.clear();
    for (const auto& [first, last] : visible_) {
        if (out.empty() || first > out.back().second + kVisibleGap) {
            out.emplace_back(first, last);
        } else {
            out.back().second = std::max(out.back().second, last);
        }
    }
    if (out.empty()) return;
    if (out.front().first <= kVisibleGap) out.front().first = 0;
    if (out.back().second >= 1 - kVisibleGap) out.back().second = 1;
}

ProjectedCells::Segment ProjectedCells::shifted(const Segment& segment, const glm::dvec3& direction) const {
    const glm::dvec4 shift(kTinyShift * size_ * direction, 0);
    return {segment.from + shift, segment.to + shift};
}

// Adds to visible_ the parts of a segment that are not in covered_. Returns whether there are any.
bool ProjectedCells::addVisible() {
    const std::size_t before = visible_.size();
    double reach = 0;
    for (const auto& [first, last] : covered_) {
        if (first > reach + kVisibleGap) visible_.emplace_back(reach, first);
        reach = std::max(reach, last);
    }
    if (reach < 1 - kVisibleGap) visible_.emplace_back(reach, 1);
    return visible_.size() > before;
}

// Returns whether a single cell hides the whole segment; otherwise, sets covered_ to the hidden parts in ascending
// order.
bool ProjectedCells::findCovered(const Segment& segment, std::span<const std::uint32_t> candidates) {
    const glm::dvec3 a(segment.from), b(segment.to);
    const Box box{glm::min(a, b), glm::max(a, b)};
    covered_.clear();
    if (lastHiding_ < occluders_.size() && addHiddenParts(occluders_[lastHiding_], segment, box)) return true;
    for (const std::uint32_t i : candidates) {
        if (exhausted_) return false;
        if (!addHiddenParts(occluders_[i], segment, box)) continue;
        lastHiding_ = i;
        return true;
    }
    std::ranges::sort(covered_);
    return false;
}

// Adds to covered_ the parts of the segment that the cell `occluder` hides. Returns whether this cell hides the whole
// segment.
bool ProjectedCells::addHiddenParts(const Occluder& occluder, const Segment& segment, const Box& box) {
    countSteps(1);
    if (excludedIn_[occluder.cell] == test_ || !occluder.box.intersects(box)) return false;
    const double start = occluder.depthOf(segment.from), end = occluder.depthOf(segment.to);
    if (start <= 0 && end <= 0) return false;
    const double first = start > 0 ? 0 : start / (start - end), last = end > 0 ? 1 : start / (start - end);
    const auto triangles = trianglesOf(occluder.cell);
    countSteps(triangles.size());
    cuts_.assign({first, last});
    for (const Triangle& triangle : triangles) {
        if (const auto at = crossingOf(segment, triangle); at && *at > first && *at < last) cuts_.push_back(*at);
    }
    std::ranges::sort(cuts_);
    bool whole = first <= 0 && last >= 1;
    for (std::size_t i = 0; i + 1 < cuts_.size(); ++i) {
        if (cuts_[i + 1] - cuts_[i] <= kVisibleGap / 16) continue;
        const glm::dvec3 middle(glm::mix(segment.from, segment.to, (cuts_[i] + cuts_[i + 1]) / 2));
        if (windingOf(occluder.cell, middle) != 0) {
            covered_.emplace_back(cuts_[i], cuts_[i + 1]);
        } else {
            whole = false;
        }
    }
    return whole;
}

// Returns where the projection of a segment may cross the projection of a triangle: a number from 0 (at the start of
// the segment) to 1. Returns an empty optional if the segment does not cross the plane of the triangle, or crosses it
// outside the bounding box of the triangle by more than kBoxMargin.
std::optional<double> ProjectedCells::crossingOf(const Segment& segment, const Triangle& triangle) const {
    const glm::dvec3 a(points_[triangle[0]]), b(points_[triangle[1]]), c(points_[triangle[2]]);
    const glm::dvec3 from(segment.from), to(segment.to), normal = glm::cross(b - a, c - a);
    const double start = glm::dot(normal, from - a), end = glm::dot(normal, to - a);
    if ((start > 0) == (end > 0)) return std::nullopt;
    const double at = start / (start - end);
    const glm::dvec3 point = glm::mix(from, to, at), margin(kBoxMargin * size_);
    const Box box{glm::min(glm::min(a, b), c) - margin, glm::max(glm::max(a, b), c) + margin};
    if (!box.intersects({point, point})) return std::nullopt;
    return at;
}

// Returns the winding number of the boundary of a projected cell around `point`, in R³. The winding number is the sum
// of the signs with which the boundary crosses the ray from the point along the third axis.
int ProjectedCells::windingOf(std::uint32_t cell, const glm::dvec3& point) {
    const auto triangles = trianglesOf(cell);
    countSteps(triangles.size());
    int winding = 0;
    for (const Triangle& triangle : triangles) {
        const glm::dvec3 a = glm::dvec3(points_[triangle[0]]) - point, b = glm::dvec3(points_[triangle[1]]) - point,
                         c = glm::dvec3(points_[triangle[2]]) - point;
        const glm::dvec2 p(a), q(b), r(c);
        const int turn = windingOfSide(p, q) + windingOfSide(q, r) + windingOfSide(r, p);
        if (turn != 0 && turn * glm::dot(glm::cross(b - a, c - a), a) > 0) winding += turn;
    }
    return winding;
}

}  // namespace oval4d::slicing
