#include "slicing/occlusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace oval4d::slicing {

namespace {

// Lengths, as fractions of the size of the projection. They are large compared with ProjectedCells::kTinyShift. A line
// in a 2-face is tested at the distance kBesideLine from a line that may bound visible parts of the 2-face. Parts of
// tested lines that are shorter than kShortest are skipped.
constexpr double kBesideLine = 1e-7;
constexpr double kShortest = 2e-6;

double crossProduct(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

// Returns the winding number of a loop around a point.
int windingOfLoop(std::span<const glm::dvec2> loop, const glm::dvec2& point) {
    int winding = 0;
    for (std::size_t i = 0; i < loop.size(); ++i)
        winding += windingOfSide(loop[i] - point, loop[(i + 1) % loop.size()] - point);
    return winding;
}

}  // namespace

glm::dvec2 OcclusionFinder::ProjectedFaceFrame::coordinatesOf(const glm::dvec4& point) const {
    const glm::dvec3 from(point - origin);
    return {glm::dot(from, glm::dvec3(right)), glm::dot(from, glm::dvec3(up))};
}

bool OcclusionFinder::findDrawnElements(const geometry::CellComplex& complex, std::span<const glm::dvec4> images,
                                        const DrawnAndHidingCells& roles, bool withFaces, std::size_t steps,
                                        DrawnElements& out) {
    complex_ = &complex;
    out.vertices.assign(complex.vertices.size(), false);
    out.edgeParts.clear();
    out.faces.assign(complex.faces.size(), false);

    std::vector<std::uint32_t> faces;
    std::vector<bool> mayShowVertex(complex.vertices.size()), mayShowEdge(complex.edges.size());
    for (std::uint32_t f = 0; f < complex.faces.size(); ++f) {
        const auto [first, second] = complex.faceCells[f];
        if (!roles.drawn[first] && !roles.drawn[second]) continue;
        faces.push_back(f);
        for (const std::uint32_t v : complex.faces[f]) mayShowVertex[v] = true;
        for (const std::uint32_t e : complex.faceEdges[f]) mayShowEdge[e] = true;
    }
    const std::size_t tested = static_cast<std::size_t>(std::count(mayShowEdge.begin(), mayShowEdge.end(), true)) +
                               (withFaces ? faces.size() : 0);
    const auto hiding = static_cast<std::size_t>(std::count(roles.hides.begin(), roles.hides.end(), true));
    if (hiding > 0 && tested > steps / hiding) return false;
    cells_.setCells(complex, images, roles.hides, steps);
    if (withFaces) findSilhouetteFaces(roles.hides);

    for (const std::uint32_t f : faces) {
        if (cells_.isExhausted()) return false;
        out.faces[f] = withFaces && !isFaceHidden(f);
    }
    const std::vector<glm::dvec4>& points = cells_.points();
    for (std::uint32_t e = 0; e < complex.edges.size(); ++e) {
        if (cells_.isExhausted()) return false;
        if (!mayShowEdge[e]) continue;
        const auto [a, b] = complex.edges[e];
        cells_.excludeCells(cells_.cellsOfEdge(e));
        cells_.findVisibleParts({points[a], points[b]}, cells_.allOccluders(), visibleParts_);
        for (const auto& [from, to] : visibleParts_) {
            out.edgeParts.push_back({e, from, to});
            if (from == 0) out.vertices[a] = true;
            if (to == 1) out.vertices[b] = true;
        }
    }
    for (std::uint32_t v = 0; v < complex.vertices.size(); ++v) {
        if (cells_.isExhausted()) return false;
        if (!mayShowVertex[v] || out.vertices[v]) continue;
        cells_.excludeCells(cells_.cellsOfVertex(v));
        out.vertices[v] = !cells_.isHidden({points[v], points[v]}, cells_.allOccluders());
    }
    return !cells_.isExhausted();
}

// Returns on which side of its boundary a projected cell lies, as the sign of its volume. The projection is divided
// into the tetrahedra between its center, the centers of its 2-faces and the sides of the 2-faces. Returns the common
// sign of their volumes, or 0 if the signs differ. If the signs agree, the winding number of the boundary of the cell
// has this sign at all points of the projection.
int OcclusionFinder::orientationSignOfCell(std::uint32_t cell) const {
    const auto centerOf = [this](std::span<const std::uint32_t> loop) {
        glm::dvec3 sum(0);
        for (const std::uint32_t v : loop) sum += glm::dvec3(cells_.points()[v]);
        return sum / static_cast<double>(loop.size());
    };
    const geometry::CellComplex& p = *complex_;
    const std::uint32_t begin = p.cells.begin[cell], end = p.cells.begin[cell + 1];
    glm::dvec3 center(0);
    for (const std::uint32_t f : p.cells[cell]) center += centerOf(p.faces[f]) / static_cast<double>(end - begin);
    const double least = 1e-15 * cells_.size() * cells_.size() * cells_.size();
    bool positive = false, negative = false;
    for (std::uint32_t at = begin; at < end; ++at) {
        const auto loop = p.faces[p.cells.items[at]];
        const glm::dvec3 middle = centerOf(loop) - center;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const glm::dvec3 a(cells_.points()[loop[i]]), b(cells_.points()[loop[(i + 1) % loop.size()]]);
            const double volume = p.cellSigns[at] * glm::dot(middle, glm::cross(a - center, b - center));
            positive = positive || volume > least;
            negative = negative || volume < -least;
        }
    }
    return static_cast<int>(positive) - static_cast<int>(negative);
}

// Finds the 2-faces at which cells may begin or cease to hide what lies behind them. If the projections of the two
// cells of a 2-face have the same sign (see orientationSignOfCell()), the cells lie on opposite sides of the 2-face.
// One cell then hides beyond the 2-face what the other cell hid before it, so the 2-face is left out.
void OcclusionFinder::findSilhouetteFaces(const std::vector<bool>& hides) {
    const geometry::CellComplex& p = *complex_;
    silhouetteFaces_.clear();
    std::vector<int> side(p.cells.size(), 0);
    for (const Occluder& occluder : cells_.occluders()) {
        cells_.countSteps(p.cells[occluder.cell].size());
        side[occluder.cell] = orientationSignOfCell(occluder.cell);
    }
    for (std::uint32_t f = 0; f < p.faces.size(); ++f) {
        const auto [first, second] = p.faceCells[f];
        if (!hides[first] && !hides[second]) continue;
        if (side[first] != 0 && side[first] == side[second]) continue;
        const glm::dvec4& start = cells_.points()[p.faces[f][0]];
        SilhouetteFace face{f, {glm::dvec3(start), glm::dvec3(start)}, start.w};
        for (const std::uint32_t v : p.faces[f]) {
            face.box.include(glm::dvec3(cells_.points()[v]));
            face.top = std::max(face.top, cells_.points()[v].w);
        }
        silhouetteFaces_.push_back(face);
    }
}

bool OcclusionFinder::isFaceHidden(std::uint32_t face) {
    const geometry::CellComplex& p = *complex_;
    const auto loop = p.faces[face];
    cells_.excludeCells(p.faceCells[face]);
    const glm::dvec4& start = cells_.points()[loop[0]];
    Box box{glm::dvec3(start), glm::dvec3(start)};
    double lowest = start.w;
    for (const std::uint32_t v : loop) {
        box.include(glm::dvec3(cells_.points()[v]));
        lowest = std::min(lowest, cells_.points()[v].w);
    }
    cells_.countSteps(cells_.occluders().size());
    candidates_.clear();
    for (std::uint32_t i = 0; i < cells_.occluders().size(); ++i) {
        const Occluder& o = cells_.occluders()[i];
        if (!cells_.isExcluded(o.cell) && o.top > lowest && o.box.intersects(box)) candidates_.push_back(i);
    }
    if (candidates_.empty()) return false;
    if (!findFaceFrame(loop)) {  // the 2-face is seen edge-on: only its sides can be seen
        for (std::size_t i = 0; i < loop.size(); ++i) {
            if (!cells_.isHidden({cells_.points()[loop[i]], cells_.points()[loop[(i + 1) % loop.size()]]}, candidates_))
                return false;
        }
        return true;
    }
    outline_.clear();
    for (const std::uint32_t v : loop) outline_.push_back(faceFrame_.coordinatesOf(cells_.points()[v]));
    for (std::size_t i = 0; i < outline_.size(); ++i) {
        if (isSeenBeside(outline_[i], outline_[(i + 1) % outline_.size()])) return false;
    }
    for (const std::uint32_t i : candidates_) {
        if (cells_.isExhausted() || isSeenBesideHyperplane(cells_.occluders()[i])) return false;
    }
    cells_.countSteps(silhouetteFaces_.size());
    for (const SilhouetteFace& other : silhouetteFaces_) {
        if (other.face == face || other.top <= lowest || !other.box.intersects(box)) continue;
        const auto corners = p.faces[other.face];
        cells_.countSteps(corners.size());
        for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
            if (cells_.isExhausted() || isSeenBesideTriangle({corners[0], corners[i], corners[i + 1]})) return false;
        }
    }
    return true;
}

// Sets faceFrame_ to the image of the plane of a 2-face. Returns false if the projection of the 2-face has no area.
bool OcclusionFinder::findFaceFrame(std::span<const std::uint32_t> loop) {
    faceFrame_.origin = cells_.points()[loop[0]];
    const auto findAxis = [&](glm::dvec4& axis, auto rejected) {
        glm::dvec4 longest(0);
        double most = 0;
        for (const std::uint32_t v : loop) {
            const glm::dvec4 rest = rejected(cells_.points()[v] - faceFrame_.origin);
            if (const double length = glm::length(glm::dvec3(rest)); length > most) {
                most = length;
                longest = rest;
            }
        }
        if (most <= kShortest * cells_.size()) return false;
        axis = longest / most;
        return true;
    };
    return findAxis(faceFrame_.right, [](const glm::dvec4& vector) { return vector; }) &&
           findAxis(faceFrame_.up, [this](const glm::dvec4& vector) {
               return vector - glm::dot(glm::dvec3(vector), glm::dvec3(faceFrame_.right)) * faceFrame_.right;
           });
}

// Returns whether a part of the tested 2-face is seen beside a line: the line in which the hyperplane of the cell
// `occluder` cuts the 2-face.
bool OcclusionFinder::isSeenBesideHyperplane(const Occluder& occluder) {
    const glm::dvec2 gradient(-glm::dot(occluder.normal, faceFrame_.right), -glm::dot(occluder.normal, faceFrame_.up));
    const double atOrigin = occluder.depthOf(faceFrame_.origin);
    glm::dvec2 least = outline_[0], most = outline_[0];
    bool above = false, below = false;
    for (const glm::dvec2& corner : outline_) {
        least = glm::min(least, corner);
        most = glm::max(most, corner);
        (atOrigin + glm::dot(gradient, corner) > 0 ? below : above) = true;
    }
    const double slope = glm::length(gradient);
    if (!above || !below || slope == 0) return false;
    const glm::dvec2 middle = (least + most) / 2.0, across = gradient / slope;
    const glm::dvec2 onLine = middle - (atOrigin + glm::dot(gradient, middle)) / slope * across;
    const glm::dvec2 reach = glm::length(most - least) * glm::dvec2(-across.y, across.x);
    const glm::dvec2 from = onLine - reach, to = onLine + reach;
    // The part of the line that lies in the bounding box of the cell.
    const glm::dvec3 start(faceFrame_.pointAt(from)), way = glm::dvec3(faceFrame_.pointAt(to)) - start;
    double first = 0, last = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = occluder.box.least[axis] - start[axis], high = occluder.box.most[axis] - start[axis];
        if (way[axis] == 0) {
            if (low > 0 || high < 0) return false;
            continue;
        }
        const auto [enters, leaves] = std::minmax({low / way[axis], high / way[axis]});
        first = std::max(first, enters);
        last = std::min(last, leaves);
    }
    return first < last && isSeenBeside(glm::mix(from, to, first), glm::mix(from, to, last));
}

// Returns whether a part of the tested 2-face is seen beside a line: the line in which the projection of `triangle`
// cuts the projected 2-face, or a side of the triangle that lies in the plane of the 2-face.
bool OcclusionFinder::isSeenBesideTriangle(const Triangle& triangle) {
    const glm::dvec3 normal = glm::cross(glm::dvec3(faceFrame_.right), glm::dvec3(faceFrame_.up));
    std::array<glm::dvec2, 3> corners{};
    std::array<double, 3> heights{};  // per corner: its height above the plane of the projected 2-face, in R³
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec4& point = cells_.points()[triangle[i]];
        corners[i] = faceFrame_.coordinatesOf(point);
        heights[i] = glm::dot(normal, glm::dvec3(point - faceFrame_.origin));
    }
    std::array<glm::dvec2, 2> ends{};
    std::size_t found = 0;
    const double same = ProjectedCells::kTinyShift * cells_.size();
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t next = (i + 1) % 3;
        const double a = heights[i], b = heights[next];
        if (std::abs(a) <= same && std::abs(b) <= same && isSeenBeside(corners[i], corners[next])) return true;
        if ((a > 0) != (b > 0) && found < 2) ends[found++] = glm::mix(corners[i], corners[next], a / (a - b));
    }
    return found == 2 && isSeenBeside(ends[0], ends[1]);
}

// Returns whether a part of the tested 2-face is seen next to the line from `from` to `to` in its plane, on either
// side.
bool OcclusionFinder::isSeenBeside(const glm::dvec2& from, const glm::dvec2& to) {
    const glm::dvec2 along = to - from;
    const double length = glm::length(along);
    if (length <= kShortest * cells_.size()) return false;
    cells_.countSteps(outline_.size());
    places_.assign({0, 1});
    for (std::size_t i = 0; i < outline_.size(); ++i) {
        const glm::dvec2 corner = outline_[i], side = outline_[(i + 1) % outline_.size()] - corner;
        const double turn = crossProduct(along, side);
        // Skips a side that is parallel to the line.
        if (std::abs(turn) <= ProjectedCells::kTinyShift * length * glm::length(side)) continue;
        const double place = crossProduct(corner - from, side) / turn;
        const double onSide = crossProduct(corner - from, along) / turn;
        if (place > 0 && place < 1 && onSide >= -kBesideLine && onSide <= 1 + kBesideLine) places_.push_back(place);
    }
    std::ranges::sort(places_);
    const glm::dvec2 across = kBesideLine * cells_.size() / length * glm::dvec2(-along.y, along.x);
    // The tested line is beside the line from `from` to `to`, so it may leave the 2-face near a corner. A short part
    // near each end is not tested, therefore.
    const double margin = 8 * kBesideLine * cells_.size() / length;
    for (std::size_t i = 0; i + 1 < places_.size(); ++i) {
        if ((places_[i + 1] - places_[i]) * length <= kShortest * cells_.size()) continue;
        for (const double sign : {1.0, -1.0}) {
            const glm::dvec2 start = from + (places_[i] + margin) * along + sign * across;
            const glm::dvec2 end = from + (places_[i + 1] - margin) * along + sign * across;
            if (windingOfLoop(outline_, (start + end) / 2.0) == 0) continue;
            if (!cells_.isHidden({faceFrame_.pointAt(start), faceFrame_.pointAt(end)}, candidates_)) return true;
        }
    }
    return false;
}

}  // namespace oval4d::slicing
