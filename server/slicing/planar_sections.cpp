#include "slicing/planar_sections.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/index.hpp"
#include "slicing/cloud_slicer.hpp"

namespace oval4d::slicing {

namespace {

using geometry::kNone;
constexpr int kW = 3;

void clear(PlanarSection& section) {
    section.points.clear();
    section.pointSource.clear();
    section.ballScale.clear();
    section.ballOpacity.clear();
    section.edges.clear();
    section.edgeSource.clear();
    section.boundary.clear();
}

// Returns the coordinate axis that is neither `other` nor one of the two axes of the plane `plane`.
int remainingAxis(const std::array<int, 2>& plane, int other) { return 0 + 1 + 2 + 3 - plane[0] - plane[1] - other; }

glm::dvec4 unitVector(int axis) {
    glm::dvec4 unit(0);
    unit[axis] = 1;
    return unit;
}

}  // namespace

// Each plane is the intersection of two hyperplanes. The object is cut by the first hyperplane, and the resulting slice
// by the second. If the plane lies in a hyperplane w = const, this hyperplane is the first one, because `slices`
// already contains the slice in it.
void PlanarSlicer::slice(const Object& object, const geometry::Rotation& orientation, const SliceSet& slices, int slice,
                         const glm::dvec4& point, PlanarSections& out) {
    // If the first hyperplane is z = const or y = const, z or y is rotated to w before the object is cut.
    constexpr std::array<int, 3> kFirstAxis{kW, 2, 1};
    for (const int first : kFirstAxis) {
        const SliceSet* set = &slices;
        int number = slice;
        glm::dmat4 toObject(1);
        if (first != kW) {
            const auto turn = geometry::Rotation::between(unitVector(first), unitVector(kW));
            slicer_.sliceWithoutSurfaces(object, turn * orientation, {0, 1, slices.planes.spacing, point[first]},
                                         slice_);
            set = &slice_;
            number = 0;
            toObject = turn.inverse().matrix();
        }
        for (std::size_t i = 0; i < kPlaneAxes.size(); ++i) {
            const auto& axes = kPlaneAxes[i];
            const auto contains = [&](int axis) { return axes[0] == axis || axes[1] == axis; };
            // Two axes are perpendicular to the plane. The plane is cut only if `first` is the one of these two axes
            // that comes first in kFirstAxis. So each plane is cut only once.
            const auto firstAxis = std::ranges::find_if_not(kFirstAxis, contains);
            if (*firstAxis != first) continue;
            out[i].axes = axes;
            cut(object, *set, number, toObject, remainingAxis(axes, first), point, out[i]);
        }
    }
}

// Cuts a slice by the hyperplane in which the coordinate along `axis` equals that of `point`, and writes the section to
// `out`. `toObject` rotates the slice to the coordinates of `point`. It is the identity unless the object was turned
// before the slice was cut.
void PlanarSlicer::cut(const Object& object, const SliceSet& slices, int slice, const glm::dmat4& toObject, int axis,
                       const glm::dvec4& point, PlanarSection& out) {
    clear(out);
    const std::uint32_t begin = slices.vertexBegin[slice], end = slices.vertexBegin[slice + 1];
    vertices_.clear();
    distance_.clear();
    const double radius = infoOf(object).circumradius;
    bool anyBelow = false;
    const bool isThick = propertiesOf(object).slicesAreThick;
    for (std::uint32_t v = begin; v < end; ++v) {
        const glm::dvec4 own = isThick ? slices.rotatedVertices[slices.vertexSource[v]]
                                       : glm::dvec4(slices.vertices[v], slices.planes.w(slice));
        vertices_.push_back(toObject * own);
        const double distance = vertices_.back()[axis] - point[axis];
        distance_.push_back(!isThick && std::abs(distance) <= kOnPlaneTolerance * radius ? 0 : distance);
        anyBelow = anyBelow || distance_.back() < 0;
    }
    if (isThick) {
        copyCloudPoints(slices, slice, axis, point[axis], out);
        return;
    }
    // Vertices in the hyperplane count as above it if other vertices lie below it, and otherwise as below it. Therefore
    // even a slice that only touches the hyperplane has a section, whether the slice lies above or below the
    // hyperplane.
    zeroIsAbove_ = anyBelow;
    cutEdges(slices, slice, static_cast<std::uint32_t>(elementCounts(object)[2]), axis, point[axis], out);
    cutFaces(slices, slice, out);
    findBoundary(out);
}

void PlanarSlicer::copyCloudPoints(const SliceSet& slices, int slice, int axis, double at, PlanarSection& out) {
    const std::uint32_t begin = slices.vertexBegin[slice];
    for (std::uint32_t v = 0; v < vertices_.size(); ++v) {
        const double distance = std::abs(vertices_[v][axis] - at) / (slices.planes.spacing / 2);
        if (distance > 1) continue;
        out.points.emplace_back(vertices_[v][out.axes[0]], vertices_[v][out.axes[1]]);
        out.pointSource.push_back(slices.vertexSource[begin + v]);
        out.ballScale.push_back(slices.ballScale[begin + v]);
        out.ballOpacity.push_back(slices.ballOpacity[begin + v] * opacityAtDistance(distance));
    }
}

// Adds the points at which the hyperplane cuts the edges of the slice. `polytopeFaces` is the number of 2-faces of the
// polytope, and `at` the coordinate of the hyperplane along `axis`.
void PlanarSlicer::cutEdges(const SliceSet& slices, int slice, std::uint32_t polytopeFaces, int axis, double at,
                            PlanarSection& out) {
    const std::uint32_t begin = slices.edgeBegin[slice], end = slices.edgeBegin[slice + 1];
    const std::uint32_t firstVertex = slices.vertexBegin[slice];
    const auto isAbove = [&](std::uint32_t v) { return distance_[v] > 0 || (distance_[v] == 0 && zeroIsAbove_); };
    const auto add = [&](const glm::dvec4& p, std::uint32_t source) {
        out.points.emplace_back(p[out.axes[0]], p[out.axes[1]]);
        out.pointSource.push_back(source);
        return static_cast<std::uint32_t>(out.points.size() - 1);
    };
    pointOfVertex_.assign(vertices_.size(), kNone);
    pointOfEdge_.assign(end - begin, kNone);
    const auto addVertex = [&](std::uint32_t v) {
        // The source number of the slice vertex is e or E + v (see SliceSet). In the section, it becomes F + e or F + E
        // + v (see PlanarSection).
        if (pointOfVertex_[v] == kNone)
            pointOfVertex_[v] = add(vertices_[v], polytopeFaces + slices.vertexSource[firstVertex + v]);
        return pointOfVertex_[v];
    };
    const bool isCurve = slices.faceBegin[slice] == slices.faceBegin[slice + 1];
    for (std::uint32_t e = 0; e < end - begin; ++e) {
        const auto [a, b] = slices.edges[begin + e];
        // An edge in the hyperplane belongs to a face of the slice, and cutFaces() cuts this face. But an edge of a
        // curve belongs to no face, so its ends are added here.
        if (isCurve && distance_[a] == 0 && distance_[b] == 0) {
            addVertex(a);
            addVertex(b);
        }
        if (isAbove(a) == isAbove(b)) continue;
        if (distance_[a] == 0 || distance_[b] == 0) {
            pointOfEdge_[e] = addVertex(distance_[a] == 0 ? a : b);
        } else {
            glm::dvec4 p = vertices_[a] + distance_[a] / (distance_[a] - distance_[b]) * (vertices_[b] - vertices_[a]);
            p[axis] = at;
            pointOfEdge_[e] = add(p, slices.edgeSource[begin + e]);
        }
    }
}

// Adds the edges in which the hyperplane cuts the faces of the slice. The loops that were cut from one cell form one
// face. The face contains the points around which the sum of the winding numbers of these loops is not 0 (as in
// FilledFaces).
void PlanarSlicer::cutFaces(const SliceSet& slices, int slice, PlanarSection& out) {
    const std::uint32_t begin = slices.faceBegin[slice], end = slices.faceBegin[slice + 1];
    const auto isAbove = [&](std::uint32_t v) { return distance_[v] > 0 || (distance_[v] == 0 && zeroIsAbove_); };
    for (std::uint32_t f = begin; f < end;) {
        const std::uint32_t source = slices.faceSource[f];
        crossings_.clear();
        for (; f < end && slices.faceSource[f] == source; ++f) {
            for (std::uint32_t c = slices.cornerBegin[f]; c < slices.cornerBegin[f + 1]; ++c) {
                const std::uint32_t point = pointOfEdge_[slices.cornerEdges[c]];
                if (point != kNone) crossings_.push_back({0, isAbove(slices.corners[c]) ? -1 : 1, point});
            }
        }
        if (crossings_.empty()) continue;
        const glm::dvec2 first = out.points[crossings_.front().point];
        glm::dvec2 along(0);
        for (const LoopCrossing& crossing : crossings_) {
            const glm::dvec2 offset = out.points[crossing.point] - first;
            if (std::abs(offset.x) + std::abs(offset.y) > std::abs(along.x) + std::abs(along.y)) along = offset;
        }
        const int widest = std::abs(along.x) > std::abs(along.y) ? 0 : 1;
        for (LoopCrossing& crossing : crossings_) crossing.along = out.points[crossing.point][widest];
        std::ranges::stable_sort(crossings_, {}, &LoopCrossing::along);
        int winding = 0;
        std::uint32_t from = kNone;
        for (const LoopCrossing& crossing : crossings_) {
            if (winding == 0) from = crossing.point;
            winding += crossing.winding;
            if (winding == 0 && from != crossing.point) {
                out.edges.push_back({from, crossing.point});
                out.edgeSource.push_back(source);
            }
        }
    }
}

void PlanarSlicer::findBoundary(PlanarSection& section) {
    const std::size_t count = section.points.size();
    if (count < 3 || section.edges.size() != count) return;
    std::vector<std::array<std::uint32_t, 2>> neighbors(count, {kNone, kNone});
    for (const auto& [a, b] : section.edges) {
        for (const auto& [from, to] : {std::array{a, b}, std::array{b, a}}) {
            auto& both = neighbors[from];
            if (both[1] != kNone) return;  // more than two edges meet at a point
            both[both[0] == kNone ? 0 : 1] = to;
        }
    }
    std::uint32_t previous = kNone, at = 0;
    do {
        section.boundary.push_back(at);
        if (neighbors[at][1] == kNone) break;  // the polygon is not closed
        const std::uint32_t next = neighbors[at][0] == previous ? neighbors[at][1] : neighbors[at][0];
        previous = at;
        at = next;
    } while (at != 0 && section.boundary.size() < count);
    if (at != 0 || section.boundary.size() != count) section.boundary.clear();
}

}  // namespace oval4d::slicing
