#include "export/drawing/coordinates_drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec4.hpp>

#include "export/drawing/ascii_text.hpp"
#include "scene/density_plot.hpp"
#include "scene/density_strip_lines.hpp"
#include "slicing/coordinate_value_histograms.hpp"

namespace oval4d::exports {

namespace {

// Lengths are in units of the drawing.
constexpr double kAmplitude = 40;          // length of the line for a coordinate equal to the circumradius
constexpr double kMaxColumn = 48;          // maximum width of the column of a vertex
constexpr double kMinColumn = 5;           // minimum width of the column of a vertex
constexpr double kText = 7;                // font size
constexpr double kNameRoom = 3.2 * kText;  // least distance between the labels of vertices
constexpr double kBandOpacity = 0.35;      // opacity of the bands behind the lines of highlighted vertices

/// Returns the approximate width of a line of text in the font size kText, from the mean width of characters.
double estimatedWidth(const std::string& text) {
    constexpr double kCharacter = 0.6;  // mean width of a character, as a fraction of the font size
    return kCharacter * kText * static_cast<double>(text.size());
}

/// The positions of the vertices' columns. The column of a vertex has a vertical line for each of the four coordinates.
/// Columns are arranged in rows.
struct ParallelCoordinatesColumnLayout {
    std::size_t count, perRow, rows;
    double step, rowStep;    ///< distance from each column to the next, and from each row to the next
    std::size_t namedEvery;  ///< distance, in columns, from one label (P0, …) to the next in a row

    explicit ParallelCoordinatesColumnLayout(std::size_t vertices) : count(vertices) {
        const double width = kDrawingWidth - 2 * kDrawingMargin;
        const auto most = static_cast<std::size_t>(width / kMinColumn);
        rows = (count + most - 1) / most;
        perRow = (count + rows - 1) / rows;
        step = std::min(width / static_cast<double>(perRow), kMaxColumn);
        namedEvery = static_cast<std::size_t>(std::ceil(kNameRoom / step));
        rowStep = 2 * kAmplitude + kDrawingMargin + 1.5 * kText;
    }
    double leftX(std::size_t i) const { return kDrawingMargin + step * static_cast<double>(i % perRow); }
    double zeroLineY(std::size_t row) const { return kDrawingMargin + kAmplitude + rowStep * static_cast<double>(row); }
};

Drawing drawDensityStrip(const scene::Scene& scene) {
    scene::DensityPlot density;
    density.compute(scene.slices->rotatedVertices, glm::dmat4(1), scene.circumradius);
    const double step = (kDrawingWidth - 2 * kDrawingMargin) / 3, bottom = kDrawingMargin + 2 * kAmplitude;
    const auto& colors = scene.style().axes;
    const auto tones = density.tones();
    ShapeGroup strip{"density",
                     {OpacityImage{{kDrawingMargin, kDrawingMargin},
                                   {kDrawingMargin + 3 * step, bottom},
                                   {tones.begin(), tones.end()},
                                   scene::DensityPlot::kColumns,
                                   {colors.begin(), colors.end()}}}};
    ShapeGroup axes{"axes", {}};
    for (int k = 0; k < 4; ++k) {
        const double x = kDrawingMargin + k * step;
        const std::string name(1, "xyzw"[k]);
        axes.shapes.emplace_back(
            LineSegment{.from = {x, kDrawingMargin}, .to = {x, bottom}, .color = colors[k], .id = name});
        axes.shapes.emplace_back(TextLine{{x, bottom + 1.3 * kText}, kText, kDrawingText, name});
    }
    Drawing drawing{"Parallel coordinates of the vertices: " + scene.title,
                    kDrawingWidth,
                    bottom + kDrawingMargin + kText,
                    {std::move(strip), std::move(axes)}};
    if (scene.highlight.empty()) return drawing;
    ShapeGroup& lines = drawing.groups.emplace_back("highlight", std::vector<DrawnShape>());
    scene::forEachLineOverDensityStrip(scene.highlight.ownVertices, [&](std::uint32_t v) {
        const glm::dvec4& vertex = scene.slices->rotatedVertices[v];
        Polyline line{{}, 1, scene.style().highlight};
        for (int k = 0; k < 4; ++k) {
            const double up = kAmplitude * (1 + vertex[k] / scene.circumradius);
            line.points.emplace_back(kDrawingMargin + k * step, bottom - up);
        }
        lines.shapes.emplace_back(std::move(line));
    });
    return drawing;
}

/// Returns the bands behind the lines of the highlighted element's vertices.
ShapeGroup highlightBands(const scene::Scene& scene, const ParallelCoordinatesColumnLayout& columns) {
    ShapeGroup bands{"highlight", {}};
    const double margin = columns.step / 10;  // half the distance between neighboring coordinate lines in a column
    for (const std::uint32_t v : scene.highlight.ownVertices) {
        const double leftX = columns.leftX(v) + margin, right = columns.leftX(v) + columns.step - margin;
        const double zeroLineY = columns.zeroLineY(v / columns.perRow);
        const double top = zeroLineY - kAmplitude, bottom = zeroLineY + kAmplitude;
        bands.shapes.emplace_back(FilledPolygon{
            {{leftX, top}, {right, top}, {right, bottom}, {leftX, bottom}}, scene.style().highlight, kBandOpacity});
    }
    return bands;
}

Drawing drawHistogram(const scene::Scene& scene, const fields::Field& field, const geometry::Rotation& orientation) {
    using slicing::CoordinateValueHistograms;
    constexpr double kGap = 12;  // the gap between two panels
    const slicing::FieldSettings& settings = scene.look.field;
    CoordinateValueHistograms histogram;
    histogram.compute(field, orientation, settings.levels);
    const auto [least, greatest] = histogram.valueRange();
    const double width = (kDrawingWidth - 2 * kDrawingMargin - 3 * kGap) / 4, bottom = kDrawingMargin + 2 * kAmplitude;
    Drawing drawing{"Histogram of the values: " + scene.title, kDrawingWidth, bottom + kDrawingMargin + kText, {}};
    ShapeGroup levels{"levels", {}}, axes{"axes", {}};
    for (int k = 0; k < 4; ++k) {
        const double left = kDrawingMargin + k * (width + kGap), right = left + width;
        const scene::Color color = scene.style().axes[static_cast<std::size_t>(k)];
        const std::string name(1, "xyzw"[k]);
        OpacityImage panel{{left, kDrawingMargin}, {right, bottom}, {}, CoordinateValueHistograms::kPanel, {color}};
        for (int row = 0; row < CoordinateValueHistograms::kRows; ++row) {
            const auto first = histogram.tones().subspan(CoordinateValueHistograms::index(row, k, 0),
                                                         CoordinateValueHistograms::kPanel);
            panel.alphas.insert(panel.alphas.end(), first.begin(), first.end());
        }
        drawing.groups.push_back({"histogram-" + name, {std::move(panel)}});
        for (std::size_t i = 0; i < settings.levels.size(); ++i) {
            const double level = settings.levels[i];
            if (level < least || level > greatest) continue;
            const double y = bottom - 2 * kAmplitude * (level - least) / (greatest - least);
            levels.shapes.emplace_back(
                LineSegment{.from = {left, y},
                            .to = {right, y},
                            .width = 0.5,
                            .color = scene::surfaceColor(i, settings.levels.size(), scene.look)});
        }
        axes.shapes.emplace_back(
            LineSegment{.from = {left, bottom}, .to = {right, bottom}, .color = color, .id = name});
        const std::string label = asciiText(fields::axisLabel(k, scene.axisUnits.at(static_cast<std::size_t>(k))));
        axes.shapes.emplace_back(TextLine{{(left + right) / 2, bottom + 1.3 * kText},
                                          kText,
                                          kDrawingText,
                                          estimatedWidth(label) <= width ? label : name});
    }
    const std::string quantity = asciiText(fields::labelOf(field.quantity));
    const double quantityWidth = estimatedWidth(quantity);
    if (!quantity.empty() && quantityWidth <= kDrawingWidth - 2 * kDrawingMargin) {
        axes.shapes.emplace_back(TextLine{
            {kDrawingMargin + quantityWidth / 2, kDrawingMargin - 0.4 * kText}, kText, kDrawingText, quantity});
    }
    drawing.groups.push_back(std::move(levels));
    drawing.groups.push_back(std::move(axes));
    return drawing;
}

}  // namespace

Drawing drawCoordinates(const scene::Scene& scene, const slicing::Object& object,
                        const geometry::Rotation& orientation) {
    if (const fields::Field* field = slicing::fieldIn(object)) return drawHistogram(scene, *field, orientation);
    const std::vector<glm::dvec4>& vertices = scene.slices->rotatedVertices;
    if (vertices.size() > scene::kMaxVerticesAsLines) return drawDensityStrip(scene);
    const ParallelCoordinatesColumnLayout columns(vertices.size());
    const double right = columns.leftX(columns.perRow - 1) + columns.step;
    Drawing drawing{"Parallel coordinates of the vertices: " + scene.title,
                    kDrawingWidth,
                    columns.rowStep * static_cast<double>(columns.rows) + kDrawingMargin,
                    {}};
    ShapeGroup& zeros = drawing.groups.emplace_back("zero", std::vector<DrawnShape>());
    for (std::size_t row = 0; row < columns.rows; ++row) {
        const double y = columns.zeroLineY(row);
        zeros.shapes.emplace_back(
            LineSegment{.from = {kDrawingMargin, y}, .to = {right, y}, .width = 0.4, .color = scene.style().zeroLine});
    }
    if (!scene.highlight.empty()) drawing.groups.push_back(highlightBands(scene, columns));
    const auto& colors = scene.style().axes;
    const double lineStep = columns.step / 5;
    for (int axis = 0; axis < 4; ++axis) {
        ShapeGroup& lines = drawing.groups.emplace_back(std::string(1, "xyzw"[axis]), std::vector<DrawnShape>());
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const double x = columns.leftX(i) + lineStep * (axis + 1),
                         zeroLineY = columns.zeroLineY(i / columns.perRow);
            lines.shapes.emplace_back(
                LineSegment{.from = {x, zeroLineY},
                            .to = {x, zeroLineY - kAmplitude * vertices[i][axis] / scene.circumradius},
                            .width = std::min(1.6, 0.7 * lineStep),
                            .color = colors[static_cast<std::size_t>(axis)]});
        }
    }
    ShapeGroup& names = drawing.groups.emplace_back("names", std::vector<DrawnShape>());
    for (int axis = 0; axis < 4; ++axis) {
        const double x = kDrawingMargin + kText * (axis + 0.5);
        names.shapes.emplace_back(TextLine{{x, kDrawingMargin - 0.4 * kText},
                                           kText,
                                           colors[static_cast<std::size_t>(axis)],
                                           std::string(1, "xyzw"[axis])});
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (i % columns.perRow % columns.namedEvery != 0) continue;
        names.shapes.emplace_back(TextLine{
            {columns.leftX(i) + columns.step / 2, columns.zeroLineY(i / columns.perRow) + kAmplitude + 1.2 * kText},
            kText,
            kDrawingText,
            "P" + std::to_string(i)});
    }
    return drawing;
}

}  // namespace oval4d::exports
