#include "export/drawing/projection_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace oval4d::exports {

namespace {

using slicing::SliceSet;

constexpr scene::Color kNear = 0x2b3340, kFar = 0x8a93a3, kHalo = 0xffffff;
// The width of the gap that a bar makes in the bars behind it, as a multiple of the bar's width.
constexpr double kHaloWidth = 1.8;

scene::Color mixColors(scene::Color a, scene::Color b, double t) {
    scene::Color mixed = 0;
    for (const int shift : {16, 8, 0}) {
        const double from = a >> shift & 255, to = b >> shift & 255;
        mixed |= static_cast<scene::Color>(std::lround(from + t * (to - from))) << shift;
    }
    return mixed;
}

// The width of the lines that show bars, as a fraction of the width of the same bars in pictures.
constexpr double kThickness = 0.8;

class ProjectionDrawer {
  public:
    explicit ProjectionDrawer(const scene::Scene& scene) : scene_(scene), view_(glm::dmat3(scene.camera.view())) {
        // The projection lies in a sphere with the radius ProjectionPlacement::radius, in world units. The sphere fills
        // the drawing, except for the margins.
        scale_ = (kDrawingWidth / 2 - kDrawingMargin) / scene.projectionPlacement.radius;
    }

    ShapeGroup draw() {
        for (std::size_t part = 0; part < scene_.projection.parts.size(); ++part) addPart(part);
        std::vector<std::pair<double, std::size_t>> order;
        for (std::size_t i = 0; i < depths_.size(); ++i) order.emplace_back(depths_[i], i);
        std::ranges::sort(order);
        ShapeGroup group{"projection", {}};
        for (const auto& [depth, i] : order) group.shapes.push_back(std::move(shapes_[i]));
        return group;
    }

  private:
    // Adds a shape at a depth. The depth increases toward the viewer.
    template <typename S>
    void add(double depth, S shape) {
        depths_.push_back(depth);
        shapes_.emplace_back(std::move(shape));
    }

    glm::dvec3 toViewSpace(const glm::dvec3& p) const { return view_ * (scene_.projection.scale * scale_ * p); }
    static glm::dvec2 paperPosition(const glm::dvec3& p) { return {kDrawingWidth / 2 + p.x, kDrawingWidth / 2 - p.y}; }

    // Returns the color of a bar or ball at a depth. Part 0 of the projection is the object, and all other parts are
    // sections.
    scene::Color barOrBallColorAt(std::size_t part, double depth) const {
        const scene::Color focus = scene_.style().axes[3];
        if (part > 0) return scene_.projection.parts[part].barColor == focus ? focus : kFar;
        const double reach = scale_ * scene_.projectionPlacement.radius;
        return mixColors(kFar, kNear, std::clamp((depth / reach + 1) / 2, 0.0, 1.0));
    }

    // Adds a polygon with these corners, in the units of the object.
    void addPolygon(std::span<const glm::dvec3> corners, scene::Color color, double opacity) {
        FilledPolygon polygon{{}, color, opacity};
        double depth = 0;
        for (const glm::dvec3& corner : corners) {
            const glm::dvec3 p = toViewSpace(corner);
            polygon.corners.push_back(paperPosition(p));
            depth += p.z / static_cast<double>(corners.size());
        }
        add(depth, std::move(polygon));
    }

    // Adds a loop (a closed polygon of a face) of a part as a polygon.
    void addFaceLoop(std::size_t part, std::uint32_t loop, double opacity) {
        const SliceSet& set = scene_.projection.elements;
        corners_.clear();
        for (std::uint32_t c = set.cornerBegin[loop]; c < set.cornerBegin[loop + 1]; ++c)
            corners_.push_back(set.vertices[set.vertexBegin[part] + set.corners[c]]);
        addPolygon(corners_, scene_.cellColors[scene_.projection.faceCells[loop]], opacity);
    }

    void addFaces(std::size_t part) {
        const scene::ObjectProjection& projection = scene_.projection;
        const SliceSet& set = projection.elements;
        const double opacity = projection.parts[part].faceOpacity;
        if (opacity == 0) return;
        const auto opacityOf = [&](std::uint32_t source) {
            return opacity * slicing::opacityOf(scene_.visibilities.face(source));
        };
        if (!projection.drawsPieces(part)) {
            for (std::uint32_t f = set.faceBegin[part]; f < set.faceBegin[part + 1]; ++f) {
                if (const double own = opacityOf(set.faceSource[f]); own > 0) addFaceLoop(part, f, own);
            }
            return;
        }
        // A face with one loop, such as a star, is drawn as this loop: the loop fills the same region as the pieces of
        // the face, but without seams between them. Only faces with several loops are drawn in pieces.
        const slicing::FilledFaces& fill = projection.fill;
        for (std::uint32_t f = fill.faceBegin[part]; f < fill.faceBegin[part + 1]; ++f) {
            const slicing::FilledFaces::FilledFace& face = fill.faces[f];
            const double own = opacityOf(face.source);
            if (own == 0) continue;
            if (face.endLoop - face.firstLoop == 1) {
                addFaceLoop(part, face.firstLoop, own);
                continue;
            }
            for (std::uint32_t k = fill.pieceBegin[f]; k < fill.pieceBegin[f + 1]; ++k) {
                const std::uint32_t begin = fill.cornerBegin[k], end = fill.cornerBegin[k + 1];
                addPolygon(std::span(fill.corners).subspan(begin, end - begin),
                           scene_.cellColors[projection.fillCells[f]], own);
            }
        }
    }

    void addPart(std::size_t part) {
        const scene::ProjectionPartLook& look = scene_.projection.parts[part];
        const SliceSet& set = scene_.projection.elements;
        const scene::PictureStyle& style = scene_.style();
        const std::uint32_t v0 = set.vertexBegin[part];
        addFaces(part);
        for (std::uint32_t e = set.edgeBegin[part]; look.barRadius > 0 && e < set.edgeBegin[part + 1]; ++e) {
            const double seen = slicing::opacityOf(scene_.visibilities.edge(set.edgeSource[e]));
            if (seen == 0) continue;
            const std::uint32_t from = v0 + set.edges[e][0], to = v0 + set.edges[e][1];
            const glm::dvec3 a = toViewSpace(set.vertices[from]), b = toViewSpace(set.vertices[to]);
            const bool lit = scene_.highlight.hasEdge(set.edgeSource[e]);
            const double depth = (a.z + b.z) / 2, width = kThickness * 2 * scale_ * look.barRadius;
            // The white line is wider than the bar, and so makes a gap in the bars behind the bar. The white line is
            // shorter than the bar, so that there is no gap in bars that meet the bar at its ends.
            const glm::dvec3 gap = 0.12 * (b - a);
            add(depth, LineSegment{.from = paperPosition(a + gap),
                                   .to = paperPosition(b - gap),
                                   .width = kHaloWidth * width,
                                   .color = kHalo,
                                   .opacity = 0.7 * seen});
            add(depth, LineSegment{.from = paperPosition(a),
                                   .to = paperPosition(b),
                                   .width = width,
                                   .color = lit ? style.highlight : barOrBallColorAt(part, depth),
                                   .roundEnds = set.hasBall(from) && set.hasBall(to),
                                   .opacity = seen});
        }
        for (std::uint32_t v = v0; look.ballRadius > 0 && v < set.vertexBegin[part + 1]; ++v) {
            const double seen = slicing::opacityOf(scene_.visibilities.vertex(set.vertexSource[v]));
            if (seen == 0 || !set.hasBall(v)) continue;
            const glm::dvec3 p = toViewSpace(set.vertices[v]);
            const double own = set.ballScale.empty() ? 1 : set.ballScale[v];
            const double opacity = seen * (set.ballOpacity.empty() ? 1 : set.ballOpacity[v]);
            const bool lit = scene_.highlight.hasVertex(set.vertexSource[v]);
            add(p.z + scale_ * look.ballRadius, Disk{paperPosition(p), scale_ * look.ballRadius * own,
                                                     lit ? style.highlight : barOrBallColorAt(part, p.z), opacity});
        }
    }

    const scene::Scene& scene_;
    const glm::dmat3 view_;
    double scale_ = 1;            // drawing units per world unit
    std::vector<double> depths_;  // the depth of each shape in shapes_
    std::vector<DrawnShape> shapes_;
    std::vector<glm::dvec3> corners_;  // corners of the current loop
};

}  // namespace

Drawing drawProjection(const scene::Scene& scene) {
    const bool perspective = scene.look.projection.kind == scene::ProjectionKind::perspective;
    Drawing drawing{std::string(perspective ? "Perspective" : "Orthogonal") + " projection: " + scene.title,
                    kDrawingWidth,
                    kDrawingWidth,
                    {}};
    drawing.groups.push_back(ProjectionDrawer(scene).draw());
    return drawing;
}

}  // namespace oval4d::exports
