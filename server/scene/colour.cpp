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

// The mean of a cell's vertices, each as often as 2-faces of the cell meet there.
glm::dvec4 centreOf(const geometry::Polytope& polytope, std::size_t cell) {
    glm::dvec4 sum(0);
    double count = 0;
    for (const auto face : polytope.cells[cell]) {
        for (const auto v : polytope.faces[face]) sum += polytope.vertices[v];
        count += static_cast<double>(polytope.faces[face].size());
    }
    return sum / count;
}

// Number i of `count` colours, as far apart in hue as can be.
Colour distinct(std::size_t i, std::size_t count) {
    const double step = count <= 8 ? 1.0 / static_cast<double>(count) : std::numbers::phi - 1;
    return oklch(i % 2 == 0 ? 0.76 : 0.69, 0.18, kTau * (0.07 + std::fmod(static_cast<double>(i) * step, 1.0)));
}

// Few cells: colours far apart. Many: the Hopf map takes the direction of a cell's centre to a point of the sphere,
// whose longitude is the hue and whose latitude the lightness; a ring of cells keeps one colour.
void paintByCell(const geometry::Polytope& polytope, std::vector<Colour>& out) {
    constexpr std::size_t kFew = 24;
    for (std::size_t c = 0; c < out.size(); ++c) {
        if (out.size() <= kFew) {
            out[c] = distinct(c, out.size());
            continue;
        }
        const glm::dvec4 d = centreOf(polytope, c);
        const double r2 = std::max(glm::dot(d, d), 1e-300);
        const double p = 2 * (d.x * d.z + d.y * d.w) / r2;
        const double q = 2 * (d.y * d.z - d.x * d.w) / r2;
        const double height = (d.x * d.x + d.y * d.y - d.z * d.z - d.w * d.w) / r2;
        out[c] = oklch(0.71 + 0.11 * height, 0.16, std::atan2(q, p) + 0.45);
    }
}

void paintByKind(const geometry::Polytope& polytope, std::vector<Colour>& out) {
    std::vector<Colour> kinds;
    for (std::size_t k = 0; k < std::max<std::size_t>(polytope.kinds.size(), 1); ++k)
        kinds.push_back(kindColour(k, polytope.kinds.size()));
    for (std::size_t c = 0; c < out.size(); ++c) out[c] = kinds[polytope.cellKinds[c]];
}

// From blue through grey to amber, for −1 … 1.
constexpr int kSteps = 255;
using Scale = std::array<Colour, kSteps>;
Scale divergingScale() {
    constexpr double kBlue = 4.5, kAmber = 1.25;  // hues
    Scale scale{};
    for (int i = 0; i < kSteps; ++i) {
        const double t = 2.0 * i / (kSteps - 1) - 1;
        scale.at(static_cast<std::size_t>(i)) = oklch(0.74 - 0.06 * std::abs(t) * (t < 0 ? 1.5 : -0.5),
                                                      0.01 + 0.17 * std::pow(std::abs(t), 0.8), t < 0 ? kBlue : kAmber);
    }
    return scale;
}

}  // namespace

Colour kindColour(std::size_t kind, std::size_t count) { return distinct(kind, count); }

void CellColours::paint(const geometry::Polytope& polytope, Colouring colouring, const geometry::Rotation& orientation,
                        std::vector<Colour>& out) {
    const bool another =
        paintedFor_ != polytope.serial || colouring_ != colouring || out.size() != polytope.cellCount();
    paintedFor_ = polytope.serial;
    colouring_ = colouring;
    out.resize(polytope.cellCount());
    if (another && colouring == Colouring::cell) paintByCell(polytope, out);
    if (another && colouring == Colouring::kind) paintByKind(polytope, out);
    if (another && colouring == Colouring::plain) std::fill(out.begin(), out.end(), oklch(0.72, 0.1, 4.2));
    if (colouring != Colouring::w) return;
    if (another) {
        centres_.resize(out.size());
        double farthest = 0;
        for (std::size_t c = 0; c < out.size(); ++c) {
            centres_[c] = centreOf(polytope, c);
            farthest = std::max(farthest, glm::length(centres_[c]));
        }
        // Cells that all pass through the middle have no w to tell apart.
        for (glm::dvec4& centre : centres_) centre *= farthest > 1e-9 * polytope.circumradius ? 1 / farthest : 0;
    }
    static const Scale kScale = divergingScale();
    const glm::dmat4 turn = orientation.matrix();
    const glm::dvec4 toW(turn[0][3], turn[1][3], turn[2][3], turn[3][3]);
    for (std::size_t c = 0; c < out.size(); ++c) {
        const double t = std::clamp(glm::dot(toW, centres_[c]), -1.0, 1.0);
        out[c] = kScale.at(static_cast<std::size_t>(std::lround((t + 1) / 2 * (kSteps - 1))));
    }
}

}  // namespace oval4d::scene
