#include "render/overlay/matrix_panels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "render/projection.hpp"
#include "scene/focus_lines.hpp"

namespace oval4d::render {

namespace {

using scene::Color;
using slicing::PlanarSection;

constexpr float kPanelOpacity = 0.22F, kFillOpacity = 0.16F, kAxisOpacity = 0.55F;
// The font sizes of the name and of the unit of an axis, as fractions of the side of a panel.
constexpr double kNameHeight = 0.3, kUnitHeight = 0.1;
// The width of the lines through the focus point in the focus slice (the middle one), as a fraction of the picture's
// height.
constexpr double kFocusWidth = 0.0028;

// Draws the panels that show sections. Each section has two panels: one with the section's first axis to the right, and
// one with its second axis to the right.
class SectionPanelPainter {
  public:
    SectionPanelPainter(const scene::Scene& scene, Overlay& overlay)
        : scene_(scene),
          overlay_(overlay),
          height_(scene.viewport.height),
          pixelsPerUnit_(scene.matrix.panelScale(scene.circumradius) * height_) {}

    void paint(std::size_t section, bool transposed) {
        const PlanarSection& from = scene_.sectionMatrix.sections[section];
        transposed_ = transposed;
        const auto [row, column] =
            transposed ? std::pair(from.axes[0], from.axes[1]) : std::pair(from.axes[1], from.axes[0]);
        center_ = scene_.matrix.center(row, column) * height_;
        overlay_.box(panelRect(), scene_.style().zeroLine, kPanelOpacity,
                     static_cast<float>(0.03 * scene_.matrix.panel * height_));
        points_.clear();
        for (const glm::dvec2& p : from.points) points_.push_back(pixelOf(p));
        if (scene_.look.parts.faces) paintFill(from);
        paintFocusLines(row, column);
        paintContours(section);
        if (scene_.look.parts.bars) paintEdges(section);
        if (scene_.look.parts.balls || !from.ballScale.empty()) paintPoints(section);
    }

    void paintAxisName(int axis) {
        const glm::vec2 at = scene_.matrix.center(axis, axis) * height_;
        const int size = static_cast<int>(std::lround(kNameHeight * scene_.matrix.panel * height_));
        if (size < 1) return;
        const auto digits = static_cast<float>(overlay_.font().digitHeight(size));
        const auto index = static_cast<std::size_t>(axis);
        overlay_.text(at.x, at.y - digits / 2, size, std::string_view("xyzw").substr(index, 1), colorOfAxis(axis));
        paintAxisUnit(scene_.axisUnits.at(index).text, {at.x, at.y - digits / 2}, colorOfAxis(axis));
    }

  private:
    // Draws the unit of an axis below the name of the axis. Does nothing if the unit is unknown, or if its text is
    // wider than a panel. `name` is the middle of the baseline of the axis name, in pixels.
    void paintAxisUnit(const std::string& unit, const glm::vec2& name, Color color) const {
        const int size = static_cast<int>(std::lround(kUnitHeight * scene_.matrix.panel * height_));
        if (unit.empty() || size < 1) return;
        const auto digits = static_cast<float>(overlay_.font().digitHeight(size));
        if (overlay_.font().width(size, unit) > scene_.matrix.panel * height_) return;
        overlay_.text(name.x, name.y - 1.8F * digits, size, unit, color);
    }

    // Returns the pixel at which the current panel shows the point `p` of a section. `p` has the coordinates of the
    // point along the first and the second axis of the section, in the units of the object.
    glm::vec2 pixelOf(const glm::dvec2& p) const {
        return center_ + pixelsPerUnit_ * (transposed_ ? glm::dvec2(p.y, p.x) : p);
    }

    Color colorOfAxis(int axis) const { return scene_.style().axes[static_cast<std::size_t>(axis)]; }

    PixelRect panelRect() const {
        const double half = scene_.matrix.panel / 2 * height_;
        return {static_cast<float>(std::round(center_.x - half)), static_cast<float>(std::round(center_.y - half)),
                static_cast<float>(std::round(center_.x + half)), static_cast<float>(std::round(center_.y + half))};
    }

    // Draws the two lines through the focus point in a panel, each in the color of the axis to which it is parallel.
    // Leaves out a line outside the panel. The planes of all panels contain the focus point. The planes of the panels
    // in one row are all parallel to the axis of the row. So these planes meet in the line through the focus point
    // along this axis: the vertical line of the panel. In the same way, the planes of the panels in one column meet in
    // the horizontal line.
    void paintFocusLines(int row, int column) const {
        const glm::dvec4& point = scene_.sectionMatrix.point;
        const glm::vec2 at = center_ + pixelsPerUnit_ * glm::dvec2(point[column], point[row]);
        const PixelRect box = panelRect();
        const float half = std::max(0.5F, static_cast<float>(std::round(0.0011 * height_)) / 2);
        if (at.y > box.bottom && at.y < box.top)
            overlay_.box({box.left, at.y - half, box.right, at.y + half}, colorOfAxis(column), kAxisOpacity);
        if (at.x > box.left && at.x < box.right)
            overlay_.box({at.x - half, box.bottom, at.x + half, box.top}, colorOfAxis(row), kAxisOpacity);
    }

    void paintFill(const PlanarSection& from) {
        polygon_.clear();
        for (const std::uint32_t p : from.boundary) polygon_.push_back(points_[p]);
        if (!scene_.needsDepthBuffer) overlay_.polygon(polygon_, scene_.style().ball, kFillOpacity);
    }

    float lineWidth() const { return static_cast<float>(std::max(1.0, scene_.matrix.lineWidth * height_)); }

    void paintContours(std::size_t section) const {
        const slicing::PlanarContours& contours = scene_.sectionMatrix.contours[section];
        for (std::size_t i = 0; i < contours.lineCount(); ++i) {
            const auto line = contours.line(i);
            const Color color = scene_.surfaces.contourColor(contours.level[i]);
            for (std::size_t p = 1; p < line.size(); ++p)
                overlay_.line(pixelOf(line[p - 1]), pixelOf(line[p]), lineWidth(), color);
        }
    }

    void paintEdges(std::size_t section) const {
        const PlanarSection& from = scene_.sectionMatrix.sections[section];
        const scene::SectionMatrix::SectionElementLooks& styles = scene_.sectionMatrix.styles[section];
        const float width = lineWidth();
        for (std::size_t e = 0; e < from.edges.size(); ++e) {
            const double opacity = slicing::opacityOf(styles.edges[e]);
            if (opacity == 0) continue;
            overlay_.line(points_[from.edges[e][0]], points_[from.edges[e][1]], width,
                          scene_.cellColors[styles.edgeCells[e]], static_cast<float>(opacity));
        }
    }

    void paintPoints(std::size_t section) const {
        const PlanarSection& from = scene_.sectionMatrix.sections[section];
        const scene::SectionMatrix::SectionElementLooks& styles = scene_.sectionMatrix.styles[section];
        const scene::PictureStyle& style = scene_.style();
        const bool isCloud = !from.ballScale.empty();
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const double opacity = slicing::opacityOf(styles.points[i]) * (isCloud ? from.ballOpacity[i] : 1);
            if (opacity == 0) continue;
            const double scale = isCloud ? from.ballScale[i] : 1;
            const auto radius = static_cast<float>(std::max(1.0, scene_.matrix.pointRadius * height_ * scale));
            const glm::vec2 at = points_[i];
            overlay_.box({at.x - radius, at.y - radius, at.x + radius, at.y + radius},
                         styles.highlighted[i] ? style.highlight : style.ball, static_cast<float>(opacity), radius);
        }
    }

    const scene::Scene& scene_;
    Overlay& overlay_;
    const double height_, pixelsPerUnit_;
    bool transposed_ = false;
    glm::dvec2 center_{0};  // the center of the current panel, in pixels
    std::vector<glm::vec2> points_, polygon_;
};

// Marks the focus point in the focus slice (the middle one) by lines through the point along the axes x, y and z.
// Leaves out a line that has an end behind the eye.
void addFocusPointLines(const scene::Scene& scene, const scene::SlicePlacement& placement, Overlay& overlay) {
    const ViewProjection projection = ViewProjection::fromCamera(scene.camera, scene.viewport);
    const auto width = static_cast<float>(std::max(1.0, kFocusWidth * scene.viewport.height));
    const std::array<scene::ViewSegment, 3> lines = scene::focusPointSegments(scene, placement);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const glm::vec3 from(lines.at(axis)[0]), to(lines.at(axis)[1]);
        if (from.z >= 0 || to.z >= 0) continue;
        overlay.line(projection.pixel(from), projection.pixel(to), width, scene.style().axes.at(axis));
    }
}

}  // namespace

void addMatrixAndFocusLines(const scene::Scene& scene, Overlay& overlay) {
    if (!scene.matrix.shown) return;
    for (const scene::SlicePlacement& placement : scene.placements)
        if (placement.focus) addFocusPointLines(scene, placement, overlay);
    SectionPanelPainter painter(scene, overlay);
    for (int axis = 0; axis < 4; ++axis) painter.paintAxisName(axis);
    for (std::size_t i = 0; i < scene.sectionMatrix.sections.size(); ++i) {
        painter.paint(i, false);
        painter.paint(i, true);
    }
}

}  // namespace oval4d::render
