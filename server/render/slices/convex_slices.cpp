#include "render/slices/convex_slices.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/geometric.hpp>

namespace oval4d::render {

void ConvexShapeCollector::collect(const scene::Scene& scene, ShapeBatch& out, const std::function<void()>& painted) {
    const glm::dmat4 toView = scene.camera.view();
    out.setProjection(ViewProjection::fromCamera(scene.camera, scene.viewport));
    placementOrder_.clear();
    for (std::uint32_t i = 0; i < scene.placements.size(); ++i)
        if (scene.placements[i].drawn && scene.slices->vertexBegin[i] < scene.slices->vertexBegin[i + 1])
            placementOrder_.push_back(i);
    const auto distance = [&](std::uint32_t i) {
        const glm::dvec3 d = scene.placements[i].position - scene.camera.eye;
        return glm::dot(d, d);
    };
    // Slices at the same distance are sorted by index, so that equal scenes give equal pictures.
    std::sort(placementOrder_.begin(), placementOrder_.end(), [&](std::uint32_t a, std::uint32_t b) {
        const double da = distance(a), db = distance(b);
        return da != db ? da > db : a < b;
    });
    for (const std::uint32_t i : placementOrder_) {
        paintSlice({*scene.slices, scene, toView, i}, out);
        painted();
    }
}

void ConvexShapeCollector::paintSlice(const SliceRef& slice, ShapeBatch& out) {
    transformVertices(slice);
    classifyFrontAndBack(slice);
    sortVerticesAndEdgesByDepth(slice);
    for (const FacingDirection side : {FacingDirection::away, FacingDirection::toward}) {
        if (slice.scene.look.parts.faces) paintFaces(slice, side, out);
        paintSkeleton(slice, side, out);
    }
}

void ConvexShapeCollector::transformVertices(const SliceRef& slice) {
    const SliceTransform transform(slice);
    points_.resize(slice.vertices());
    for (std::size_t i = 0; i < points_.size(); ++i)
        points_[i] = transform(slice.set.vertices[slice.firstVertex() + i]);
}

/// Finds which faces are turned toward the eye, and which edges and vertices belong to at least one of these faces.
void ConvexShapeCollector::classifyFrontAndBack(const SliceRef& slice) {
    vertexSide_.assign(slice.vertices(), FacingDirection::away);
    edgeSide_.assign(slice.edges(), FacingDirection::away);
    faceSide_.resize(slice.faces());
    normals_.resize(slice.faces());
    for (std::size_t f = 0; f < slice.faces(); ++f) {
        const auto [begin, end] = slice.faceLoopRange(f);
        const glm::vec3& first = points_[slice.set.corners[begin]];
        glm::vec3 area(0);
        for (std::size_t i = begin + 2; i < end; ++i)
            area += glm::cross(points_[slice.set.corners[i - 1]] - first, points_[slice.set.corners[i]] - first);
        const float length = glm::length(area);
        normals_[f] = length > 0 ? area / length : glm::vec3(0, 0, 1);
        faceSide_[f] = glm::dot(area, first) < 0 ? FacingDirection::toward : FacingDirection::away;
        if (faceSide_[f] == FacingDirection::away) continue;
        for (std::size_t i = begin; i < end; ++i) {
            vertexSide_[slice.set.corners[i]] = FacingDirection::toward;
            edgeSide_[slice.set.cornerEdges[i]] = FacingDirection::toward;
        }
    }
}

/// Sorts vertices from far to near, and groups edges by their farther vertex. Drawn in this order, a bar covers the
/// ball at its far end, and the ball at its near end covers the bar.
void ConvexShapeCollector::sortVerticesAndEdgesByDepth(const SliceRef& slice) {
    order_.resize(slice.vertices());
    std::iota(order_.begin(), order_.end(), 0u);
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
        return points_[a].z != points_[b].z ? points_[a].z < points_[b].z : a < b;
    });
    rank_.resize(order_.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) rank_[order_[i]] = i;

    edgeBegin_.assign(order_.size() + 1, 0);
    edgeOrder_.resize(slice.edges());
    const auto farther = [&](std::size_t e) { return std::min(rank_[slice.edge(e)[0]], rank_[slice.edge(e)[1]]); };
    for (std::size_t e = 0; e < slice.edges(); ++e) ++edgeBegin_[farther(e)];
    std::partial_sum(edgeBegin_.begin(), edgeBegin_.end(), edgeBegin_.begin());
    // Entry i of edgeBegin_ is now the end, in edgeOrder_, of the edges whose farther vertex has rank i. The loop fills
    // edgeOrder_ backward, and so turns the entry into the beginning of these edges.
    for (std::size_t e = slice.edges(); e-- > 0;) edgeOrder_[--edgeBegin_[farther(e)]] = static_cast<std::uint32_t>(e);
}

void ConvexShapeCollector::paintFaces(const SliceRef& slice, FacingDirection side, ShapeBatch& out) {
    const auto opacity = static_cast<float>(slice.scene.faceOpacity);
    const bool soft = !slice.scene.look.parts.bars;
    for (std::size_t f = 0; f < slice.faces(); ++f) {
        if (faceSide_[f] != side) continue;
        const float visibility = slice.faceVisibilityFactor(f);
        if (visibility == 0) continue;
        const auto [begin, end] = slice.faceLoopRange(f);
        corners_.clear();
        for (std::size_t i = begin; i < end; ++i) corners_.push_back(points_[slice.set.corners[i]]);
        out.addFace(corners_, normals_[f], slice.faceColor(f), opacity * visibility, soft);
    }
}

void ConvexShapeCollector::paintSkeleton(const SliceRef& slice, FacingDirection side, ShapeBatch& out) {
    const SkeletonStyle skeleton(slice.scene);
    for (std::size_t i = 0; i < order_.size(); ++i) {
        const std::uint32_t v = order_[i];
        if (skeleton.balls && vertexSide_[v] == side)
            out.addBall(points_[v], skeleton.ballRadius * slice.ballScale(v), slice.vertexColor(v, skeleton.ballColor),
                        slice.vertexOpacity(v));
        if (!skeleton.bars) continue;
        for (std::size_t k = edgeBegin_[i]; k < edgeBegin_[i + 1]; ++k) {
            const std::uint32_t e = edgeOrder_[k];
            if (edgeSide_[e] != side) continue;
            const glm::vec3& to = points_[slice.edge(e)[slice.edge(e)[0] == v ? 1 : 0]];
            skeleton.addBarBetweenBalls(points_[v], to, slice.edgeColor(e, skeleton.barColor), slice.edgeOpacity(e),
                                        out);
        }
    }
}

}  // namespace oval4d::render
