#include "render/regions.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

namespace oval4d::render {

using scene::Partition;

void RegionPainter::paint(const SliceView& slice, Solids& out) {
    const scene::Camera& camera = slice.scene.camera;
    const glm::dvec3 eye = (camera.eye - slice.scene.stands[slice.number].position) / slice.scene.scale;
    const Work work{slice, Placing(slice), Frame(slice.scene), eye, glm::normalize(camera.target - camera.eye), out};
    items_.clear();
    collect(work);
    paintRegion(work, slice.scene.partition.root(slice.number), 0, items_.size());
}

void RegionPainter::collect(const Work& work) {
    const SliceView& slice = work.slice;
    const glm::dvec3* vertices = slice.set.vertices.data() + slice.firstVertex();
    if (work.frame.balls) {
        for (std::uint32_t v = 0; v < slice.vertices(); ++v) {
            if (slice.vertexOpacity(v) > 0) items_.push_back({vertices[v], vertices[v], v, true, false});
        }
    }
    if (!work.frame.bars) return;
    const double inBall = work.frame.inBall / slice.scene.scale;
    for (std::uint32_t e = 0; e < slice.edges(); ++e) {
        if (slice.edgeOpacity(e) == 0) continue;
        glm::dvec3 from = vertices[slice.edge(e)[0]], to = vertices[slice.edge(e)[1]];
        const double length = glm::distance(from, to);
        if (length <= 2 * inBall) continue;
        if (glm::dot(to - from, work.forward) > 0) std::swap(from, to);
        const glm::dvec3 cut = (to - from) * (inBall / length);
        items_.push_back({from + cut, to - cut, e, false, false});
    }
}

// Paints the part of the tree from this node on, with the balls and bars items_[begin] … items_[end − 1] in its region.
void RegionPainter::paintRegion(const Work& work, std::uint32_t number, std::size_t begin, std::size_t end) {
    if (number == Partition::kCovered) return;
    if (number == Partition::kNone) return paintItems(work, begin, end);
    const Partition& partition = work.slice.scene.partition;
    const Partition::Node& node = partition.node(number);
    const bool eyeAbove = node.height(work.eye) > 0;
    const double towardEye = eyeAbove ? 1 : -1;
    const std::size_t far = items_.size();
    for (const bool behind : {true, false}) {
        const std::size_t first = items_.size();
        for (std::size_t i = begin; i < end; ++i) {
            const Item item = items_[i];
            part(item, towardEye * node.height(item.from), towardEye * node.height(item.to), partition.tiny(), behind);
        }
        const std::uint32_t child = behind == eyeAbove ? node.below : node.above;
        paintRegion(work, child, first, items_.size());
        items_.resize(far);
        if (behind) paintPieces(work, number);
    }
}

// Adds what there is of an item on one side of a plane, whose heights at its ends are given.
void RegionPainter::part(const Item& item, double from, double to, double tiny, bool far) {
    const auto isFar = [tiny](double height) { return height < -tiny; };
    const auto isNear = [tiny](double height) { return height > tiny; };
    if (!(isFar(from) && isNear(to)) && !(isNear(from) && isFar(to))) {
        if ((isFar(from) || isFar(to)) == far) items_.push_back(item);
        return;
    }
    const glm::dvec3 between = item.from + (item.to - item.from) * (from / (from - to));
    Item part = item;
    if (isFar(from) == far) {
        part.to = between;
    } else {
        part.from = between;
        part.cut = true;
    }
    items_.push_back(part);
}

void RegionPainter::paintPieces(const Work& work, std::uint32_t number) {
    if (!work.slice.scene.look.parts.faces) return;
    const scene::Scene& scene = work.slice.scene;
    const Partition::Node& node = scene.partition.node(number);
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const Partition::Piece& piece = scene.partition.piece(i);
        if (piece.begin == piece.end) continue;
        const geometry::Fill::Patch& patch = scene.partition.patch(piece);
        const float opacity = work.slice.opacity(scene.presences.face(patch.of));
        corners_.clear();
        for (std::uint32_t c = piece.begin; c < piece.end; ++c)
            corners_.push_back(work.placing(scene.partition.corner(c)));
        const glm::vec3 normal(glm::dmat3(work.slice.toView) * patch.normal);
        work.out.face(corners_, normal, work.slice.tintOf(patch.of),
                      static_cast<float>(scene::style().faceOpacity) * opacity, false);
    }
}

// Of one region, from far to near: a bar after the ball that it comes from, before the one that it goes to.
void RegionPainter::paintItems(const Work& work, std::size_t begin, std::size_t end) {
    const auto at = [this](std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::sort(at(begin), at(end), [&](const Item& a, const Item& b) {
        const double da = glm::dot(a.from, work.forward), db = glm::dot(b.from, work.forward);
        return da != db ? da > db : a.element < b.element;
    });
    const Frame& frame = work.frame;
    for (std::size_t i = begin; i < end; ++i) {
        const Item& item = items_[i];
        if (item.ball) {
            work.out.ball(work.placing(item.from), frame.ballRadius, frame.ballColour,
                          work.slice.vertexOpacity(item.element));
        } else {
            work.out.bar(work.placing(item.from), work.placing(item.to), frame.barRadius, frame.barColour,
                         work.slice.edgeOpacity(item.element), !item.cut);
        }
    }
}

}  // namespace oval4d::render
