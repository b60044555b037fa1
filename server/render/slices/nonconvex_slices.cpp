#include "render/slices/nonconvex_slices.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include <glm/geometric.hpp>

namespace oval4d::render {

using slicing::Visibility;

void NonconvexShapeCollector::collect(const scene::Scene& scene, Layers& out) {
    const glm::dmat4 toView = scene.camera.view();
    const auto viewOf = [&](std::size_t slice) { return SliceRef{*scene.slices, scene, toView, slice}; };
    transforms_.clear();
    points_.resize(scene.slices->vertices.size());
    for (auto* items : {&faces_, &skeleton_, &faded_}) items->clear();
    DepthRange depths{std::numeric_limits<float>::max(), 0};
    for (std::size_t i = 0; i < scene.placements.size(); ++i) {
        transforms_.emplace_back(viewOf(i));
        if (scene.placements[i].drawn) collectShapesOf(viewOf(i), depths);
    }
    const auto radius = static_cast<float>(scene.ballRadius);
    out.depths = {std::max(depths.from - radius, static_cast<float>(scene.camera.near)), depths.to + radius};

    // Shapes at the same depth are sorted by slice, kind and number, so that equal scenes give equal pictures.
    // std::stable_sort would make this comparison unnecessary, but allocates memory.
    const auto before = [](const SortedShape& a, const SortedShape& b) {
        return std::tie(a.slice, a.kind, a.number) < std::tie(b.slice, b.kind, b.number);
    };
    const auto nearer = [&](const SortedShape& a, const SortedShape& b) {
        return a.depth != b.depth ? a.depth < b.depth : before(a, b);
    };
    const auto farther = [&](const SortedShape& a, const SortedShape& b) {
        return a.depth != b.depth ? a.depth > b.depth : before(a, b);
    };
    std::sort(faces_.begin(), faces_.end(), nearer);
    std::sort(skeleton_.begin(), skeleton_.end(), farther);
    std::sort(faded_.begin(), faded_.end(), farther);
    const ViewProjection projection = ViewProjection::fromCamera(scene.camera, scene.viewport);
    const SkeletonStyle skeleton(scene);
    const auto paintAll = [&](const std::vector<SortedShape>& items, ShapeBatch& shapes) {
        shapes.begin(scene.style());
        shapes.setProjection(projection);
        for (const SortedShape& item : items) addShape(viewOf(item.slice), item, skeleton, shapes);
    };
    paintAll(faces_, out.faces);
    paintAll(skeleton_, out.skeleton);
    paintAll(faded_, out.faded);
}

// Collects the shapes of a slice, except hidden ones. Extends `depths` to include the depths of the vertices of the
// slice.
void NonconvexShapeCollector::collectShapesOf(const SliceRef& slice, DepthRange& depths) {
    const scene::Scene& scene = slice.scene;
    const auto number = static_cast<std::uint32_t>(slice.number);
    const SliceTransform& transform = transforms_[number];
    const SkeletonStyle skeleton(scene);
    glm::vec3* points = points_.data() + slice.firstVertex();
    for (std::uint32_t v = 0; v < slice.vertices(); ++v) {
        points[v] = transform(slice.set.vertices[slice.firstVertex() + v]);
        const float depth = -points[v].z;
        depths = {std::min(depths.from, depth), std::max(depths.to, depth)};
        if (skeleton.balls) addUnlessHidden({depth, ShapeKind::ball, number, v}, slice.vertexVisibility(v));
    }
    for (std::uint32_t e = 0; skeleton.bars && e < slice.edges(); ++e) {
        const auto& [a, b] = slice.edge(e);
        // A bar is sorted by the depth of its far end, so that it is drawn after everything that is farther away than
        // this end.
        addUnlessHidden({-std::min(points[a].z, points[b].z), ShapeKind::bar, number, e}, slice.edgeVisibility(e));
    }
    const slicing::FilledFaces& fill = scene.fill;
    if (fill.empty()) return;
    for (std::uint32_t f = fill.faceBegin[number]; f < fill.faceBegin[number + 1]; ++f) {
        const glm::vec3 corner = transform(fill.corners[fill.cornerBegin[fill.pieceBegin[f]]]);
        addUnlessHidden({-corner.z, ShapeKind::face, number, f}, scene.visibilities.face(fill.faces[f].source));
    }
}

void NonconvexShapeCollector::addUnlessHidden(const SortedShape& item, Visibility visibility) {
    if (visibility == Visibility::faded) faded_.push_back(item);
    if (visibility == Visibility::full) (item.kind == ShapeKind::face ? faces_ : skeleton_).push_back(item);
}

void NonconvexShapeCollector::addShape(const SliceRef& slice, const SortedShape& item, const SkeletonStyle& skeleton,
                                       ShapeBatch& out) {
    if (item.kind == ShapeKind::face) return addFace(slice, item.number, out);
    const glm::vec3* points = points_.data() + slice.firstVertex();
    if (item.kind == ShapeKind::ball) {
        out.addBall(points[item.number], skeleton.ballRadius * slice.ballScale(item.number),
                    slice.vertexColor(item.number, skeleton.ballColor), slice.vertexOpacity(item.number));
        return;
    }
    const auto& [a, b] = slice.edge(item.number);
    const bool forth = points[a].z < points[b].z;
    skeleton.addBarBetweenBalls(points[forth ? a : b], points[forth ? b : a],
                                slice.edgeColor(item.number, skeleton.barColor), slice.edgeOpacity(item.number), out);
}

void NonconvexShapeCollector::addFace(const SliceRef& slice, std::uint32_t number, ShapeBatch& out) {
    const slicing::FilledFaces& fill = slice.scene.fill;
    const slicing::FilledFaces::FilledFace& face = fill.faces[number];
    const glm::vec3 normal(glm::dmat3(slice.toView) * face.normal);
    const auto opacity =
        static_cast<float>(slice.scene.faceOpacity) * slice.opacity(slice.scene.visibilities.face(face.source));
    const scene::Color color = slice.scene.cellColors[slice.scene.fillCells[number]];
    for (std::uint32_t k = fill.pieceBegin[number]; k < fill.pieceBegin[number + 1]; ++k) {
        corners_.clear();
        for (std::uint32_t c = fill.cornerBegin[k]; c < fill.cornerBegin[k + 1]; ++c)
            corners_.push_back(transforms_[slice.number](fill.corners[c]));
        out.addFace(corners_, normal, color, opacity, false);
    }
}

}  // namespace oval4d::render
