#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "scene/presence.hpp"
#include "scene/scene.hpp"

namespace oval4d::scene {

namespace {

// The oval for a circumradius of 1: slice u (−1 … 1 from the first to the last) stands at (kHalfWidth·u, 0,
// −kDepth·u²), and the camera looks down at the focus. The numbers come from a search for the largest focus slice at
// which neighbours hide little of each other; wide and tall windows want different ones.
struct Oval {
    double halfWidth, depth, pitch, distance;
};
constexpr Oval kWide{20.5, 49.0, 0.46, 8.3};
constexpr Oval kTall{7.0, 72.0, 0.52, 9.6};
constexpr int kUsualCount = 21;

constexpr double kMargin = 0.02;       // around the picture, of the viewport's height
constexpr double kLabelGap = 0.014;    // between a slice and its label
constexpr double kLabelRoom = 0.04;    // for the labels around the slices
constexpr double kSingleDistance = 7;  // from the eye to the slice in the single view

double mix(double a, double b, double t) { return a + (b - a) * t; }

Oval ovalFor(double aspect) {
    const double t = std::clamp((1.6 - aspect) / 1.04, 0.0, 1.0);
    return {mix(kWide.halfWidth, kTall.halfWidth, t), mix(kWide.depth, kTall.depth, t),
            mix(kWide.pitch, kTall.pitch, t), mix(kWide.distance, kTall.distance, t)};
}

// What the viewport leaves for the slices, in fractions of its height.
struct Room {
    double left, right, bottom, top;
};

void layOutStrip(std::size_t vertices, double aspect, CoordinatesLayout& out) {
    constexpr double kMostStep = 0.42, kAmplitude = 0.056, kNameRoom = 1.1;
    out = {.rows = 1, .perRow = static_cast<int>(vertices), .lineWidth = 0.0022, .amplitude = kAmplitude};
    out.density = true;
    out.lineStep = std::min((aspect - 4 * kMargin - out.lineWidth) / 3, kMostStep);
    out.left = (aspect - 3 * out.lineStep - out.lineWidth) / 2;
    out.zero = kMargin + kNameRoom * style().textHeight + kAmplitude;
}

void layOutCoordinates(std::size_t vertices, double aspect, CoordinatesLayout& out) {
    constexpr double kLeastColumn = 0.0095;
    constexpr double kMostColumn = 0.15;
    if (vertices > kMostLines) {
        layOutStrip(vertices, aspect, out);
        return;
    }
    const double width = aspect - 4 * kMargin;
    out.density = false;
    const auto count = static_cast<double>(std::max<std::size_t>(vertices, 1));
    out.rows = std::clamp(static_cast<int>(std::ceil(count * kLeastColumn / width)), 1, 6);
    out.perRow = static_cast<int>(std::ceil(count / out.rows));
    out.columnStep = std::min(width / out.perRow, kMostColumn);
    out.lineStep = std::min(out.columnStep * 0.21, 0.013);
    out.lineWidth = std::min(out.lineStep * 0.62, 0.0042);
    out.named = out.rows == 1 && out.columnStep > 2.2 * style().textHeight;
    out.amplitude = out.rows == 1 ? 0.052 : 0.019;
    out.rowStep = 2.25 * out.amplitude;
    out.left = (aspect - (out.columnStep * (out.perRow - 1) + 3 * out.lineStep + out.lineWidth)) / 2;
    out.zero = kMargin + (out.named ? 1.3 * style().textHeight : 0) + out.amplitude + (out.rows - 1) * out.rowStep;
}

std::string labelOf(double w, int decimals, bool focus) {
    char text[48];
    const double shown = std::abs(w) < 0.5 * std::pow(10, -decimals) ? 0 : std::abs(w);
    std::snprintf(text, sizeof text, "%.*f", shown == 0 ? 0 : decimals, shown);
    const std::string sign = shown == 0 || w > 0 ? "" : "\u2212";
    return (focus ? "w = " : "") + sign + text;
}

// Enough decimals that neighbours read differently.
int decimalsFor(double spacing) { return std::clamp(static_cast<int>(std::ceil(-std::log10(spacing))) + 1, 2, 9); }

// −1 … 1 from the first slice to the last.
double ordinal(std::size_t i, std::size_t count) {
    return count == 1 ? 0 : 2.0 * static_cast<double>(i) / static_cast<double>(count - 1) - 1;
}

// The frame in which a camera at pitch θ sees the world: right = x, up and toward are turned about x.
struct Eyes {
    double cos, sin, distance;
    explicit Eyes(const Oval& oval) : cos(std::cos(oval.pitch)), sin(std::sin(oval.pitch)), distance(oval.distance) {}
    double depth(const glm::dvec3& p) const { return distance - p.y * sin - p.z * cos; }
    double up(const glm::dvec3& p) const { return p.y * cos - p.z * sin; }
};

// The bounds of the slices' spheres on the plane at distance 1, each as if it were seen along the axis.
Room boundsOf(const std::vector<Stand>& stands, const Eyes& eyes, double radius) {
    constexpr double kInf = std::numeric_limits<double>::infinity();
    Room bounds{kInf, -kInf, kInf, -kInf};
    for (std::size_t i = 0; i < stands.size(); ++i) {
        const double u =
            stands.size() == 1 ? 0 : 2.0 * static_cast<double>(i) / static_cast<double>(stands.size() - 1) - 1;
        const double r = radius * std::sqrt(1 - u * u) / eyes.depth(stands[i].position);
        const double x = stands[i].position.x / eyes.depth(stands[i].position);
        const double y = eyes.up(stands[i].position) / eyes.depth(stands[i].position);
        bounds = {std::min(bounds.left, x - r), std::max(bounds.right, x + r), std::min(bounds.bottom, y - r),
                  std::max(bounds.top, y + r)};
    }
    return bounds;
}

// Chooses the field of view and the shift so that `bounds` fill `room`.
void fit(const Room& bounds, const Room& room, double aspect, double zoom, Camera& camera) {
    const double scale = std::min((room.right - room.left) / (bounds.right - bounds.left),
                                  (room.top - room.bottom) / (bounds.top - bounds.bottom));
    camera.fieldOfView = 2 * std::atan(0.5 / (scale * zoom));
    const double x = (room.left + room.right) / 2 - scale * (bounds.left + bounds.right) / 2;
    const double y = (room.bottom + room.top) / 2 - scale * (bounds.bottom + bounds.top) / 2;
    camera.shiftX = x / aspect - 0.5;
    camera.shiftY = y - 0.5;
}

void place(const geometry::Hyperplanes& planes, int focus, const Oval& oval, const Look& look,
           std::vector<Stand>& stands) {
    stands.resize(planes.count);
    const double half = std::max((planes.count - 1) / 2.0, 1.0);
    const Eyes eyes(oval);
    for (int i = 0; i < planes.count; ++i) {
        Stand& stand = stands[i];
        const double u = (planes.first + i - focus) / half;
        stand.index = planes.first + i;
        stand.w = planes.w(i);
        stand.focus = stand.index == focus;
        stand.drawn = look.view == View::oval || stand.focus;
        stand.position = {oval.halfWidth * u, 0, -oval.depth * u * u};
        stand.label = labelOf(stand.w, decimalsFor(planes.spacing), stand.focus);
        const double away = eyes.depth(stand.position) / eyes.distance;
        stand.labelSize = stand.focus ? 1.15 : std::clamp(std::pow(away, -0.25), 0.62, 1.0);
    }
}

void aim(const Orbit& orbit, const Oval& oval, Camera& camera) {
    constexpr double kSteepest = 1.55;  // short of straight down, where "up" would be lost
    const double pitch = std::clamp(oval.pitch + orbit.elevation, -kSteepest, kSteepest);
    const glm::dvec3 away{std::sin(orbit.azimuth) * std::cos(pitch), std::sin(pitch),
                          std::cos(orbit.azimuth) * std::cos(pitch)};
    camera.target = glm::dvec3(0);
    camera.eye = away * oval.distance;
    camera.up = {0, 1, 0};
    camera.near = 0.05 * oval.distance;
    camera.far = oval.distance + 2 * (oval.depth + oval.halfWidth) + 10;
}

// Hangs each label on the outer side of the oval, low rather than high: under the focus, beside the arms, where no
// neighbour stands.
void hangLabels(const Oval& oval, double radius, const Camera& camera, std::vector<Stand>& stands) {
    const Eyes eyes(oval);
    const glm::dmat4 view = camera.view();
    const glm::dvec3 right(view[0][0], view[1][0], view[2][0]);
    const glm::dvec3 up(view[0][1], view[1][1], view[2][1]);
    const double pixels = 0.5 / std::tan(camera.fieldOfView / 2);  // viewport heights per world unit, at depth 1
    const auto onScreen = [&](double u) {
        const glm::dvec3 p{oval.halfWidth * u, 0, -oval.depth * u * u};
        return glm::dvec2(p.x, eyes.up(p)) / eyes.depth(p);
    };
    for (std::size_t i = 0; i < stands.size(); ++i) {
        Stand& stand = stands[i];
        const double u = ordinal(i, stands.size());
        const glm::dvec2 along = onScreen(u + 1e-3) - onScreen(u - 1e-3);
        glm::dvec2 outward{0, -1};
        if (glm::length(along) > 0)
            outward = glm::normalize(glm::normalize(glm::dvec2(along.y, -along.x)) + glm::dvec2(0, -0.7));
        const double depth = -(view * glm::dvec4(stand.position, 1)).z;
        const double height = style().textHeight * stand.labelSize;
        const glm::dvec2 half{0.27 * height * static_cast<double>(stand.label.size()), 0.5 * height};
        const double reach = radius * std::sqrt(1 - u * u) * pixels / depth + kLabelGap + std::abs(outward.x) * half.x +
                             std::abs(outward.y) * half.y;
        const glm::dvec2 top = outward * reach + glm::dvec2(0, half.y);
        stand.labelAt = stand.position + (right * top.x + up * top.y) * (depth / pixels);
    }
}

double meanEdge(const geometry::Polytope& polytope) {
    double sum = 0;
    for (const auto& [a, b] : polytope.edges) sum += glm::distance(polytope.vertices[a], polytope.vertices[b]);
    return sum / static_cast<double>(polytope.edges.size());
}

}  // namespace

void compose(const geometry::Polytope& polytope, const geometry::Hyperplanes& planes, int focus, const Look& look,
             Viewport viewport, Scene& out, const geometry::Rotation& orientation) {
    const double aspect = static_cast<double>(viewport.width) / viewport.height;
    out.colours.paint(polytope, look.colouring, orientation, out.cellColours);
    const bool another = out.composedFor != polytope.serial;
    if (another || out.look.kinds != look.kinds) findPresences(polytope, look.kinds, out.presences);
    if (another) {
        out.composedFor = polytope.serial;
        // Balls and bars grow with the edges, so that they neither drown a 120-cell nor starve a 5-cell.
        out.thickness = 0.062 * std::min(1.0, std::pow(meanEdge(polytope) / polytope.circumradius, 0.65));
        // Those of a star cross each other: half as thick, they leave room to see where.
        if (!polytope.convex) out.thickness *= 0.5;
        out.circumradius = polytope.circumradius;
        out.faceOpacity = polytope.convex ? style().faceOpacity : 1;
    }
    out.look = look;
    out.viewport = viewport;
    layOutCoordinates(polytope.vertices.size(), aspect, out.coordinates);
    out.axes = {0.06, 0.075, 0.045};
    if (out.showsDensity() && (out.densityFor != polytope.serial || out.densityTurn != orientation)) {
        out.density.measure(polytope.vertices, orientation.matrix(), polytope.circumradius);
        out.densityFor = polytope.serial;
        out.densityTurn = orientation;
    }

    Room room{kMargin + kLabelRoom, aspect - kMargin - kLabelRoom, kMargin + kLabelRoom, 1 - kMargin};
    if (look.parts.coordinates) room.bottom += out.coordinates.zero + out.coordinates.amplitude;
    const bool single = look.view == View::single;
    const Oval oval = single ? Oval{0, 0, 0, kSingleDistance} : ovalFor(aspect);
    // Twice as many slices on the same parabola leave each about half the room.
    const double radius =
        single ? 1 : std::clamp(std::pow(static_cast<double>(kUsualCount) / planes.count, 0.8), 0.1, 1.25);
    out.scale = radius / polytope.circumradius;
    out.ballRadius = out.thickness * radius;
    out.barRadius = 0.4 * out.ballRadius;
    place(planes, focus, oval, look, out.stands);
    aim(look.orbit, oval, out.camera);
    fit(boundsOf(out.stands, Eyes(oval), radius + out.ballRadius), room, aspect, look.orbit.zoom, out.camera);
    hangLabels(oval, radius + out.ballRadius, out.camera, out.stands);
}

}  // namespace oval4d::scene
