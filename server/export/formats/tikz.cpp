#include "export/formats/writers.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <set>
#include <string>
#include <string_view>
#include <variant>

#include <glm/vec2.hpp>

#include "export/drawing/bounds.hpp"
#include "export/formats/text.hpp"

namespace oval4d::exports {

namespace {

// The absolute coordinate at which shapes are cut, in points. Lengths in TeX are less than 16,384 points (The TeXbook,
// chapter 10).
constexpr double kFarthestPoints = 16'000, kPointsPerMillimeter = 72.27 / 25.4;

// Returns a number with at most `count` decimals.
std::string toDecimal(double value, int count) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.*f", count, value);
    std::string out = text.data();
    if (out.find('.') == std::string::npos) return out;
    out.erase(out.find_last_not_of('0') + 1);
    if (out.back() == '.') out.pop_back();
    return out == "-0" ? "0" : out;
}

std::string tikzPosition(const glm::dvec2& at) { return '(' + toDecimal(at.x, 2) + ',' + toDecimal(at.y, 2) + ')'; }

// Returns ASCII text as LaTeX. A hyphen before a digit becomes a minus sign, if it is at the start or after a blank.
std::string latexEscaped(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        const bool isSign =
            c == '-' && i + 1 < text.size() && std::isdigit(static_cast<unsigned char>(text[i + 1])) != 0;
        if (isSign && (i == 0 || text[i - 1] == ' ')) {
            out += "$-$";
        } else if (c == '\\') {
            out += "\\textbackslash{}";
        } else if (c == '~') {
            out += "\\textasciitilde{}";
        } else if (c == '^') {
            out += "\\textasciicircum{}";
        } else if (c == '<' || c == '>' || c == '|') {
            out += std::string("$") + (c == '|' ? "\\vert" : std::string(1, c)) + '$';
        } else {
            if (std::string_view("{}#$%&_").find(c) != std::string_view::npos) out += '\\';
            out += c;
        }
    }
    return out;
}

/// A visitor that writes shapes as TikZ commands and collects their colors.
class TikzCommandWriter {
  public:
    /// `unit` is Drawing::millimetersPerUnit() of the drawing whose shapes are written.
    explicit TikzCommandWriter(double unit) : unit_(unit) {}

    void operator()(const LineSegment& line) {
        out += "\\draw[" + registerColor(line.color) + ",line width=" + millimeters(line.width) +
               (line.roundEnds ? ",line cap=round" : "") + opacityOption("draw", line.opacity) + "] " +
               tikzPosition(line.from) + " -- " + tikzPosition(line.to) + ";\n";
    }
    void operator()(const Polyline& line) {
        out += "\\draw[" + registerColor(line.color) + ",line width=" + millimeters(line.width) +
               ",line cap=round,line join=round]";
        for (std::size_t i = 0; i < line.points.size(); ++i) {
            if (i > 0) out += " --";
            appendPathPoint(line.points[i], i);
        }
        out += ";\n";
    }
    void operator()(const FilledPolygon& polygon) {
        out += "\\fill[" + registerColor(polygon.color) + opacityOption("fill", polygon.opacity) + ']';
        for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
            appendPathPoint(polygon.corners[i], i);
            out += " --";
        }
        out += " cycle;\n";
    }
    void operator()(const Disk& disk) {
        out += "\\fill[" + registerColor(disk.color) + opacityOption("fill", disk.opacity) + "] " +
               tikzPosition(disk.center) + " circle[radius=" + millimeters(disk.radius) + "];\n";
    }
    void operator()(const TextLine& line) {
        const std::string size = toDecimal(line.size * unit_ * kPointsPerMillimeter, 2);
        out += "\\node[anchor=base,inner sep=0pt,text=" + registerColor(line.color) + ",font=\\fontsize{" + size +
               "}{" + size + "}\\selectfont] at " + tikzPosition(line.at) + " {" + latexEscaped(line.text) + "};\n";
    }
    void operator()(const OpacityImage& density) {
        // The centers of the outer pixels lie on the edges of the rectangle (see OpacityImage), so the image extends
        // half a pixel beyond it.
        const glm::dvec2 size = density.bottomRight - density.topLeft;
        const glm::dvec2 pixel(size.x / (density.columns - 1), size.y / (density.rows() - 1));
        for (int column = 0; column < density.columns; ++column) {
            const std::string color = registerColor(density.colorOfPixelColumn(column));
            for (int row = 0, end = 0; row < density.rows(); row = end) {
                const std::uint8_t alpha = density.alpha(row, column);
                while (end < density.rows() && density.alpha(end, column) == alpha) ++end;
                if (alpha == 0) continue;
                const auto corner = [&](int x, int y) {
                    return tikzPosition(density.topLeft + (glm::dvec2(x, y) - 0.5) * pixel);
                };
                out += "\\fill[" + color + opacityOption("fill", alpha / 255.0) + "] " + corner(column, row) +
                       " rectangle " + corner(column + 1, end) + ";\n";
            }
        }
    }

    /// Returns the definitions of all colors that were used.
    std::string colorDefinitions() const {
        std::string definitions;
        for (const scene::Color color : colors_)
            definitions += "\\definecolor{" + colorName(color) + "}{HTML}{" + hexadecimal(color) + "}\n";
        return definitions;
    }

    std::string out;  ///< the TikZ commands

  private:
    // Appends point i of a path, counted from 0. Each line of the file has at most kPointsPerLine points.
    void appendPathPoint(const glm::dvec2& point, std::size_t i) {
        constexpr std::size_t kPointsPerLine = 6;
        out += i > 0 && i % kPointsPerLine == 0 ? '\n' : ' ';
        out += tikzPosition(point);
    }

    std::string millimeters(double length) const { return toDecimal(length * unit_, 3) + "mm"; }

    static std::string opacityOption(std::string_view of, double opacity) {
        return opacity < 1 ? ',' + std::string(of) + " opacity=" + toDecimal(opacity, 3) : std::string();
    }
    static std::string hexadecimal(scene::Color color) {
        std::array<char, 8> digits{};
        std::snprintf(digits.data(), digits.size(), "%06X", color & 0xFFFFFFU);
        return digits.data();
    }
    static std::string colorName(scene::Color color) { return "oval" + hexadecimal(color); }
    // Returns the LaTeX name of a color, and adds the color to the colors that colorDefinitions() returns.
    std::string registerColor(scene::Color color) {
        colors_.insert(color);
        return colorName(color);
    }

    double unit_;
    std::set<scene::Color> colors_;
};

}  // namespace

std::string tikz(const Drawing& drawing) {
    const double unit = drawing.millimetersPerUnit(),
                 farthest = kFarthestPoints / std::max(1.0, unit * kPointsPerMillimeter);
    TikzCommandWriter writer(unit);
    for (const ShapeGroup& group : drawing.groups) {
        writer.out += "% " + group.id + '\n';
        for (const DrawnShape& shape : group.shapes) {
            if (const auto drawn = cutAtBounds(shape, farthest)) std::visit(writer, *drawn);
        }
    }
    const std::string across = toDecimal(unit, 6) + "mm";
    return "% " + removeNonXmlCharacters(drawing.title) + "\n% A figure of " + toDecimal(drawing.width * unit, 1) +
           " mm by " + toDecimal(drawing.height * unit, 1) +
           " mm for LaTeX. In the preamble: \\usepackage{tikz}. In the text: \\input{this file}.\n" +
           "\\begin{tikzpicture}[x=" + across + ",y=-" + across + "]\n" + writer.colorDefinitions() +
           "\\clip (0,0) rectangle " + tikzPosition({drawing.width, drawing.height}) + ";\n" + writer.out +
           "\\end{tikzpicture}%\n";
}

}  // namespace oval4d::exports
