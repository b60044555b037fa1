#include "render/slices.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/geometric.hpp>

namespace oval4d::render {

using geometry::SliceSet;

/// One slice with all that painting it needs.
struct SlicePainter::Slice {
    const geometry::Polytope& polytope;
    const SliceSet& set;
    const scene::Scene& scene;
    const glm::dmat4& toView;
    std::size_t number;

    std::size_t firstVertex() const { return set.vertexBegin[number]; }
    std::size_t firstEdge() const { return set.edgeBegin[number]; }
    std::size_t firstFace() const { return set.faceBegin[number]; }
    std::size_t vertices() const { return set.vertexBegin[number + 1] - firstVertex(); }
    std::size_t edges() const { return set.edgeBegin[number + 1] - firstEdge(); }
    std::size_t faces() const { return set.faceBegin[number + 1] - firstFace(); }
    const std::array<std::uint32_t, 2>& edge(std::size_t e) const { return set.edges[firstEdge() + e]; }

    /// Where the loop of face f lies in the set's corners.
    std::pair<std::size_t, std::size_t> loop(std::size_t f) const {
        return {set.cornerBegin[firstFace() + f], set.cornerBegin[firstFace() + f + 1]};
    }

    scene::Colour tint(std::size_t f) const {
        return scene.cellColours[scene::tintOf(polytope, scene.presences, set.faceOf[firstFace() + f])];
    }
    float opacity(scene::Presence presence) const { return static_cast<float>(scene::opacityOf(presence)); }
    float vertexOpacity(std::size_t v) const {
        return opacity(scene.presences.vertex(set.vertexOf[firstVertex() + v]));
    }
    float edgeOpacity(std::size_t e) const { return opacity(scene.presences.edge(set.edgeOf[firstEdge() + e])); }
    float faceOpacity(std::size_t f) const { return opacity(scene.presences.face(set.faceOf[firstFace() + f])); }
};

void SlicePainter::paint(const geometry::Polytope& polytope, const SliceSet& slices, const scene::Scene& scene,
                         Solids& out) {
    const glm::dmat4 toView = scene.camera.view();
    out.lookThrough(Lens::of(scene.camera, scene.viewport));
    standOrder_.clear();
    for (std::uint32_t i = 0; i < scene.stands.size(); ++i)
        if (scene.stands[i].drawn && slices.vertexBegin[i] < slices.vertexBegin[i + 1]) standOrder_.push_back(i);
    const auto distance = [&](std::uint32_t i) {
        const glm::dvec3 d = scene.stands[i].position - scene.camera.eye;
        return glm::dot(d, d);
    };
    // Equal distances are kept in one order, so that equal scenes give equal pictures.
    std::sort(standOrder_.begin(), standOrder_.end(), [&](std::uint32_t a, std::uint32_t b) {
        const double da = distance(a), db = distance(b);
        return da != db ? da > db : a < b;
    });
    for (const std::uint32_t i : standOrder_) paintSlice({polytope, slices, scene, toView, i}, out);
}

void SlicePainter::paintSlice(const Slice& slice, Solids& out) {
    place(slice);
    classify(slice);
    sortByDepth(slice);
    for (const Side side : {Side::away, Side::toward}) {
        if (slice.scene.look.parts.faces) paintFaces(slice, side, out);
        paintFrame(slice, side, out);
    }
}

void SlicePainter::place(const Slice& slice) {
    const glm::mat3 turn(glm::dmat3(slice.toView) * slice.scene.scale);
    const glm::vec3 origin(slice.toView * glm::dvec4(slice.scene.stands[slice.number].position, 1));
    points_.resize(slice.vertices());
    for (std::size_t i = 0; i < points_.size(); ++i)
        points_[i] = turn * glm::vec3(slice.set.vertices[slice.firstVertex() + i]) + origin;
}

/// A vertex or an edge is on the side of the eye if any of its faces is.
void SlicePainter::classify(const Slice& slice) {
    vertexSide_.assign(slice.vertices(), Side::away);
    edgeSide_.assign(slice.edges(), Side::away);
    faceSide_.resize(slice.faces());
    normals_.resize(slice.faces());
    for (std::size_t f = 0; f < slice.faces(); ++f) {
        const auto [begin, end] = slice.loop(f);
        const glm::vec3& first = points_[slice.set.corners[begin]];
        glm::vec3 area(0);
        for (std::size_t i = begin + 2; i < end; ++i)
            area += glm::cross(points_[slice.set.corners[i - 1]] - first, points_[slice.set.corners[i]] - first);
        const float length = glm::length(area);
        normals_[f] = length > 0 ? area / length : glm::vec3(0, 0, 1);
        faceSide_[f] = glm::dot(area, first) < 0 ? Side::toward : Side::away;
        if (faceSide_[f] == Side::away) continue;
        for (std::size_t i = begin; i < end; ++i) {
            vertexSide_[slice.set.corners[i]] = Side::toward;
            edgeSide_[slice.set.cornerEdges[i]] = Side::toward;
        }
    }
}

/// Vertices from far to near, and each edge with its farther vertex. Drawn so, a bar lies over the ball that it comes
/// from and under the ball that it goes to.
void SlicePainter::sortByDepth(const Slice& slice) {
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
    // Each entry is now where its edges end; filling from the back leaves it where they begin.
    for (std::size_t e = slice.edges(); e-- > 0;) edgeOrder_[--edgeBegin_[farther(e)]] = static_cast<std::uint32_t>(e);
}

void SlicePainter::paintFaces(const Slice& slice, Side side, Solids& out) {
    const auto opacity = static_cast<float>(scene::style().faceOpacity);
    const bool soft = !slice.scene.look.parts.bars;
    for (std::size_t f = 0; f < slice.faces(); ++f) {
        if (faceSide_[f] != side) continue;
        const float presence = slice.faceOpacity(f);
        if (presence == 0) continue;
        const auto [begin, end] = slice.loop(f);
        corners_.clear();
        for (std::size_t i = begin; i < end; ++i) corners_.push_back(points_[slice.set.corners[i]]);
        out.face(corners_, normals_[f], slice.tint(f), opacity * presence, soft);
    }
}

void SlicePainter::paintFrame(const Slice& slice, Side side, Solids& out) {
    const scene::Style& style = scene::style();
    const scene::Parts& parts = slice.scene.look.parts;
    const auto barRadius = static_cast<float>(slice.scene.barRadius);
    // Without balls, bars meet in round joints.
    const auto ballRadius = parts.balls ? static_cast<float>(slice.scene.ballRadius) : barRadius;
    const scene::Colour ballColour = parts.balls ? style.ball : style.bar;
    // A bar begins where it comes out of its ball.
    const float inBall = std::sqrt(std::max(ballRadius * ballRadius - barRadius * barRadius, 0.0f));
    const bool balls = parts.balls || parts.bars;

    for (std::size_t i = 0; i < order_.size(); ++i) {
        const std::uint32_t v = order_[i];
        if (balls && vertexSide_[v] == side) out.ball(points_[v], ballRadius, ballColour, slice.vertexOpacity(v));
        if (!parts.bars) continue;
        for (std::size_t k = edgeBegin_[i]; k < edgeBegin_[i + 1]; ++k) {
            const std::uint32_t e = edgeOrder_[k];
            if (edgeSide_[e] != side) continue;
            const float opacity = slice.edgeOpacity(e);
            if (opacity == 0) continue;
            const glm::vec3 &from = points_[v], &to = points_[slice.edge(e)[slice.edge(e)[0] == v ? 1 : 0]];
            const float length = glm::length(to - from);
            if (length <= 2 * inBall) continue;
            const glm::vec3 cut = (to - from) * (inBall / length);
            out.bar(from + cut, to - cut, barRadius, style.bar, opacity);
        }
    }
}

}  // namespace oval4d::render
