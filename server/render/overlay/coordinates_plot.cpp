#include "render/overlay/coordinates_plot.hpp"

#include <array>
#include <cstddef>

#include "render/color.hpp"
#include "scene/density_plot.hpp"
#include "slicing/coordinate_value_histograms.hpp"

namespace oval4d::render {

namespace {

constexpr std::string_view kVertexSource = R"(
layout(location = 0) in vec2 at;
layout(location = 1) in vec2 texelIn;
layout(location = 2) in vec4 colorIn;
out vec2 texel;
out vec3 color;
void main() {
    texel = texelIn;
    color = colorIn.rgb;
    gl_Position = vec4(at, 0.0, 1.0);
}
)";

constexpr std::string_view kFragmentSource = R"(
in vec2 texel;
in vec3 color;
uniform sampler2D density;
out vec4 pixel;
void main() { pixel = vec4(color, 1.0) * texture(density, texel).r; }
)";

}  // namespace

DensityStripOrHistogramPainter::DensityStripOrHistogramPainter()
    : program_(kVertexSource, kFragmentSource, sizeof(PlotVertex),
               std::to_array<VertexAttribute>({{2, GL_FLOAT, offsetof(PlotVertex, at)},
                                               {2, GL_FLOAT, offsetof(PlotVertex, texel)},
                                               {4, GL_UNSIGNED_BYTE, offsetof(PlotVertex, color)}})) {
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    for (const GLenum direction : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        glTexParameteri(GL_TEXTURE_2D, direction, GL_CLAMP_TO_EDGE);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
}

DensityStripOrHistogramPainter::~DensityStripOrHistogramPainter() { glDeleteTextures(1, &texture_); }

void DensityStripOrHistogramPainter::drawStripOrHistogram(const scene::Scene& scene) {
    using scene::DensityPlot, slicing::CoordinateValueHistograms;
    const bool showsHistogram = scene.showsHistogram();
    if (!showsHistogram && !scene.showsDensityStrip()) return;
    uploadTones(scene.plotTones, showsHistogram ? CoordinateValueHistograms::kColumns : DensityPlot::kColumns);
    corners_.clear();
    indices_.clear();
    const scene::ParallelCoordinatesLayout& layout = scene.coordinates;
    for (int k = 0; k < 4; ++k) {
        const scene::Color color = scene.style().axes[static_cast<std::size_t>(k)];
        const double x = layout.left + k * layout.lineStep;
        if (showsHistogram) {
            const int column = k * CoordinateValueHistograms::kPanel;
            addVerticalSide(scene, x, column, color);
            addVerticalSide(scene, x + layout.panel, column + CoordinateValueHistograms::kPanel - 1, color);
            addQuadBetweenLastSides();
        } else {
            addVerticalSide(scene, x + layout.lineWidth / 2, k * DensityPlot::kGap, color);
            if (k > 0) addQuadBetweenLastSides();
        }
    }
    program_.draw(corners_.data(), corners_.size(), indices_);
}

void DensityStripOrHistogramPainter::uploadTones(const std::vector<std::uint8_t>& tones, int columns) {
    const int rows = static_cast<int>(tones.size()) / columns;
    glBindTexture(GL_TEXTURE_2D, texture_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (columns_ == columns && rows_ == rows) {
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, columns, rows, GL_RED, GL_UNSIGNED_BYTE, tones.data());
    } else {
        glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, columns, rows, 0, GL_RED, GL_UNSIGNED_BYTE, tones.data());
        columns_ = columns;
        rows_ = rows;
    }
}

// Adds the two ends of a vertical side of a quadrilateral, at x (in viewport heights from the left). The side shows the
// center of column `column` of the texture: from the last row at the lower end to the first row at the upper end.
void DensityStripOrHistogramPainter::addVerticalSide(const scene::Scene& scene, double x, double column,
                                                     scene::Color color) {
    const double aspect = static_cast<double>(scene.viewport.width) / scene.viewport.height;
    for (const bool above : {false, true}) {
        const double y = scene.coordinates.zero + (above ? 1 : -1) * scene.coordinates.amplitude;
        const double row = above ? 0.5 : rows_ - 0.5;
        corners_.push_back({{2 * x / aspect - 1, 2 * y - 1}, {(column + 0.5) / columns_, row / rows_}, rgba(color, 1)});
    }
}

// Adds the quadrilateral between the last two sides that addVerticalSide() has added.
void DensityStripOrHistogramPainter::addQuadBetweenLastSides() {
    const auto first = static_cast<std::uint32_t>(corners_.size()) - 4;
    for (const std::uint32_t corner : {0U, 2U, 1U, 1U, 2U, 3U}) indices_.push_back(first + corner);
}

}  // namespace oval4d::render
