#include "export/formats/svg.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "export/formats/text.hpp"
#include "scene/density_plot.hpp"

namespace oval4d::exports {

namespace {

// Lengths are in units of 1/72 inch. The drawing is as wide as a text column of a printed page.
constexpr double kWidth = 480;
constexpr double kMargin = 12;
constexpr double kAmplitude = 40;  // length of a line whose value is the circumradius
constexpr double kMaxColumn = 48;  // bounds of the width of a vertex's column
constexpr double kMinColumn = 5;
constexpr double kText = 7;  // font size

std::string number(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.3f", value + 0.0);
    return text.data();
}

std::string color(scene::Color rgb) {
    std::array<char, 8> text{};
    std::snprintf(text.data(), text.size(), "#%06x", rgb & 0xffffffU);
    return text.data();
}

/// The positions of the columns. Each vertex has a column, with a vertical line for each of its four coordinates; the
/// columns are arranged in rows.
struct Columns {
    std::size_t count, perRow, rows;
    double step, rowStep;  ///< from a column to the next, from a row to the next
    bool named;            ///< whether there is room for the labels P0, P1, …

    explicit Columns(std::size_t vertices) : count(vertices) {
        const double width = kWidth - 2 * kMargin;
        const auto most = static_cast<std::size_t>(width / kMinColumn);
        rows = (count + most - 1) / most;
        perRow = (count + rows - 1) / rows;
        step = std::min(width / static_cast<double>(perRow), kMaxColumn);
        named = step > 3.2 * kText;
        rowStep = 2 * kAmplitude + kMargin + (named ? 1.5 * kText : 0);
    }
    double left(std::size_t i) const { return kMargin + step * static_cast<double>(i % perRow); }
    double zero(std::size_t row) const { return kMargin + kAmplitude + rowStep * static_cast<double>(row); }
};

std::string opening(const std::string& name, double height) {
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(kWidth) + ' ' + number(height) +
           "\" width=\"" + number(kWidth) + "\" height=\"" + number(height) +
           "\">\n<title>Parallel coordinates of the vertices: " + xmlEscaped(name) + "</title>\n";
}

std::array<scene::Color, 4> axisColors() {
    const scene::Style& style = scene::style();
    return {style.axisX, style.axisY, style.axisZ, style.axisW};
}

/// Returns the density as SVG paths. The density is rounded to kTones tones; there is one path for each tone, with the
/// outlines of all pixels of this tone.
std::string densityPaths(const scene::DensityPlot& density) {
    using scene::DensityPlot;
    constexpr int kTones = 32;
    const auto toneAt = [&](int row, int column) {
        return (density.tones()[DensityPlot::index(row, column)] * kTones + 127) / 255;
    };
    std::array<std::string, kTones + 1> paths;
    for (int column = 0; column < DensityPlot::kColumns; ++column) {
        for (int row = 0, end = 0; row < DensityPlot::kRows; row = end) {
            const int tone = toneAt(row, column);
            while (end < DensityPlot::kRows && toneAt(end, column) == tone) ++end;
            paths[static_cast<std::size_t>(tone)] +=
                'M' + std::to_string(column) + ' ' + std::to_string(row) + "h1v" + std::to_string(end - row) + "h-1z";
        }
    }
    std::string out;
    for (int tone = 1; tone <= kTones; ++tone) {
        const std::string& path = paths[static_cast<std::size_t>(tone)];
        if (path.empty()) continue;
        out += "<path fill-opacity=\"" + number(static_cast<double>(tone) / kTones) + "\" d=\"" + path + "\"/>\n";
    }
    return out;
}

std::string strip(const SceneInput& source) {
    using scene::DensityPlot;
    scene::DensityPlot density;
    density.measure(source.scene.slices->rotatedVertices, glm::dmat4(1), source.scene.circumradius);
    const double step = (kWidth - 2 * kMargin) / 3, bottom = kMargin + 2 * kAmplitude;
    const std::array<scene::Color, 4> colors = axisColors();
    std::string out = opening(source.scene.title, bottom + kMargin + kText);
    out += "<linearGradient id=\"axes\" gradientUnits=\"userSpaceOnUse\" x1=\"0.5\" x2=\"" +
           number(DensityPlot::kColumns - 0.5) + "\">\n";
    for (int k = 0; k < 4; ++k)
        out += "<stop offset=\"" + number(k / 3.0) + "\" stop-color=\"" + color(colors[k]) + "\"/>\n";
    // Columns are centered on their axes, and rows on their values.
    const double across = step / DensityPlot::kGap, down = 2 * kAmplitude / (DensityPlot::kRows - 1);
    out +=
        "</linearGradient>\n<g id=\"density\" fill=\"url(#axes)\" shape-rendering=\"crispEdges\" "
        "transform=\"translate(" +
        number(kMargin - across / 2) + ' ' + number(kMargin - down / 2) + ") scale(" + std::to_string(across) + ' ' +
        std::to_string(down) + ")\">\n" + densityPaths(density) + "</g>\n";
    for (int k = 0; k < 4; ++k) {
        const std::string x = number(kMargin + k * step), name(1, "xyzw"[k]);
        out += "<line id=\"" + name + "\" stroke=\"" + color(colors[k]) + "\" stroke-width=\"1\" x1=\"" + x +
               "\" y1=\"" + number(kMargin) + "\" x2=\"" + x + "\" y2=\"" + number(bottom) +
               "\"/>\n<text font-family=\"DejaVu Sans, sans-serif\" font-size=\"" + number(kText) +
               "\" text-anchor=\"middle\" fill=\"#444444\" x=\"" + x + "\" y=\"" + number(bottom + 1.3 * kText) +
               "\">" + name + "</text>\n";
    }
    return out + "</svg>\n";
}

}  // namespace

std::string parallelCoordinatesSvg(const SceneInput& source) {
    if (source.scene.slices->rotatedVertices.size() > scene::kMaxVerticesAsLines) return strip(source);
    const Columns columns(source.scene.slices->rotatedVertices.size());
    const double height = columns.rowStep * static_cast<double>(columns.rows) + kMargin;
    const double right = columns.left(columns.perRow - 1) + columns.step;
    std::string out = opening(source.scene.title, height);
    out += "<g stroke=\"" + color(scene::style().zeroLine) + "\" stroke-width=\"0.4\">\n";
    for (std::size_t row = 0; row < columns.rows; ++row) {
        const std::string y = number(columns.zero(row));
        out +=
            "<line x1=\"" + number(kMargin) + "\" y1=\"" + y + "\" x2=\"" + number(right) + "\" y2=\"" + y + "\"/>\n";
    }
    out += "</g>\n";
    const std::array<scene::Color, 4> axes = axisColors();
    const double lineStep = columns.step / 5;
    for (int axis = 0; axis < 4; ++axis) {
        out += "<g id=\"" + std::string(1, "xyzw"[axis]) + "\" stroke=\"" + color(axes[axis]) + "\" stroke-width=\"" +
               number(std::min(1.6, 0.7 * lineStep)) + "\">\n";
        for (std::size_t i = 0; i < source.scene.slices->rotatedVertices.size(); ++i) {
            const std::string x = number(columns.left(i) + lineStep * (axis + 1));
            const double zero = columns.zero(i / columns.perRow);
            out +=
                "<line x1=\"" + x + "\" y1=\"" + number(zero) + "\" x2=\"" + x + "\" y2=\"" +
                number(zero - kAmplitude * source.scene.slices->rotatedVertices[i][axis] / source.scene.circumradius) +
                "\"/>\n";
        }
        out += "</g>\n";
    }
    if (columns.named) {
        out += "<g font-family=\"DejaVu Sans, sans-serif\" font-size=\"" + number(kText) +
               "\" text-anchor=\"middle\" fill=\"#444444\">\n";
        for (std::size_t i = 0; i < source.scene.slices->rotatedVertices.size(); ++i) {
            out += "<text x=\"" + number(columns.left(i) + columns.step / 2) + "\" y=\"" +
                   number(columns.zero(i / columns.perRow) + kAmplitude + 1.2 * kText) + "\">P" + std::to_string(i) +
                   "</text>\n";
        }
        out += "</g>\n";
    }
    return out + "</svg>\n";
}

}  // namespace oval4d::exports
