#pragma once
// What the painters of slices share.

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "geometry/slice_set.hpp"
#include "render/solids.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// One slice with all that painting it needs.
struct SliceView {
    const geometry::Polytope& polytope;
    const geometry::SliceSet& set;
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

    scene::Colour tintOf(std::uint32_t of) const {
        return scene.cellColours[scene::tintOf(polytope, scene.presences, of)];
    }
    scene::Colour tint(std::size_t f) const { return tintOf(set.faceOf[firstFace() + f]); }
    float opacity(scene::Presence presence) const { return static_cast<float>(scene::opacityOf(presence)); }
    scene::Presence vertexPresence(std::size_t v) const {
        return scene.presences.vertex(set.vertexOf[firstVertex() + v]);
    }
    scene::Presence edgePresence(std::size_t e) const { return scene.presences.edge(set.edgeOf[firstEdge() + e]); }
    float vertexOpacity(std::size_t v) const { return opacity(vertexPresence(v)); }
    float edgeOpacity(std::size_t e) const { return opacity(edgePresence(e)); }
    float faceOpacity(std::size_t f) const { return opacity(scene.presences.face(set.faceOf[firstFace() + f])); }
};

/// From the slice's own axes to view axes.
class Placing {
  public:
    explicit Placing(const SliceView& slice)
        : turn_(glm::dmat3(slice.toView) * slice.scene.scale),
          origin_(slice.toView * glm::dvec4(slice.scene.stands[slice.number].position, 1)) {}
    glm::vec3 operator()(const glm::dvec3& point) const { return turn_ * glm::vec3(point) + origin_; }

  private:
    glm::mat3 turn_;
    glm::vec3 origin_;
};

/// How balls and bars look. Without balls, bars meet in round joints.
struct Frame {
    bool balls, bars;
    float ballRadius, barRadius;
    scene::Colour ballColour, barColour;
    float inBall;  ///< so far from its end a bar comes out of the ball

    explicit Frame(const scene::Scene& scene)
        : balls(scene.look.parts.balls || scene.look.parts.bars),
          bars(scene.look.parts.bars),
          ballRadius(static_cast<float>(scene.look.parts.balls ? scene.ballRadius : scene.barRadius)),
          barRadius(static_cast<float>(scene.barRadius)),
          ballColour(scene.look.parts.balls ? scene::style().ball : scene::style().bar),
          barColour(scene::style().bar),
          inBall(std::sqrt(std::max(ballRadius * ballRadius - barRadius * barRadius, 0.0f))) {}

    /// Adds what of a bar shows between the balls at its ends, of which `from` is the farther.
    void bar(const glm::vec3& from, const glm::vec3& to, float opacity, Solids& out) const {
        const float length = glm::length(to - from);
        if (opacity == 0 || length <= 2 * inBall) return;
        const glm::vec3 cut = (to - from) * (inBall / length);
        out.bar(from + cut, to - cut, barRadius, barColour, opacity);
    }
};

}  // namespace oval4d::render
