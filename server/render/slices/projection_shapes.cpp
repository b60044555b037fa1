#include "render/slices/projection_shapes.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <tuple>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

namespace oval4d::render {

using slicing::Visibility;

void ProjectionShapeCollector::collect(const scene::Scene& scene, Layers& out) {
    const scene::ObjectProjection& projection = scene.projection;
    const slicing::SliceSet& elements = projection.elements;
    const glm::dmat4 toView = scene.camera.view();
    const glm::dvec3 origin(toView * glm::dvec4(scene.projectionPlacement.position, 1));
    const glm::dmat3 turn = glm::dmat3(toView) * projection.scale;
    points_.clear();
    for (const glm::dvec3& vertex : elements.vertices) points_.emplace_back(turn * vertex + origin);
    fillPoints_.clear();
    for (const glm::dvec3& corner : projection.fill.corners) fillPoints_.emplace_back(turn * corner + origin);
    DepthRange depths{std::numeric_limits<float>::max(), 0};
    for (const glm::vec3& point : points_) depths = {std::min(depths.from, -point.z), std::max(depths.to, -point.z)};
    float thickest = 0;
    for (const scene::ProjectionPartLook& part : projection.parts)
        thickest = std::max({thickest, static_cast<float>(part.ballRadius), static_cast<float>(part.barRadius)});
    out.depths = {std::max(depths.from - thickest, static_cast<float>(scene.camera.near)), depths.to + thickest};

    solid_.clear();
    translucent_.clear();
    for (std::uint32_t part = 0; part < projection.parts.size(); ++part) collectPart(scene, part);
    for (auto& [items, shapes] : {std::tie(solid_, out.solid), std::tie(translucent_, out.translucent)}) {
        shapes.begin(scene.style());
        shapes.setProjection(ViewProjection::fromCamera(scene.camera, scene.viewport));
        for (const DepthSorter::KeyedShape& entry : order_.sortedFarToNear(items))
            addShape(scene, items[entry.index], shapes);
    }
}

void ProjectionShapeCollector::collectPart(const scene::Scene& scene, std::uint32_t part) {
    const scene::ObjectProjection& projection = scene.projection;
    const slicing::SliceSet& elements = projection.elements;
    const scene::ProjectionPartLook& look = projection.parts[part];
    const auto add = [&](const ProjectedShape& item, Visibility visibility) {
        if (visibility == Visibility::hidden) return;
        // The bars of sections (parts other than 0) are so thin that they do not cover whole pixels. Faces must be
        // visible behind these bars. Therefore these bars belong to the translucent layer.
        const bool isSkeleton = item.kind == ShapeKind::ball || item.kind == ShapeKind::bar;
        const bool solid = isSkeleton && part == 0 && visibility == Visibility::full;
        (solid ? solid_ : translucent_).push_back(item);
    };
    const std::uint32_t first = elements.vertexBegin[part];
    if (look.ballRadius > 0) {
        for (std::uint32_t v = first; v < elements.vertexBegin[part + 1]; ++v) {
            if (!elements.hasBall(v)) continue;
            add({-points_[v].z, ShapeKind::ball, part, v}, scene.visibilities.vertex(elements.vertexSource[v]));
        }
    }
    if (look.barRadius > 0) {
        for (std::uint32_t e = elements.edgeBegin[part]; e < elements.edgeBegin[part + 1]; ++e) {
            const auto& [a, b] = elements.edges[e];
            // A bar of the object is sorted by its far end. A bar of a section is sorted by its near end, so that the
            // faces beside the bar are drawn before it and do not cover it.
            const auto [far, near] = std::minmax(points_[first + a].z, points_[first + b].z);
            add({-(part == 0 ? far : near), ShapeKind::bar, part, e}, scene.visibilities.edge(elements.edgeSource[e]));
        }
    }
    if (look.faceOpacity > 0 && projection.drawsPieces(part)) {
        const slicing::FilledFaces& fill = projection.fill;
        for (std::uint32_t f = fill.faceBegin[part]; f < fill.faceBegin[part + 1]; ++f) {
            const Visibility visibility = scene.visibilities.face(fill.faces[f].source);
            for (std::uint32_t k = fill.pieceBegin[f]; k < fill.pieceBegin[f + 1]; ++k) {
                float sum = 0;
                const std::uint32_t begin = fill.cornerBegin[k], end = fill.cornerBegin[k + 1];
                for (std::uint32_t c = begin; c < end; ++c) sum -= fillPoints_[c].z;
                add({sum / static_cast<float>(end - begin), ShapeKind::piece, part, k}, visibility);
            }
        }
    } else if (look.faceOpacity > 0) {
        for (std::uint32_t f = elements.faceBegin[part]; f < elements.faceBegin[part + 1]; ++f) {
            float sum = 0;
            const std::uint32_t begin = elements.cornerBegin[f], end = elements.cornerBegin[f + 1];
            for (std::uint32_t c = begin; c < end; ++c) sum -= points_[first + elements.corners[c]].z;
            add({sum / static_cast<float>(end - begin), ShapeKind::face, part, f},
                scene.visibilities.face(elements.faceSource[f]));
        }
    }
}

void ProjectionShapeCollector::addShape(const scene::Scene& scene, const ProjectedShape& item, ShapeBatch& out) {
    const slicing::SliceSet& elements = scene.projection.elements;
    const scene::ProjectionPartLook& part = scene.projection.parts[item.part];
    const glm::vec3* points = points_.data() + elements.vertexBegin[item.part];
    const auto opacity = [](Visibility visibility) { return static_cast<float>(slicing::opacityOf(visibility)); };
    if (item.kind == ShapeKind::ball) {
        const float scale = elements.ballScale.empty() ? 1 : elements.ballScale[item.number];
        const float own = elements.ballOpacity.empty() ? 1 : elements.ballOpacity[item.number];
        const bool lit = scene.highlight.hasVertex(elements.vertexSource[item.number]);
        out.addBall(points_[item.number], static_cast<float>(part.ballRadius) * scale,
                    lit ? scene.style().highlight : part.ballColor,
                    own * opacity(scene.visibilities.vertex(elements.vertexSource[item.number])));
    } else if (item.kind == ShapeKind::bar) {
        const auto& [a, b] = elements.edges[item.number];
        const bool forth = points[a].z < points[b].z;
        const bool lit = scene.highlight.hasEdge(elements.edgeSource[item.number]);
        out.addBarFromFarEnd(points[forth ? a : b], points[forth ? b : a], static_cast<float>(part.barRadius),
                             lit ? scene.style().highlight : part.barColor,
                             opacity(scene.visibilities.edge(elements.edgeSource[item.number])));
    } else if (item.kind == ShapeKind::face) {
        corners_.clear();
        for (std::uint32_t c = elements.cornerBegin[item.number]; c < elements.cornerBegin[item.number + 1]; ++c)
            corners_.push_back(points[elements.corners[c]]);
        addPolygon(
            scene.cellColors[scene.projection.faceCells[item.number]],
            static_cast<float>(part.faceOpacity) * opacity(scene.visibilities.face(elements.faceSource[item.number])),
            out);
    } else {
        const slicing::FilledFaces& fill = scene.projection.fill;
        corners_.assign(fillPoints_.begin() + fill.cornerBegin[item.number],
                        fillPoints_.begin() + fill.cornerBegin[item.number + 1]);
        // The face to which the piece belongs: the last face whose first piece is not after this piece.
        const auto next = std::ranges::upper_bound(fill.pieceBegin, item.number);
        const auto face = static_cast<std::size_t>(next - fill.pieceBegin.begin()) - 1;
        addPolygon(scene.cellColors[scene.projection.fillCells[face]],
                   static_cast<float>(part.faceOpacity) * opacity(scene.visibilities.face(fill.faces[face].source)),
                   out);
    }
}

// Adds the convex polygon whose corners are in corners_ to `out`.
void ProjectionShapeCollector::addPolygon(scene::Color color, float opacity, ShapeBatch& out) const {
    glm::vec3 area(0);
    for (std::size_t i = 2; i < corners_.size(); ++i)
        area += glm::cross(corners_[i - 1] - corners_[0], corners_[i] - corners_[0]);
    const float length = glm::length(area);
    out.addFace(corners_, length > 0 ? area / length : glm::vec3(0, 0, 1), color, opacity, false);
}

// The rectangle is computed from the vertices of the shapes, not from ProjectionPlacement::radius, for two reasons. Far
// from the view axis, the image of a sphere is an ellipse. And balls of a cloud may extend beyond the sphere.
PixelArea ProjectionShapeCollector::Layers::pixelArea(scene::Viewport viewport) const {
    const glm::vec2 most(viewport.width, viewport.height);
    glm::vec2 least(1), greatest(-1);
    for (const ShapeBatch* shapes : {&solid, &translucent}) {
        for (const Patch& patch : shapes->patches()) {
            least = glm::min(least, patch.least);
            greatest = glm::max(greatest, patch.greatest);
        }
    }
    const glm::vec2 from = (least * 0.5F + 0.5F) * most, to = (greatest * 0.5F + 0.5F) * most;
    // One more pixel on each side allows for rounding errors.
    const glm::vec2 first = glm::clamp(glm::floor(from) - 1.0F, glm::vec2(0), most);
    const glm::vec2 end = glm::clamp(glm::ceil(to) + 1.0F, first, most);
    return {glm::ivec2(first), glm::ivec2(end)};
}

}  // namespace oval4d::render
