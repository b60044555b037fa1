#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "scene/scene.hpp"

namespace oval4d::scene {

namespace {

constexpr double kTau = 2 * std::numbers::pi;

Colour pack(const std::array<double, 3>& rgb) {
    Colour colour = 0;
    for (const double c : rgb) colour = colour << 8U | static_cast<Colour>(std::lround(255 * std::clamp(c, 0.0, 1.0)));
    return colour;
}

// Oklch to sRGB (B. Ottosson, "A perceptual color space for image processing", 2020): equal lightness looks equally
// light at every hue. Out of gamut, chroma gives way.
Colour oklch(double lightness, double chroma, double hue) {
    for (;; chroma *= 0.95) {
        const double a = chroma * std::cos(hue);
        const double b = chroma * std::sin(hue);
        const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
        const double m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
        const double s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
        std::array<double, 3> rgb{4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
                                  -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
                                  -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
        const auto [least, most] = std::minmax_element(rgb.begin(), rgb.end());
        if (chroma > 0.01 && (*least < 0 || *most > 1)) continue;
        for (double& c : rgb) c = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
        return pack(rgb);
    }
}

glm::dvec4 centreOf(const geometry::Polytope& polytope, std::size_t cell) {
    glm::dvec4 sum(0);
    for (const auto face : polytope.cells[cell]) {
        for (const auto v : polytope.faces[face]) sum += polytope.vertices[v];
    }
    return sum;
}

// Few cells: as far apart in hue as can be. Many: the Hopf map takes the direction of a cell's centre to a point of
// the sphere, whose longitude is the hue and whose latitude the lightness; a ring of cells keeps one colour.
std::vector<Colour> paint(const geometry::Polytope& polytope) {
    constexpr std::size_t kFew = 24;
    const std::size_t cells = polytope.cells.size();
    std::vector<Colour> colours(cells);
    for (std::size_t c = 0; c < cells; ++c) {
        if (cells <= kFew) {
            const double step = cells <= 8 ? 1.0 / static_cast<double>(cells) : std::numbers::phi - 1;
            colours[c] =
                oklch(c % 2 == 0 ? 0.76 : 0.69, 0.18, kTau * (0.07 + std::fmod(static_cast<double>(c) * step, 1.0)));
            continue;
        }
        const glm::dvec4 d = centreOf(polytope, c);
        const double r2 = std::max(glm::dot(d, d), 1e-300);
        const double p = 2 * (d.x * d.z + d.y * d.w) / r2;
        const double q = 2 * (d.y * d.z - d.x * d.w) / r2;
        const double height = (d.x * d.x + d.y * d.y - d.z * d.z - d.w * d.w) / r2;
        colours[c] = oklch(0.71 + 0.11 * height, 0.16, std::atan2(q, p) + 0.45);
    }
    return colours;
}

}  // namespace

std::shared_ptr<const std::vector<Colour>> cellColours(const geometry::Polytope& polytope) {
    return std::make_shared<const std::vector<Colour>>(paint(polytope));
}

}  // namespace oval4d::scene
