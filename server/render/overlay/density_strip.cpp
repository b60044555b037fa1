#include "render/overlay/density_strip.hpp"

#include <array>
#include <cstddef>

#include <glm/vec2.hpp>

#include "render/color.hpp"
#include "scene/density_plot.hpp"

namespace oval4d::render {

namespace {

struct Corner {
    glm::vec2 at{0};     ///< clip coordinates, −1 … 1
    glm::vec2 texel{0};  ///< texture coordinates, 0 … 1 from the upper left corner of the density
    std::uint32_t color = 0;
};

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

constexpr Attribute kAttributes[] = {{2, GL_FLOAT, offsetof(Corner, at)},
                                     {2, GL_FLOAT, offsetof(Corner, texel)},
                                     {4, GL_UNSIGNED_BYTE, offsetof(Corner, color)}};

}  // namespace

DensityStrip::DensityStrip() : program_(kVertexSource, kFragmentSource, sizeof(Corner), kAttributes) {
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    for (const GLenum direction : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        glTexParameteri(GL_TEXTURE_2D, direction, GL_CLAMP_TO_EDGE);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, scene::DensityPlot::kColumns, scene::DensityPlot::kRows, 0, GL_RED,
                 GL_UNSIGNED_BYTE, nullptr);
}

DensityStrip::~DensityStrip() { glDeleteTextures(1, &texture_); }

void DensityStrip::draw(const scene::Scene& scene) {
    using scene::DensityPlot;
    if (!scene.showsDensity()) return;
    glBindTexture(GL_TEXTURE_2D, texture_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, DensityPlot::kColumns, DensityPlot::kRows, GL_RED, GL_UNSIGNED_BYTE,
                    scene.density.data());

    const scene::CoordinatesLayout& layout = scene.coordinates;
    const scene::Style& style = scene::style();
    const double aspect = static_cast<double>(scene.viewport.width) / scene.viewport.height;
    const auto& colors = style.axes;
    std::array<Corner, 8> corners;  // the lower and the upper end of each axis
    for (std::size_t k = 0; k < 4; ++k)
        for (const std::size_t above : {0u, 1u}) {
            const double x = layout.left + static_cast<double>(k) * layout.lineStep + layout.lineWidth / 2;
            const double y = layout.zero + (above != 0 ? 1 : -1) * layout.amplitude;
            // Coordinates of texel centers: the first and the last row are at the ends of the axes.
            const double column = static_cast<double>(k) * DensityPlot::kGap + 0.5;
            const double row = above != 0 ? 0.5 : DensityPlot::kRows - 0.5;
            corners[2 * k + above] = {{2 * x / aspect - 1, 2 * y - 1},
                                      {column / DensityPlot::kColumns, row / DensityPlot::kRows},
                                      rgba(colors[k], 1)};
        }
    constexpr std::array<std::uint32_t, 18> kIndices{0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5, 4, 6, 5, 5, 6, 7};
    program_.draw(corners.data(), corners.size(), kIndices);
}

}  // namespace oval4d::render
