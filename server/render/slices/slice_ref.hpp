#pragma once
// Access to the elements of one slice of a scene, and their appearance.

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "render/slices/shape_batch.hpp"
#include "scene/scene.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::render {

/// A reference to one slice of a scene. The parameters v, e and f of its functions are the indices of a vertex, an edge
/// and a face within the slice.
struct SliceRef {
    const slicing::SliceSet& set;
    const scene::Scene& scene;
    const glm::dmat4& toView;  ///< the matrix from world coordinates to view coordinates
    std::size_t number;        ///< the index of the slice in `set`

    std::size_t firstVertex() const { return set.vertexBegin[number]; }
    std::size_t firstEdge() const { return set.edgeBegin[number]; }
    std::size_t firstFace() const { return set.faceBegin[number]; }
    std::size_t vertices() const { return set.vertexBegin[number + 1] - firstVertex(); }
    std::size_t edges() const { return set.edgeBegin[number + 1] - firstEdge(); }
    std::size_t faces() const { return set.faceBegin[number + 1] - firstFace(); }
    const std::array<std::uint32_t, 2>& edge(std::size_t e) const { return set.edges[firstEdge() + e]; }

    /// Returns the loop of face f as a half-open range of indices into SliceSet::corners.
    std::pair<std::size_t, std::size_t> faceLoopRange(std::size_t f) const {
        return {set.cornerBegin[firstFace() + f], set.cornerBegin[firstFace() + f + 1]};
    }

    scene::Color faceColor(std::size_t f) const { return scene.cellColors[scene.coloringCellOfFace(firstFace() + f)]; }
    /// Returns the color of vertex v or edge e: the highlight color if the vertex or edge belongs to the highlighted
    /// element, else `usual`.
    scene::Color vertexColor(std::size_t v, scene::Color usual) const {
        return scene.highlight.hasVertex(set.vertexSource[firstVertex() + v]) ? scene.style().highlight : usual;
    }
    scene::Color edgeColor(std::size_t e, scene::Color usual) const {
        return scene.highlight.hasEdge(set.edgeSource[firstEdge() + e]) ? scene.style().highlight : usual;
    }
    float opacity(slicing::Visibility visibility) const { return static_cast<float>(slicing::opacityOf(visibility)); }
    slicing::Visibility vertexVisibility(std::size_t v) const {
        return scene.visibilities.vertex(set.vertexSource[firstVertex() + v]);
    }
    slicing::Visibility edgeVisibility(std::size_t e) const {
        return scene.visibilities.edge(set.edgeSource[firstEdge() + e]);
    }
    /// Returns the opacity of the ball at vertex v: 0 … 1.
    float vertexOpacity(std::size_t v) const {
        const float own = set.ballOpacity.empty() ? 1 : set.ballOpacity[firstVertex() + v];
        return own * opacity(vertexVisibility(v));
    }
    /// Returns the factor by which the radius of the ball at vertex v is multiplied; usually 1.
    float ballScale(std::size_t v) const { return set.ballScale.empty() ? 1 : set.ballScale[firstVertex() + v]; }
    float edgeOpacity(std::size_t e) const { return opacity(edgeVisibility(e)); }
    /// Returns the factor, 0 … 1, by which Scene::faceOpacity is multiplied because of the visibility of face f.
    float faceVisibilityFactor(std::size_t f) const {
        return opacity(scene.visibilities.face(set.faceSource[firstFace() + f]));
    }
};

/// Transforms points from slice coordinates (in the units of the object, relative to the origin of the slice) to view
/// coordinates.
class SliceTransform {
  public:
    explicit SliceTransform(const SliceRef& slice)
        : SliceTransform(slice.toView, slice.scene.placements[slice.number].position, slice.scene.scale) {}
    /// `position` is the origin of the slice in world coordinates. `scale` is the number of world units per unit of the
    /// object.
    SliceTransform(const glm::dmat4& toView, const glm::dvec3& position, double scale)
        : turn_(glm::dmat3(toView) * scale), origin_(toView * glm::dvec4(position, 1)) {}
    glm::vec3 operator()(const glm::dvec3& point) const { return turn_ * glm::vec3(point) + origin_; }

  private:
    glm::mat3 turn_;
    glm::vec3 origin_;
};

/// The appearance of balls and bars. Lengths are in world units. `ballRadius` and `ballColor` are the results of
/// Scene::drawnBallRadius() and Scene::drawnBallColor().
struct SkeletonStyle {
    bool balls, bars;
    float ballRadius, barRadius;
    scene::Color ballColor, barColor;
    float hiddenEndLength;  ///< the length of the part of a bar that is inside the ball at one end

    explicit SkeletonStyle(const scene::Scene& scene)
        : balls(scene.drawnBallRadius() > 0),
          bars(scene.look.parts.bars),
          ballRadius(static_cast<float>(scene.drawnBallRadius())),
          barRadius(static_cast<float>(scene.barRadius)),
          ballColor(scene.drawnBallColor()),
          barColor(scene.style().bar),
          hiddenEndLength(std::sqrt(std::max(ballRadius * ballRadius - barRadius * barRadius, 0.0f))) {}

    /// Adds to `out` the part of a bar that is outside the balls at its ends, if there is such a part. `from` must be
    /// the end that is farther from the eye.
    void addBarBetweenBalls(const glm::vec3& from, const glm::vec3& to, scene::Color color, float opacity,
                            ShapeBatch& out) const {
        const float length = glm::length(to - from);
        if (opacity == 0 || length <= 2 * hiddenEndLength) return;
        const glm::vec3 cut = (to - from) * (hiddenEndLength / length);
        out.addBarFromFarEnd(from + cut, to - cut, barRadius, color, opacity);
    }
};

}  // namespace oval4d::render
