#include "export/drawing/matrix_drawing.hpp"

#include <algorithm>
#include <array>

namespace oval4d::exports {

namespace {

constexpr double kPanelGap = 6, kName = 26;
constexpr double kPanel = (kDrawingWidth - 2 * kDrawingMargin - 3 * kPanelGap) / 4;
constexpr scene::Color kFrame = 0xc4cad4, kFill = 0xe9ecf1, kPoint = 0x2b3340;

class SectionDrawer {
  public:
    explicit SectionDrawer(const scene::Scene& scene)
        : scene_(scene), scale_(kPanel / 2 / (scene::MatrixLayout::kReach * scene.circumradius)) {}

    ShapeGroup draw(std::size_t section, bool transposed) {
        const slicing::PlanarSection& from = scene_.sectionMatrix.sections[section];
        const scene::SectionMatrix::SectionStyle& styles = scene_.sectionMatrix.styles[section];
        const int row = from.axes[transposed ? 0 : 1], column = from.axes[transposed ? 1 : 0];
        const glm::dvec2 center = centerOf(row, column);
        const auto place = [&](const glm::dvec2& p) {
            const glm::dvec2 turned = transposed ? glm::dvec2(p.y, p.x) : p;
            return center + scale_ * glm::dvec2(turned.x, -turned.y);
        };
        ShapeGroup group{{"xyzw"[row], "xyzw"[column]}, {}};
        drawFrame(center, group);
        if (!scene_.crossing && !from.boundary.empty()) {
            FilledPolygon polygon{{}, kFill};
            for (const std::uint32_t p : from.boundary) polygon.corners.push_back(place(from.points[p]));
            group.shapes.emplace_back(std::move(polygon));
        }
        drawFocusLines(center, row, column, group);
        const double width = std::min(1.6, 250 * scene_.matrix.pointRadius + 0.5);
        for (std::size_t e = 0; e < from.edges.size(); ++e) {
            const double opacity = slicing::opacityOf(styles.edges[e]);
            if (opacity == 0) continue;
            group.shapes.emplace_back(Line{.from = place(from.points[from.edges[e][0]]),
                                           .to = place(from.points[from.edges[e][1]]),
                                           .width = width,
                                           .color = scene_.cellColors[styles.edgeCells[e]],
                                           .roundEnds = true,
                                           .opacity = opacity});
        }
        const bool differ = !from.ballScale.empty();  // the points of a cloud
        for (std::size_t i = 0; i < from.points.size(); ++i) {
            const double opacity = slicing::opacityOf(styles.points[i]) * (differ ? from.ballOpacity[i] : 1);
            if (opacity == 0) continue;
            group.shapes.emplace_back(Disk{place(from.points[i]), (differ ? 1.5 * from.ballScale[i] : 0.6) * width,
                                           styles.highlighted[i] ? scene::style().highlight : kPoint, opacity});
        }
        return group;
    }

    static TextLine nameOf(int axis) {
        const glm::dvec2 center = centerOf(axis, axis);
        return {{center.x, center.y + 0.35 * kName}, kName, colorOfAxis(axis), std::string(1, "xyzw"[axis])};
    }

  private:
    static glm::dvec2 centerOf(int row, int column) {
        return kDrawingMargin + (kPanel + kPanelGap) * glm::dvec2(column, row) + kPanel / 2;
    }

    static scene::Color colorOfAxis(int axis) { return scene::style().axes[static_cast<std::size_t>(axis)]; }

    static void drawFrame(const glm::dvec2& center, ShapeGroup& group) {
        const double half = kPanel / 2;
        const std::array corners{center + glm::dvec2(-half, -half), center + glm::dvec2(half, -half),
                                 center + glm::dvec2(half, half), center + glm::dvec2(-half, half)};
        for (std::size_t i = 0; i < corners.size(); ++i) {
            group.shapes.emplace_back(
                Line{.from = corners[i], .to = corners[(i + 1) % 4], .width = 0.5, .color = kFrame, .roundEnds = true});
        }
    }

    void drawFocusLines(const glm::dvec2& center, int row, int column, ShapeGroup& group) const {
        const double half = kPanel / 2;
        const glm::dvec4& point = scene_.sectionMatrix.point;
        const double x = scale_ * point[column], y = -scale_ * point[row];
        if (std::abs(y) < half) {
            group.shapes.emplace_back(Line{.from = center + glm::dvec2(-half, y),
                                           .to = center + glm::dvec2(half, y),
                                           .width = 0.5,
                                           .color = colorOfAxis(column)});
        }
        if (std::abs(x) < half) {
            group.shapes.emplace_back(Line{.from = center + glm::dvec2(x, -half),
                                           .to = center + glm::dvec2(x, half),
                                           .width = 0.5,
                                           .color = colorOfAxis(row)});
        }
    }

    const scene::Scene& scene_;
    const double scale_;
};

}  // namespace

Drawing drawMatrix(const scene::Scene& scene) {
    Drawing drawing{"Planar sections: " + scene.title, kDrawingWidth, kDrawingWidth, {}};
    SectionDrawer drawer(scene);
    for (std::size_t i = 0; i < scene.sectionMatrix.sections.size(); ++i) {
        for (const bool transposed : {false, true}) drawing.groups.push_back(drawer.draw(i, transposed));
    }
    ShapeGroup& names = drawing.groups.emplace_back("names", std::vector<Shape>());
    for (int axis = 0; axis < 4; ++axis) names.shapes.emplace_back(SectionDrawer::nameOf(axis));
    return drawing;
}

}  // namespace oval4d::exports
