#include "scene/color.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <glm/geometric.hpp>

namespace oval4d::scene {

namespace {

constexpr double kTau = 2 * std::numbers::pi;

Color packRgb(const std::array<double, 3>& rgb) {
    Color color = 0;
    for (const double c : rgb) color = color << 8U | static_cast<Color>(std::lround(255 * std::clamp(c, 0.0, 1.0)));
    return color;
}

// Converts a color from Oklch to sRGB (B. Ottosson, "A perceptual color space for image processing", 2020). In Oklch,
// colors of equal lightness look equally light, whatever their hue. Reduces the chroma of a color outside the sRGB
// gamut until the color is inside, or nearly gray. `hue` is in radians.
Color fromOklch(double lightness, double chroma, double hue) {
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
        return packRgb(rgb);
    }
}

// The lightness of a color in Oklch, 0 … 1, in each of the two color schemes.
struct LightnessPerScheme {
    double onDark, onLight;
};

// Returns the color, given in Oklch, for a color scheme. In the light scheme, reduces the lightness until the contrast
// to white is at least kLeastContrast.
Color oklchColorForScheme(ColorScheme scheme, LightnessPerScheme lightness, double chroma, double hue) {
    constexpr double kLeastContrast = 3.6;
    constexpr Color kWhite = 0xffffff;
    if (scheme == ColorScheme::dark) return fromOklch(lightness.onDark, chroma, hue);
    for (double least = lightness.onLight;; least *= 0.98) {
        const Color color = fromOklch(least, chroma, hue);
        if (contrast(color, kWhite) >= kLeastContrast) return color;
    }
}

// Returns color i of `count` colors with well-separated hues, for a color scheme.
Color distinctColor(std::size_t i, std::size_t count, ColorScheme scheme) {
    const double step = count <= 8 ? 1.0 / static_cast<double>(count) : std::numbers::phi - 1;
    const double hue = kTau * (0.07 + std::fmod(static_cast<double>(i) * step, 1.0));
    return oklchColorForScheme(scheme, i % 2 == 0 ? LightnessPerScheme{0.76, 0.61} : LightnessPerScheme{0.69, 0.5},
                               0.18, hue);
}

// If there are at most kFew cells, gives each of them a color of its own, with well-separated hues. If there are more
// cells, the Hopf map takes the direction of each cell's center to a point on the 2-sphere. The longitude of this point
// determines the hue, and its latitude the lightness. Therefore the cells of a ring along a Hopf fiber have the same
// color.
void assignColorsByCell(const slicing::Object& object, ColorScheme scheme, std::vector<Color>& out) {
    constexpr std::size_t kFew = 24;
    if (out.size() <= kFew) {
        for (std::size_t c = 0; c < out.size(); ++c) out[c] = distinctColor(c, out.size(), scheme);
        return;
    }
    std::vector<glm::dvec4> centers;
    slicing::findCellCenters(object, centers);
    for (std::size_t c = 0; c < out.size(); ++c) {
        const glm::dvec4& d = centers[c];
        const double r2 = std::max(glm::dot(d, d), 1e-300);
        const double p = 2 * (d.x * d.z + d.y * d.w) / r2;
        const double q = 2 * (d.y * d.z - d.x * d.w) / r2;
        const double height = (d.x * d.x + d.y * d.y - d.z * d.z - d.w * d.w) / r2;
        out[c] =
            oklchColorForScheme(scheme, {0.71 + 0.11 * height, 0.53 + 0.09 * height}, 0.16, std::atan2(q, p) + 0.45);
    }
}

void assignColorsByCellType(const slicing::Object& object, ColorScheme scheme, std::vector<Color>& out) {
    const std::size_t types = slicing::infoOf(object).cellTypes.size();
    const auto typeOfCell = slicing::typesOfCells(object);
    for (std::size_t c = 0; c < out.size(); ++c) out[c] = cellTypeColor(typeOfCell[c], types, scheme);
}

// A color scale: a table of kScaleSteps colors for values from −1 to 1.
constexpr int kScaleSteps = 255;
using ColorScale = std::array<Color, kScaleSteps>;
// Returns a color scale that is blue at −1, gray at 0 and amber at 1.
ColorScale divergingScale(ColorScheme scheme) {
    constexpr double kBlue = 4.5, kAmber = 1.25;  // the hues of blue and amber, in radians
    ColorScale scale{};
    for (int i = 0; i < kScaleSteps; ++i) {
        const double t = 2.0 * i / (kScaleSteps - 1) - 1, reach = std::abs(t);
        const LightnessPerScheme lightness{0.74 - 0.06 * reach * (t < 0 ? 1.5 : -0.5),
                                           0.62 - reach * (t < 0 ? 0.15 : 0.05)};
        scale.at(static_cast<std::size_t>(i)) =
            oklchColorForScheme(scheme, lightness, 0.01 + 0.17 * std::pow(reach, 0.8), t < 0 ? kBlue : kAmber);
    }
    return scale;
}

// One color scale for each color scheme. The index is the number of the enumerator of ColorScheme.
using ScalePerScheme = std::array<ColorScale, kSchemes.size()>;
ScalePerScheme colorScalesPerScheme(ColorScale (*make)(ColorScheme)) {
    return {make(ColorScheme::dark), make(ColorScheme::light)};
}
const ColorScale& colorScaleFor(const ScalePerScheme& scales, ColorScheme scheme) {
    return scales.at(static_cast<std::size_t>(scheme));
}

const ScalePerScheme& divergingScales() {
    static const ScalePerScheme kScales = colorScalesPerScheme(divergingScale);
    return kScales;
}

// The direction toward the 4-D light, which does not turn with the object: to the upper left, to the front and to large
// w.
const glm::dvec4 kLight = glm::normalize(glm::dvec4(-0.35, 0.65, 0.5, 0.6));

// Returns a color scale of one hue. Its values are cosines of angles between the normals of cells and the direction
// toward the light. The lightness grows from −1 to 1, so cells that are turned away from the light (at negative values)
// differ from each other, too.
ColorScale lightingColorScale(ColorScheme scheme) {
    constexpr double kHue = 4.2;
    constexpr LightnessPerScheme kDark{0.3, 0.22}, kRange{0.58, 0.4};
    ColorScale scale{};
    for (int i = 0; i < kScaleSteps; ++i) {
        const double light = std::pow(static_cast<double>(i) / (kScaleSteps - 1), 1.3);
        const LightnessPerScheme lightness{kDark.onDark + kRange.onDark * light,
                                           kDark.onLight + kRange.onLight * light};
        scale.at(static_cast<std::size_t>(i)) = oklchColorForScheme(scheme, lightness, 0.09, kHue);
    }
    return scale;
}

// Returns a color scale whose lightness grows evenly from −1 to 1, while the hue turns from blue through green to
// yellow.
ColorScale sequentialColorScale(ColorScheme scheme) {
    constexpr double kBlue = 4.8, kYellow = 1.8;
    constexpr LightnessPerScheme kDarkest{0.4, 0.28}, kLightest{0.92, 0.6};
    ColorScale scale{};
    for (int i = 0; i < kScaleSteps; ++i) {
        const double t = static_cast<double>(i) / (kScaleSteps - 1);
        const LightnessPerScheme lightness{std::lerp(kDarkest.onDark, kLightest.onDark, t),
                                           std::lerp(kDarkest.onLight, kLightest.onLight, t)};
        scale.at(static_cast<std::size_t>(i)) =
            oklchColorForScheme(scheme, lightness, 0.14, kBlue + (kYellow - kBlue) * t);
    }
    return scale;
}

Color colorAt(const ColorScale& scale, double value) {
    return scale.at(static_cast<std::size_t>(std::lround((std::clamp(value, -1.0, 1.0) + 1) / 2 * (kScaleSteps - 1))));
}

}  // namespace

std::string cssColor(Color color) {
    std::array<char, 8> text{};
    std::snprintf(text.data(), text.size(), "#%06x", color & 0xffffffU);
    return text.data();
}

double contrast(Color a, Color b) {
    const auto luminance = [](Color color) {
        const auto linear = [&](int shift) {
            const double c = (color >> shift & 255) / 255.0;
            return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
        };
        return 0.2126 * linear(16) + 0.7152 * linear(8) + 0.0722 * linear(0);
    };
    const auto [darker, lighter] = std::minmax({luminance(a), luminance(b)});
    return (lighter + 0.05) / (darker + 0.05);
}

Color cellTypeColor(std::size_t type, std::size_t count, ColorScheme scheme) {
    return distinctColor(type, count, scheme);
}

Color levelColor(std::size_t i, std::size_t count, ColorScheme scheme) {
    return distinctColor(i, std::max<std::size_t>(count, 3), scheme);
}

Color plainColor(ColorScheme scheme) { return oklchColorForScheme(scheme, {0.72, 0.55}, 0.1, 4.2); }

Color divergingColor(double value, ColorScheme scheme) {
    return colorAt(colorScaleFor(divergingScales(), scheme), std::isnan(value) ? 0 : value);
}

Color sequentialColor(double value, ColorScheme scheme) {
    static const ScalePerScheme kScales = colorScalesPerScheme(sequentialColorScale);
    return colorAt(colorScaleFor(kScales, scheme), 2 * value - 1);
}

Color noValueColor() {
    static const Color kGray = fromOklch(0.55, 0.01, 0);
    return kGray;
}

void CellColorAssigner::updateCellColors(const slicing::Object& object, Coloring coloring, ColorScheme scheme,
                                         const geometry::Rotation& orientation, std::vector<Color>& out) {
    const bool changed = prepareColors(object, coloring, scheme, slicing::elementCounts(object)[3], out);
    if (changed && coloring == Coloring::cell) assignColorsByCell(object, scheme, out);
    if (changed && coloring == Coloring::cell_type) assignColorsByCellType(object, scheme, out);
    if (changed && (coloring == Coloring::plain || coloring == Coloring::growth || coloring == Coloring::value))
        std::fill(out.begin(), out.end(), plainColor(scheme));
    if (coloring == Coloring::w) {
        if (changed) slicing::findCellCenters(object, directions_);
        colorByWOfCenters(object, changed, orientation, out);
    } else if (coloring == Coloring::light) {
        if (changed) setDirectionsToNormals(object);
        static const ScalePerScheme kScales = colorScalesPerScheme(lightingColorScale);
        colorByDirection(colorScaleFor(kScales, scheme), orientation.inverse()(kLight), out);
    }
}

void CellColorAssigner::updateFaceColors(const slicing::Object& object, Coloring coloring, ColorScheme scheme,
                                         const geometry::Rotation& orientation, std::vector<Color>& out) {
    const std::size_t count = coloring == Coloring::w ? slicing::elementCounts(object)[2] : 1;
    const bool changed = prepareColors(object, coloring, scheme, count, out);
    if (coloring == Coloring::w) {
        if (changed) slicing::findFaceCenters(object, directions_);
        colorByWOfCenters(object, changed, orientation, out);
    } else if (changed) {
        out[0] = plainColor(scheme);
    }
}

// Resizes `out` to `count` colors, and stores the object, the coloring and the color scheme for which they are. Returns
// whether one of these, or the number of colors, differs from the last call.
bool CellColorAssigner::prepareColors(const slicing::Object& object, Coloring coloring, ColorScheme scheme,
                                      std::size_t count, std::vector<Color>& out) {
    const std::uint64_t serial = slicing::infoOf(object).serial;
    const bool changed = assignedFor_ != serial || coloring_ != coloring || scheme_ != scheme || out.size() != count;
    assignedFor_ = serial;
    coloring_ = coloring;
    scheme_ = scheme;
    out.resize(count);
    return changed;
}

// Gives each cell or 2-face the divergingColor() for the w of its center. If `isNew` is true, scales the centers in
// directions_ first; otherwise, an earlier call has already scaled them.
void CellColorAssigner::colorByWOfCenters(const slicing::Object& object, bool isNew,
                                          const geometry::Rotation& orientation, std::vector<Color>& out) {
    if (isNew) scaleDirections(slicing::infoOf(object).circumradius);
    colorByDirection(colorScaleFor(divergingScales(), scheme_), orientation.inverse()(glm::dvec4(0, 0, 0, 1)), out);
}

// Scales directions_ (the centers of cells or 2-faces) so that the longest vector has the length 1.
void CellColorAssigner::scaleDirections(double circumradius) {
    double farthest = 0;
    for (const glm::dvec4& center : directions_) farthest = std::max(farthest, glm::length(center));
    // If all centers are at the origin, apart from rounding errors, all entries become 0, and everything gets the color
    // for w = 0.
    const bool anyAway = farthest > 1e-9 * circumradius;
    for (glm::dvec4& center : directions_) center *= anyAway ? 1 / farthest : 0;
}

// Sets directions_ to the unit normals of the cells; to 0 for a cell whose signed volume is 0, as that of some
// self-intersecting cells is.
void CellColorAssigner::setDirectionsToNormals(const slicing::Object& object) {
    std::vector<double> offsets;
    slicing::findCellHyperplanes(object, directions_, offsets);
    for (glm::dvec4& normal : directions_) {
        const double length = glm::length(normal);
        if (length > 0) normal /= length;
    }
}

// Gives each cell or 2-face the color of `scale` at the dot product of its entry in directions_ and `axis`. `axis` is a
// unit vector in coordinates before the rotation.
void CellColorAssigner::colorByDirection(const std::array<Color, 255>& scale, const glm::dvec4& axis,
                                         std::vector<Color>& out) const {
    for (std::size_t c = 0; c < out.size(); ++c) out[c] = colorAt(scale, glm::dot(axis, directions_[c]));
}

}  // namespace oval4d::scene
