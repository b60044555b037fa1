#include "export/formats/writers.hpp"

#include <array>
#include <cstdio>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>

#include "export/formats/text.hpp"

namespace oval4d::exports {

namespace {

std::string svgNumber(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.3f", value + 0.0);
    return text.data();
}

std::string attribute(std::string_view name, const std::string& value) {
    return ' ' + std::string(name) + "=\"" + value + '"';
}
std::string attribute(std::string_view name, double value) { return attribute(name, svgNumber(value)); }

/// Returns points as text for the attribute `points`.
std::string pointListText(const std::vector<glm::dvec2>& points) {
    std::string list;
    for (const glm::dvec2& point : points) {
        if (!list.empty()) list += ' ';
        list += svgNumber(point.x) + ',' + svgNumber(point.y);
    }
    return list;
}

std::string opacityAttribute(std::string_view name, double opacity) {
    return opacity < 1 ? attribute(name, opacity) : std::string();
}

/// Returns the opacities of an image (OpacityImage::alphas) as SVG paths. Opacities are rounded to multiples of
/// 1/kTones. For each opacity except 0, there is a path of rectangles, which cover all pixels of this opacity. A pixel
/// is a unit square.
std::string densityPaths(const OpacityImage& density) {
    constexpr int kTones = 32;
    const auto toneAt = [&](int row, int column) { return (density.alpha(row, column) * kTones + 127) / 255; };
    std::array<std::string, kTones + 1> paths;
    for (int column = 0; column < density.columns; ++column) {
        for (int row = 0, end = 0; row < density.rows(); row = end) {
            const int tone = toneAt(row, column);
            while (end < density.rows() && toneAt(end, column) == tone) ++end;
            paths[static_cast<std::size_t>(tone)] +=
                'M' + std::to_string(column) + ' ' + std::to_string(row) + "h1v" + std::to_string(end - row) + "h-1z";
        }
    }
    std::string out;
    for (int tone = 1; tone <= kTones; ++tone) {
        const std::string& path = paths[static_cast<std::size_t>(tone)];
        if (path.empty()) continue;
        out += "<path fill-opacity=\"" + svgNumber(static_cast<double>(tone) / kTones) + "\" d=\"" + path + "\"/>\n";
    }
    return out;
}

/// Returns an SVG gradient with the id `axes-colors`, which runs through OpacityImage::colors from the first column to
/// the last.
std::string svgGradientOf(const OpacityImage& density) {
    std::string out = "<linearGradient id=\"axes-colors\" gradientUnits=\"userSpaceOnUse\"" + attribute("x1", 0.5) +
                      attribute("x2", density.columns - 0.5) + ">\n";
    const double last = static_cast<double>(density.colors.size()) - 1;
    for (std::size_t k = 0; k < density.colors.size(); ++k) {
        out += "<stop" + attribute("offset", static_cast<double>(k) / last) +
               attribute("stop-color", scene::cssColor(density.colors[k])) + "/>\n";
    }
    return out + "</linearGradient>\n";
}

/// A visitor that returns a shape as an SVG element.
struct SvgElementWriter {
    std::string operator()(const LineSegment& line) const {
        return "<line" + (line.id.empty() ? "" : attribute("id", xmlEscaped(line.id))) +
               attribute("stroke", scene::cssColor(line.color)) + attribute("stroke-width", line.width) +
               (line.roundEnds ? attribute("stroke-linecap", "round") : "") +
               opacityAttribute("stroke-opacity", line.opacity) + attribute("x1", line.from.x) +
               attribute("y1", line.from.y) + attribute("x2", line.to.x) + attribute("y2", line.to.y) + "/>\n";
    }
    std::string operator()(const Polyline& line) const {
        return "<polyline fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\"" +
               attribute("stroke", scene::cssColor(line.color)) + attribute("stroke-width", line.width) +
               attribute("points", pointListText(line.points)) + "/>\n";
    }
    std::string operator()(const FilledPolygon& polygon) const {
        return "<polygon" + attribute("fill", scene::cssColor(polygon.color)) +
               opacityAttribute("fill-opacity", polygon.opacity) + attribute("points", pointListText(polygon.corners)) +
               "/>\n";
    }
    std::string operator()(const Disk& disk) const {
        return "<circle" + attribute("fill", scene::cssColor(disk.color)) +
               opacityAttribute("fill-opacity", disk.opacity) + attribute("cx", disk.center.x) +
               attribute("cy", disk.center.y) + attribute("r", disk.radius) + "/>\n";
    }
    std::string operator()(const TextLine& line) const {
        return "<text font-family=\"DejaVu Sans, sans-serif\" text-anchor=\"middle\"" +
               attribute("font-size", line.size) + attribute("fill", scene::cssColor(line.color)) +
               attribute("x", line.at.x) + attribute("y", line.at.y) + '>' + xmlEscaped(line.text) + "</text>\n";
    }
    std::string operator()(const OpacityImage& density) const {
        // The centers of the outer pixels lie on the edges of the rectangle (see OpacityImage), so the image extends
        // half a pixel beyond it.
        const double across = (density.bottomRight.x - density.topLeft.x) / (density.columns - 1);
        const double down = (density.bottomRight.y - density.topLeft.y) / (density.rows() - 1);
        const bool isPlain = density.colors.size() == 1;
        return (isPlain ? std::string() : svgGradientOf(density)) + "<g" +
               attribute("fill", isPlain ? scene::cssColor(density.colors.front()) : "url(#axes-colors)") +
               " shape-rendering=\"crispEdges\" transform=\"translate(" + svgNumber(density.topLeft.x - across / 2) +
               ' ' + svgNumber(density.topLeft.y - down / 2) + ") scale(" + std::to_string(across) + ' ' +
               std::to_string(down) + ")\">\n" + densityPaths(density) + "</g>\n";
    }
};

}  // namespace

std::string svg(const Drawing& drawing) {
    const auto millimeters = [&](double length) { return svgNumber(length * drawing.millimetersPerUnit()) + "mm"; };
    std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + svgNumber(drawing.width) + ' ' +
                      svgNumber(drawing.height) + '"' + attribute("width", millimeters(drawing.width)) +
                      attribute("height", millimeters(drawing.height)) + ">\n<title>" + xmlEscaped(drawing.title) +
                      "</title>\n";
    for (const ShapeGroup& group : drawing.groups) {
        out += "<g" + attribute("id", xmlEscaped(group.id)) + ">\n";
        for (const DrawnShape& shape : group.shapes) out += std::visit(SvgElementWriter(), shape);
        out += "</g>\n";
    }
    return out + "</svg>\n";
}

}  // namespace oval4d::exports
