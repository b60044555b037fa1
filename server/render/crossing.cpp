#include "render/crossing.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include <glm/geometric.hpp>

namespace oval4d::render {

using scene::Presence;

void CrossingPainter::paint(const geometry::Polytope& polytope, const geometry::SliceSet& slices,
                            const scene::Scene& scene, Layers& out) {
    const glm::dmat4 toView = scene.camera.view();
    const auto viewOf = [&](std::size_t slice) { return SliceView{polytope, slices, scene, toView, slice}; };
    placings_.clear();
    points_.resize(slices.vertices.size());
    for (auto* items : {&faces_, &frame_, &faded_}) items->clear();
    Range depths{std::numeric_limits<float>::max(), 0};
    for (std::size_t i = 0; i < scene.stands.size(); ++i) {
        placings_.emplace_back(viewOf(i));
        if (scene.stands[i].drawn) collect(viewOf(i), depths);
    }
    const auto radius = static_cast<float>(scene.ballRadius);
    out.depths = {std::max(depths.from - radius, static_cast<float>(scene.camera.near)), depths.to + radius};

    // Equal depths are kept in one order, so that equal scenes give equal pictures; std::stable_sort would allocate.
    const auto before = [](const Item& a, const Item& b) {
        return std::tie(a.slice, a.kind, a.number) < std::tie(b.slice, b.kind, b.number);
    };
    const auto nearer = [&](const Item& a, const Item& b) {
        return a.depth != b.depth ? a.depth < b.depth : before(a, b);
    };
    const auto farther = [&](const Item& a, const Item& b) {
        return a.depth != b.depth ? a.depth > b.depth : before(a, b);
    };
    std::sort(faces_.begin(), faces_.end(), nearer);
    std::sort(frame_.begin(), frame_.end(), farther);
    std::sort(faded_.begin(), faded_.end(), farther);
    const Lens lens = Lens::of(scene.camera, scene.viewport);
    const Frame frame(scene);
    const auto paintAll = [&](const std::vector<Item>& items, Solids& solids) {
        solids.begin(scene::style());
        solids.lookThrough(lens);
        for (const Item& item : items) paintItem(viewOf(item.slice), item, frame, solids);
    };
    paintAll(faces_, out.faces);
    paintAll(frame_, out.frame);
    paintAll(faded_, out.faded);
}

// Lists what there is of a slice, and widens `depths` to hold it.
void CrossingPainter::collect(const SliceView& slice, Range& depths) {
    const scene::Scene& scene = slice.scene;
    const auto number = static_cast<std::uint32_t>(slice.number);
    const Placing& placing = placings_[number];
    const Frame frame(scene);
    glm::vec3* points = points_.data() + slice.firstVertex();
    for (std::uint32_t v = 0; v < slice.vertices(); ++v) {
        points[v] = placing(slice.set.vertices[slice.firstVertex() + v]);
        const float depth = -points[v].z;
        depths = {std::min(depths.from, depth), std::max(depths.to, depth)};
        if (frame.balls) add({depth, Kind::ball, number, v}, slice.vertexPresence(v));
    }
    for (std::uint32_t e = 0; frame.bars && e < slice.edges(); ++e) {
        const auto& [a, b] = slice.edge(e);
        // Drawn after what is farther than its farther end.
        add({-std::min(points[a].z, points[b].z), Kind::bar, number, e}, slice.edgePresence(e));
    }
    const geometry::Fill& fill = scene.fill;
    if (fill.empty()) return;
    for (std::uint32_t p = fill.patchBegin[number]; p < fill.patchBegin[number + 1]; ++p) {
        const glm::vec3 corner = placing(fill.corners[fill.cornerBegin[fill.pieceBegin[p]]]);
        add({-corner.z, Kind::patch, number, p}, scene.presences.face(fill.patches[p].of));
    }
}

void CrossingPainter::add(const Item& item, Presence presence) {
    if (presence == Presence::faded) faded_.push_back(item);
    if (presence == Presence::full) (item.kind == Kind::patch ? faces_ : frame_).push_back(item);
}

void CrossingPainter::paintItem(const SliceView& slice, const Item& item, const Frame& frame, Solids& out) {
    if (item.kind == Kind::patch) return paintPatch(slice, item.number, out);
    const glm::vec3* points = points_.data() + slice.firstVertex();
    if (item.kind == Kind::ball) {
        out.ball(points[item.number], frame.ballRadius, frame.ballColour, slice.vertexOpacity(item.number));
        return;
    }
    const auto& [a, b] = slice.edge(item.number);
    const bool forth = points[a].z < points[b].z;
    frame.bar(points[forth ? a : b], points[forth ? b : a], slice.edgeOpacity(item.number), out);
}

void CrossingPainter::paintPatch(const SliceView& slice, std::uint32_t number, Solids& out) {
    const geometry::Fill& fill = slice.scene.fill;
    const geometry::Fill::Patch& patch = fill.patches[number];
    const glm::vec3 normal(glm::dmat3(slice.toView) * patch.normal);
    const auto opacity =
        static_cast<float>(slice.scene.faceOpacity) * slice.opacity(slice.scene.presences.face(patch.of));
    const scene::Colour tint = slice.tintOf(patch.of);
    for (std::uint32_t k = fill.pieceBegin[number]; k < fill.pieceBegin[number + 1]; ++k) {
        corners_.clear();
        for (std::uint32_t c = fill.cornerBegin[k]; c < fill.cornerBegin[k + 1]; ++c)
            corners_.push_back(placings_[slice.number](fill.corners[c]));
        out.face(corners_, normal, tint, opacity, false);
    }
}

}  // namespace oval4d::render
