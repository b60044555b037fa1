#include "export/drawing/slices_drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scene/focus_lines.hpp"

namespace oval4d::exports {

namespace {

using slicing::SliceSet;

// The least distance in front of the eye, in world units, at which shapes are drawn.
constexpr double kNearest = 1e-3;
constexpr double kDigitHeight = 0.73;            // height of a digit, as a fraction of the font size
constexpr std::size_t kTypicalShapeBytes = 150;  // approximate size of a shape in a file, in bytes

/// Returns the label with hyphens in place of minus signs (U+2212), because texts in drawings must be ASCII.
std::string withAsciiMinus(const std::string& label) {
    constexpr std::string_view kMinus = "\u2212";
    std::string text = label;
    for (std::size_t at = 0; (at = text.find(kMinus, at)) != std::string::npos; ++at)
        text.replace(at, kMinus.size(), "-");
    return text;
}

/// A map from points in view space (coordinates relative to the camera) to positions in the drawing.
class PaperProjection {
  public:
    explicit PaperProjection(const scene::Scene& scene)
        : camera_(scene.camera),
          aspect_(static_cast<double>(scene.viewport.width) / scene.viewport.height),
          height_(kDrawingWidth / aspect_) {}

    double height() const { return height_; }
    /// Returns the length, in the drawing, of one world unit at the point `seen` in view space.
    double scaleAt(const glm::dvec3& seen) const { return camera_.focalLength() * height_ / -seen.z; }
    glm::dvec2 operator()(const glm::dvec3& seen) const {
        const glm::dvec2 at = glm::dvec2(seen) * (camera_.focalLength() / -seen.z) +
                              glm::dvec2((0.5 + camera_.shiftX) * aspect_, 0.5 + camera_.shiftY);
        return {at.x * height_, (1 - at.y) * height_};
    }

  private:
    const scene::Camera& camera_;
    double aspect_, height_;
};

class SliceDrawer {
  public:
    SliceDrawer(const scene::Scene& scene, const PaperProjection& paper)
        : scene_(scene), set_(*scene.slices), style_(scene.style()), paper_(paper), view_(scene.camera.view()) {
        const double ball = scene.ballRadius, bar = scene.barRadius;
        if (scene.look.parts.balls) hiddenEnd_ = std::sqrt(std::max(ball * ball - bar * bar, 0.0));
    }

    ShapeGroup draw(std::size_t slice) {
        slice_ = slice;
        items_.clear();
        const std::uint32_t v0 = set_.vertexBegin[slice], v1 = set_.vertexBegin[slice + 1];
        points_.clear();
        for (std::uint32_t v = v0; v < v1; ++v) points_.push_back(toViewSpace(set_.vertices[v]));
        findElementsOfFrontFaces();
        if (scene_.look.parts.faces && !scene_.needsDepthBuffer) addFaces();
        if (scene_.look.parts.faces && scene_.needsDepthBuffer) addConvexPieces();
        if (scene_.drawnBallRadius() > 0) addBalls();
        if (scene_.look.parts.bars) addBars();
        std::ranges::stable_sort(items_, {},
                                 [](const LayeredShape& item) { return std::pair(item.layer, item.depth); });
        ShapeGroup group{"slice_" + std::to_string(scene_.placements[slice].index), {}};
        for (LayeredShape& item : items_) group.shapes.push_back(std::move(item.shape));
        return group;
    }

  private:
    /// The layers of a convex slice, in drawing order: faces turned away from the eye, with their bars and balls, and
    /// then faces turned toward the eye, with their bars and balls. If faces of a slice may cross, all shapes are in
    /// the first layer.
    enum Layer : std::uint8_t { away_faces, away_frame, toward_faces, toward_frame };
    struct LayeredShape {
        Layer layer;
        double depth;  ///< the depth of the shape; increases toward the viewer
        DrawnShape shape;
    };

    glm::dvec3 toViewSpace(const glm::dvec3& p) const {
        return glm::dvec3(view_ * glm::dvec4(scene_.placements[slice_].position + scene_.scale * p, 1));
    }
    static bool isBehindEye(const glm::dvec3& p) { return p.z > -kNearest; }

    std::span<const std::uint32_t> vertexNumbersOfFace(std::uint32_t face) const {
        return std::span(set_.corners)
            .subspan(set_.cornerBegin[face], set_.cornerBegin[face + 1] - set_.cornerBegin[face]);
    }

    /// Returns the normal of a polygon, with a length of twice the area of the polygon.
    static glm::dvec3 doubleAreaVectorOf(std::span<const glm::dvec3> corners) {
        glm::dvec3 area(0);
        for (std::size_t i = 2; i < corners.size(); ++i)
            area += glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
        return area;
    }

    std::vector<glm::dvec3> cornerPositionsOfFace(std::uint32_t face) const {
        std::vector<glm::dvec3> corners;
        for (const std::uint32_t v : vertexNumbersOfFace(face)) corners.push_back(points_[v]);
        return corners;
    }

    /// Sets towardVertices_ and towardEdges_, which say whether a vertex or edge belongs to a face that is turned
    /// toward the eye.
    void findElementsOfFrontFaces() {
        towardVertices_.assign(points_.size(), false);
        towardEdges_.assign(set_.edgeBegin[slice_ + 1] - set_.edgeBegin[slice_], false);
        if (scene_.needsDepthBuffer) return;
        for (std::uint32_t f = set_.faceBegin[slice_]; f < set_.faceBegin[slice_ + 1]; ++f) {
            const auto corners = cornerPositionsOfFace(f);
            if (corners.empty() || glm::dot(doubleAreaVectorOf(corners), corners[0]) >= 0) continue;
            for (std::uint32_t c = set_.cornerBegin[f]; c < set_.cornerBegin[f + 1]; ++c) {
                towardVertices_[set_.corners[c]] = true;
                towardEdges_[set_.cornerEdges[c]] = true;
            }
        }
    }

    /// Returns the color of a lit face with the color `color`. Uses the ambient and diffuse light of
    /// scene::PictureStyle, but no specular light. Each channel is multiplied by ambient + diffuse · |n · l|, and is at
    /// most 255; n is the unit normal, and l the direction to the light. Both sides of the face are lit. `area` is a
    /// normal of the face in view space, of any length. It is 0 for a face without area, which gets only ambient light.
    scene::Color litColor(scene::Color color, const glm::dvec3& area) const {
        const double length = glm::length(area);
        const double facing = length > 0 ? std::abs(glm::dot(area / length, style_.light)) : 0;
        const double light = style_.ambient + style_.diffuse * facing;
        scene::Color out = 0;
        for (const int shift : {16, 8, 0}) {
            const double channel = std::min(light * (color >> shift & 255U), 255.0);
            out |= static_cast<scene::Color>(std::lround(channel)) << shift;
        }
        return out;
    }

    void addPolygon(Layer layer, std::span<const glm::dvec3> corners, scene::Color color, double opacity) {
        if (opacity == 0 || corners.size() < 3 || std::ranges::any_of(corners, isBehindEye)) return;
        FilledPolygon polygon{{}, color, opacity};
        double depth = 0;
        for (const glm::dvec3& p : corners) {
            polygon.corners.push_back(paper_(p));
            depth += p.z / static_cast<double>(corners.size());
        }
        items_.push_back({layer, depth, std::move(polygon)});
    }

    void addFaces() {
        for (std::uint32_t f = set_.faceBegin[slice_]; f < set_.faceBegin[slice_ + 1]; ++f) {
            const auto corners = cornerPositionsOfFace(f);
            const glm::dvec3 area = doubleAreaVectorOf(corners);
            const bool toward = !corners.empty() && glm::dot(area, corners[0]) < 0;
            const double opacity =
                scene_.faceOpacity * slicing::opacityOf(scene_.visibilities.face(set_.faceSource[f]));
            addPolygon(toward ? toward_faces : away_faces, corners,
                       litColor(scene_.cellColors[scene_.coloringCellOfFace(f)], area), opacity);
        }
    }

    /// Adds the convex pieces of faces that may cross each other.
    void addConvexPieces() {
        const slicing::FilledFaces& fill = scene_.fill;
        if (fill.empty()) return;
        for (std::uint32_t f = fill.faceBegin[slice_]; f < fill.faceBegin[slice_ + 1]; ++f) {
            const slicing::FilledFaces::FilledFace& face = fill.faces[f];
            const double opacity = scene_.faceOpacity * slicing::opacityOf(scene_.visibilities.face(face.source));
            const scene::Color color =
                litColor(scene_.cellColors[scene_.fillCells[f]], glm::dmat3(view_) * face.normal);
            for (std::uint32_t k = fill.pieceBegin[f]; k < fill.pieceBegin[f + 1]; ++k) {
                std::vector<glm::dvec3> corners;
                for (std::uint32_t c = fill.cornerBegin[k]; c < fill.cornerBegin[k + 1]; ++c)
                    corners.push_back(toViewSpace(fill.corners[c]));
                addPolygon(away_faces, corners, color, opacity);
            }
        }
    }

    /// Returns the layer of a bar or ball. `toward` says whether the edge or vertex belongs to a face that is turned
    /// toward the eye.
    Layer barOrBallLayer(bool toward) const {
        if (scene_.needsDepthBuffer) return away_faces;
        return toward ? toward_frame : away_frame;
    }

    /// Returns, for each vertex of the slice, whether the round end of a bar takes the place of its ball, because balls
    /// are not shown.
    std::vector<bool> verticesWithRoundBarEnds() const {
        std::vector<bool> found(points_.size(), false);
        if (scene_.look.parts.balls) return found;
        for (std::uint32_t e = set_.edgeBegin[slice_]; e < set_.edgeBegin[slice_ + 1]; ++e) {
            if (scene_.visibilities.edge(set_.edgeSource[e]) == slicing::Visibility::hidden) continue;
            for (const std::uint32_t v : set_.edges[e]) found[v] = true;
        }
        return found;
    }

    // A bar has the depth of its far end, and shapes of equal depth are drawn in the order of their addition. Balls are
    // added before bars, so that a bar covers the ball at its far end. The ball at the near end covers the bar.
    void addBalls() {
        const std::vector<bool> isRoundEnd = verticesWithRoundBarEnds();
        for (std::uint32_t i = 0; i < points_.size(); ++i) {
            if (isRoundEnd[i]) continue;
            const std::uint32_t v = set_.vertexBegin[slice_] + i;
            const double own = set_.ballOpacity.empty() ? 1 : set_.ballOpacity[v];
            const double opacity = own * slicing::opacityOf(scene_.visibilities.vertex(set_.vertexSource[v]));
            if (opacity == 0 || isBehindEye(points_[i])) continue;
            const double radius = scene_.drawnBallRadius() * (set_.ballScale.empty() ? 1 : set_.ballScale[v]);
            const bool isHighlighted = scene_.highlight.hasVertex(set_.vertexSource[v]);
            items_.push_back({barOrBallLayer(towardVertices_[i]), points_[i].z,
                              Disk{paper_(points_[i]), radius * paper_.scaleAt(points_[i]),
                                   isHighlighted ? style_.highlight : scene_.drawnBallColor(), opacity}});
        }
    }

    void addBars() {
        for (std::uint32_t i = 0; i < towardEdges_.size(); ++i) {
            const std::uint32_t e = set_.edgeBegin[slice_] + i;
            const glm::dvec3 a = points_[set_.edges[e][0]], b = points_[set_.edges[e][1]];
            const double opacity = slicing::opacityOf(scene_.visibilities.edge(set_.edgeSource[e]));
            const double length = glm::distance(a, b);
            if (opacity == 0 || isBehindEye(a) || isBehindEye(b) || length <= 2 * hiddenEnd_) continue;
            const glm::dvec3 cut = length > 0 ? (b - a) * (hiddenEnd_ / length) : glm::dvec3(0);
            const double width = 2 * scene_.barRadius * paper_.scaleAt((a + b) / 2.0);
            items_.push_back(
                {barOrBallLayer(towardEdges_[i]), std::min(a.z, b.z),
                 LineSegment{.from = paper_(a + cut),
                             .to = paper_(b - cut),
                             .width = width,
                             .color = scene_.highlight.hasEdge(set_.edgeSource[e]) ? style_.highlight : style_.bar,
                             .roundEnds = hiddenEnd_ == 0,
                             .opacity = opacity}});
        }
    }

    const scene::Scene& scene_;
    const SliceSet& set_;
    const scene::PictureStyle& style_;
    const PaperProjection& paper_;
    const glm::dmat4 view_;
    double hiddenEnd_ = 0;  // length of each end of a bar that is inside a ball, in world units
    std::size_t slice_ = 0;
    std::vector<glm::dvec3> points_;  // points in view space
    std::vector<bool> towardVertices_, towardEdges_;
    std::vector<LayeredShape> items_;
};

ShapeGroup drawLabels(const scene::Scene& scene, const PaperProjection& paper) {
    const scene::PictureStyle& style = scene.style();
    const glm::dmat4 view = scene.camera.view();
    ShapeGroup labels{"labels", {}};
    for (const scene::SlicePlacement& placement : scene.placements) {
        const glm::dvec3 at(view * glm::dvec4(placement.labelAt, 1));
        if (!placement.drawn || placement.label.empty() || at.z > -kNearest) continue;
        const double size = style.textHeight * placement.labelSize * paper.height();
        labels.shapes.emplace_back(TextLine{paper(at) + glm::dvec2(0, kDigitHeight * size), size,
                                            placement.focus ? style.focusText : style.text,
                                            withAsciiMinus(placement.label)});
    }
    return labels;
}

/// Draws the directions of the axes x, y and z, from the farthest to the nearest.
ShapeGroup drawAxes(const scene::Scene& scene, const PaperProjection& paper) {
    constexpr double kNameAt = 1.28, kWidth = 0.09, kTip = 0.065;  // lengths as multiples of the length of an axis
    const scene::PictureStyle& style = scene.style();
    const double length = scene.axes.length * paper.height(), size = style.textHeight * paper.height();
    const glm::dvec2 center = glm::dvec2(scene.axes.x, scene.axes.y) * paper.height();
    const glm::dmat3 turn(scene.camera.view());
    const auto place = [&](const glm::dvec2& direction) {
        return center + length * glm::dvec2(direction.x, -direction.y);
    };
    std::array<int, 3> order{0, 1, 2};
    std::ranges::sort(order, {}, [&](int axis) { return std::pair(turn[axis].z, axis); });
    ShapeGroup axes{"axes", {}};
    for (const int axis : order) {
        const glm::dvec2 direction(turn[axis]);
        const scene::Color color = style.axes[static_cast<std::size_t>(axis)];
        axes.shapes.emplace_back(LineSegment{
            .from = center, .to = place(direction), .width = kWidth * length, .color = color, .roundEnds = true});
        axes.shapes.emplace_back(Disk{place(direction), kTip * length, color});
        // If the axis points at the viewer or away, its name would cover the center, so place the name beside the axis.
        glm::dvec2 name = kNameAt * direction;
        if (glm::length(name) < 0.3) name = {0.3, -0.3};
        axes.shapes.emplace_back(
            TextLine{place(name) + glm::dvec2(0, 0.4 * kDigitHeight * size), size, color, std::string(1, "xyz"[axis])});
    }
    return axes;
}

/// Returns whether to draw the focus point. Pictures show it in the matrix view. A drawing of the focus slice alone
/// also shows it if the user has moved it away from the origin.
bool showsFocusPoint(const scene::Look& look) {
    if (look.view == scene::View::matrix) return true;
    return !showsAllSlices(look.view) && look.focusPoint != glm::dvec3(0);
}

/// Draws the focus point in the focus slice, as three lines through the point, parallel to the axes.
ShapeGroup drawFocusPoint(const scene::Scene& scene, const scene::SlicePlacement& placement,
                          const PaperProjection& paper) {
    ShapeGroup point{"focus-point", {}};
    const std::array<scene::ViewSegment, 3> lines = scene::focusPointSegments(scene, placement);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const scene::ViewSegment& ends = lines.at(axis);
        if (ends[0].z > -kNearest || ends[1].z > -kNearest) continue;
        point.shapes.emplace_back(LineSegment{.from = paper(ends[0]),
                                              .to = paper(ends[1]),
                                              .width = 1,
                                              .color = scene.style().axes.at(axis),
                                              .roundEnds = true});
    }
    return point;
}

}  // namespace

Drawing drawSlices(const scene::Scene& scene, const slicing::Object& object, const ExportBudget& budget) {
    if (slicing::fieldIn(object) != nullptr) {
        throw ExportRefused{{ExportRefusal::Cause::no_body,
                             "the surfaces of a field are too fine for a drawing; save a picture (png) instead"}};
    }
    const PaperProjection paper(scene);
    const bool many = scene.placements.size() > 1;
    Drawing drawing{(many ? "Slices: " : "Slice: ") + scene.title, kDrawingWidth, paper.height(), {}};
    std::vector<std::pair<double, std::size_t>> order;  // pairs of a depth and a slice index, the farthest slice first
    for (std::size_t i = 0; i < scene.placements.size(); ++i) {
        const scene::SlicePlacement& placement = scene.placements[i];
        if (placement.drawn) order.emplace_back(-glm::distance(placement.position, scene.camera.eye), i);
    }
    std::ranges::sort(order);
    SliceDrawer drawer(scene, paper);
    std::size_t shapes = 0;
    for (const auto& [distance, i] : order) {
        budget.checkTimeAndStop();
        drawing.groups.push_back(drawer.draw(i));
        shapes += drawing.groups.back().shapes.size();
        budget.checkFileSize(kTypicalShapeBytes * shapes);
    }
    for (const scene::SlicePlacement& placement : scene.placements) {
        if (placement.focus && showsFocusPoint(scene.look))
            drawing.groups.push_back(drawFocusPoint(scene, placement, paper));
    }
    drawing.groups.push_back(drawLabels(scene, paper));
    drawing.groups.push_back(drawAxes(scene, paper));
    return drawing;
}

}  // namespace oval4d::exports
