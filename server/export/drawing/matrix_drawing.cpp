#include "export/drawing/matrix_drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "export/drawing/ascii_text.hpp"

namespace oval4d::exports {

namespace {

constexpr double kPanelGap = 6, kName = 26, kNumberSize = 6;
constexpr double kNumberRoom = 14;       // room for numbers at the left of the matrix and below it
constexpr double kCharacterWidth = 0.6;  // mean width of a character, as a fraction of the font size
constexpr double kNumberCharacters = 4;  // how many characters with the font size kNumberSize fit into kNumberRoom
constexpr double kPanel = (kDrawingWidth - 2 * kDrawingMargin - kNumberRoom - 3 * kPanelGap) / 4;
constexpr scene::Color kFrame = 0x8a93a3, kFill = 0xe9ecf1, kPoint = 0x2b3340;

/// Returns the tick spacing of an axis from −reach to reach. The spacing is 1, 2 or 5 times a power of ten, and gives
/// one or two ticks on each side of 0.
double tickSpacing(double reach) {
    constexpr double kMost = 2.6;
    const double power = std::pow(10, std::floor(std::log10(reach)));
    for (const double factor : {0.5, 1.0, 2.0}) {
        if (reach / (factor * power) < kMost) return factor * power;
    }
    return 5 * power;
}

/// Returns the product multiple · step as text, with as many decimals as `step` has.
std::string multipleText(double multiple, double step) {
    if (multiple == 0) return "0";
    const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.*f", decimals, multiple * step);
    return text.data();
}

class PlanarSectionDrawer {
  public:
    PlanarSectionDrawer(const scene::Scene& scene, const glm::dvec4& origin)
        : scene_(scene),
          origin_(origin),
          reach_(scene::SectionMatrixLayout::kReach * scene.circumradius),
          step_(tickSpacing(reach_)),
          scale_(kPanel / 2 / reach_) {}

    ShapeGroup draw(std::size_t section, bool transposed) {
        const slicing::PlanarSection& from = scene_.sectionMatrix.sections[section];
        const scene::SectionMatrix::SectionElementLooks& styles = scene_.sectionMatrix.styles[section];
        const int row = from.axes[transposed ? 0 : 1], column = from.axes[transposed ? 1 : 0];
        const glm::dvec2 center = panelCenter(row, column);
        const auto place = [&](const glm::dvec2& p) {
            const glm::dvec2 turned = transposed ? glm::dvec2(p.y, p.x) : p;
            return center + scale_ * glm::dvec2(turned.x, -turned.y);
        };
        ShapeGroup group{{"xyzw"[row], "xyzw"[column]}, {}};
        drawFrame(center, group);
        if (!scene_.needsDepthBuffer && !from.boundary.empty()) {
            FilledPolygon polygon{{}, kFill};
            for (const std::uint32_t p : from.boundary) polygon.corners.push_back(place(from.points[p]));
            group.shapes.emplace_back(std::move(polygon));
        }
        drawFocusLines(center, row, column, group);
        const double width = std::min(1.6, 250 * scene_.matrix.pointRadius + 0.5);
        const slicing::PlanarContours& contours = scene_.sectionMatrix.contours[section];
        for (std::size_t i = 0; i < contours.lineCount(); ++i) {
            Polyline line{{}, width, scene_.surfaces.contourColor(contours.level[i])};
            for (const glm::dvec2& p : contours.line(i)) line.points.push_back(place(p));
            group.shapes.emplace_back(std::move(line));
        }
        for (std::size_t e = 0; e < from.edges.size(); ++e) {
            const double opacity = slicing::opacityOf(styles.edges[e]);
            if (opacity == 0) continue;
            group.shapes.emplace_back(LineSegment{.from = place(from.points[from.edges[e][0]]),
                                                  .to = place(from.points[from.edges[e][1]]),
                                                  .width = width,
                                                  .color = scene_.cellColors[styles.edgeCells[e]],
                                                  .roundEnds = true,
                                                  .opacity = opacity});
        }
        const bool isCloud = !from.ballScale.empty();  // only the points of point clouds have their own radii
        for (std::size_t i = 0; i < from.points.size(); ++i) {
            const double opacity = slicing::opacityOf(styles.points[i]) * (isCloud ? from.ballOpacity[i] : 1);
            if (opacity == 0) continue;
            group.shapes.emplace_back(Disk{place(from.points[i]), (isCloud ? 1.5 * from.ballScale[i] : 0.6) * width,
                                           styles.highlighted[i] ? scene_.style().highlight : kPoint, opacity});
        }
        return group;
    }

    /// Draws tick marks and their numbers, at the left edge of each row of panels and the lower edge of each column.
    /// Numbers with more than kNumberCharacters characters get a smaller font size.
    ShapeGroup drawTickMarks() const {
        constexpr double kMark = 3;
        const double half = kPanel / 2;
        ShapeGroup numbers{"numbers", {}};
        const auto add = [&](const glm::dvec2& mark, const glm::dvec2& outward, const TextLine& text) {
            numbers.shapes.emplace_back(
                LineSegment{.from = mark, .to = mark + kMark * outward, .width = 0.5, .color = text.color});
            numbers.shapes.emplace_back(text);
        };
        for (int axis = 0; axis < 4; ++axis) {
            const glm::dvec2 below = panelCenter(axis == 3 ? 2 : 3, axis),
                             beside = panelCenter(axis, axis == 0 ? 1 : 0);
            const double first = std::ceil((origin_[axis] - reach_) / step_);
            for (int i = 0; i <= 2 * reach_ / step_; ++i) {
                const double at = scale_ * ((first + i) * step_ - origin_[axis]);
                if (at > half) break;
                const std::string text = multipleText(first + i - ticksSubtractedFromNumbers(axis), step_);
                const auto characters = static_cast<double>(text.size());
                const double size = kNumberSize * std::min(1.0, kNumberCharacters / characters), digits = 0.73 * size;
                const glm::dvec2 under = below + glm::dvec2(at, half), left = beside + glm::dvec2(-half, -at);
                add(under, {0, 1}, {under + glm::dvec2(0, kMark + 1 + digits), size, colorOfAxis(axis), text});
                const double halfWidth = kCharacterWidth * size * characters / 2;
                add(left, {-1, 0},
                    {left + glm::dvec2(-kMark - 1 - halfWidth, digits / 2), size, colorOfAxis(axis), text});
            }
        }
        return numbers;
    }

    /// Draws the name of an axis. If the numbers at the axis are shortened (see ticksSubtractedFromNumbers()), draws
    /// the number that must be added to them below the name. Below this number, draws the unit, if it is known and
    /// short enough.
    void drawAxisName(int axis, std::vector<DrawnShape>& shapes) const {
        const glm::dvec2 center = panelCenter(axis, axis), below = center + glm::dvec2(0, 0.35 * kName);
        shapes.emplace_back(TextLine{below, kName, colorOfAxis(axis), std::string(1, "xyzw"[axis])});
        double line = 2;  // position of the next text, in font sizes below the name
        const auto add = [&](const std::string& text) {
            shapes.emplace_back(
                TextLine{below + glm::dvec2(0, line * kNumberSize), kNumberSize, colorOfAxis(axis), text});
            line += 1.5;
        };
        if (ticksSubtractedFromNumbers(axis) != 0) {
            std::array<char, 32> text{};
            std::snprintf(text.data(), text.size(), "%+.15g", ticksSubtractedFromNumbers(axis) * step_);
            add(text.data());
        }
        const fields::PictureAxisUnit& unit = scene_.axisUnits.at(static_cast<std::size_t>(axis));
        const std::string text = unit.isToScale ? asciiText(unit.text) : "";
        if (!text.empty() && kCharacterWidth * kNumberSize * static_cast<double>(text.size()) <= kPanel) add(text);
    }

  private:
    static glm::dvec2 panelCenter(int row, int column) {
        return kDrawingMargin + glm::dvec2(kNumberRoom, 0) + (kPanel + kPanelGap) * glm::dvec2(column, row) +
               kPanel / 2;
    }

    // Returns how many tick spacings (step_) are subtracted from all numbers at an axis, to shorten the numbers.
    // Returns 0 if the numbers are short enough.
    double ticksSubtractedFromNumbers(int axis) const {
        const double middle = std::round(origin_[axis] / step_);
        return static_cast<double>(multipleText(middle, step_).size()) > kNumberCharacters + 1 ? middle : 0;
    }

    scene::Color colorOfAxis(int axis) const { return scene_.style().axes[static_cast<std::size_t>(axis)]; }

    static void drawFrame(const glm::dvec2& center, ShapeGroup& group) {
        const double half = kPanel / 2;
        const std::array corners{center + glm::dvec2(-half, -half), center + glm::dvec2(half, -half),
                                 center + glm::dvec2(half, half), center + glm::dvec2(-half, half)};
        for (std::size_t i = 0; i < corners.size(); ++i) {
            group.shapes.emplace_back(LineSegment{
                .from = corners[i], .to = corners[(i + 1) % 4], .width = 0.5, .color = kFrame, .roundEnds = true});
        }
    }

    void drawFocusLines(const glm::dvec2& center, int row, int column, ShapeGroup& group) const {
        const double half = kPanel / 2;
        const glm::dvec4& point = scene_.sectionMatrix.point;
        const double x = scale_ * point[column], y = -scale_ * point[row];
        if (std::abs(y) < half) {
            group.shapes.emplace_back(LineSegment{.from = center + glm::dvec2(-half, y),
                                                  .to = center + glm::dvec2(half, y),
                                                  .width = 0.5,
                                                  .color = colorOfAxis(column)});
        }
        if (std::abs(x) < half) {
            group.shapes.emplace_back(LineSegment{.from = center + glm::dvec2(x, -half),
                                                  .to = center + glm::dvec2(x, half),
                                                  .width = 0.5,
                                                  .color = colorOfAxis(row)});
        }
    }

    const scene::Scene& scene_;
    const glm::dvec4 origin_;
    const double reach_, step_, scale_;
};

}  // namespace

Drawing drawMatrix(const scene::Scene& scene, const glm::dvec4& origin) {
    Drawing drawing{"Planar sections: " + scene.title, kDrawingWidth, kDrawingWidth, {}};
    PlanarSectionDrawer drawer(scene, origin);
    for (std::size_t i = 0; i < scene.sectionMatrix.sections.size(); ++i) {
        for (const bool transposed : {false, true}) drawing.groups.push_back(drawer.draw(i, transposed));
    }
    ShapeGroup& names = drawing.groups.emplace_back("names", std::vector<DrawnShape>());
    for (int axis = 0; axis < 4; ++axis) drawer.drawAxisName(axis, names.shapes);
    drawing.groups.push_back(drawer.drawTickMarks());
    return drawing;
}

}  // namespace oval4d::exports
