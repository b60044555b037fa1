#include "scene/layout.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "scene/style.hpp"

namespace oval4d::scene {

namespace {

// The shape of the oval, for a circumradius of 1. The slice with the parameter u (from −1 for the first slice to 1 for
// the last) is at (halfWidth · u, 0, −depth · u²). The camera looks at the focus slice from the distance `distance`,
// downward by the angle `pitch` (radians). The numbers were found by a search for the largest focus slice at which
// neighboring slices hide little of each other; they differ for wide and tall windows.
struct Oval {
    double halfWidth, depth, pitch, distance;
};
constexpr Oval kWide{20.5, 49.0, 0.46, 8.3};
constexpr Oval kTall{7.0, 72.0, 0.52, 9.6};
constexpr int kReferenceCount = 21;  // the number of slices for which the oval was designed

// Fractions of the viewport's height.
constexpr double kMargin = 0.02;     // around the picture
constexpr double kLabelGap = 0.014;  // between a slice and its label
constexpr double kLabelRoom = 0.04;  // for labels, around the slices

constexpr double kSingleDistance = 7;  // from the eye to the slice in the single view, in circumradii

double mix(double a, double b, double t) { return a + (b - a) * t; }

Oval ovalFor(double aspect) {
    const double t = std::clamp((1.6 - aspect) / 1.04, 0.0, 1.0);
    return {mix(kWide.halfWidth, kTall.halfWidth, t), mix(kWide.depth, kTall.depth, t),
            mix(kWide.pitch, kTall.pitch, t), mix(kWide.distance, kTall.distance, t)};
}

// A rectangle. In the viewport, the unit is the viewport's height.
struct Rect {
    double left, right, bottom, top;
};

// Returns the width available between the margins, at least half the viewport's width.
double availableWidth(double aspect) { return std::max(aspect - 4 * kMargin, aspect / 2); }

void layOutStrip(std::size_t vertices, double aspect, CoordinatesLayout& out) {
    constexpr double kMaxStep = 0.42, kAmplitude = 0.056, kNameRoom = 1.1;
    out = {.rows = 1, .perRow = static_cast<int>(vertices), .lineWidth = 0.0022, .amplitude = kAmplitude};
    out.density = true;
    out.lineStep = std::clamp((availableWidth(aspect) - out.lineWidth) / 3, 0.0, kMaxStep);
    out.left = (aspect - 3 * out.lineStep - out.lineWidth) / 2;
    out.zero = kMargin + kNameRoom * style().textHeight + kAmplitude;
}

void layOutCoordinates(std::size_t vertices, double aspect, CoordinatesLayout& out) {
    constexpr double kMinColumn = 0.0095;
    constexpr double kMaxColumn = 0.15;
    if (vertices > kMaxVerticesAsLines) {
        layOutStrip(vertices, aspect, out);
        return;
    }
    const double width = availableWidth(aspect);
    out.density = false;
    const auto count = static_cast<double>(std::max<std::size_t>(vertices, 1));
    out.rows = std::clamp(static_cast<int>(std::ceil(count * kMinColumn / width)), 1, 6);
    out.perRow = static_cast<int>(std::ceil(count / out.rows));
    out.columnStep = std::min(width / out.perRow, kMaxColumn);
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

// Returns the number of decimals with which neighboring labels differ.
int decimalsFor(double spacing) { return std::clamp(static_cast<int>(std::ceil(-std::log10(spacing))) + 1, 2, 9); }

// Returns the parameter u of slice i: −1 … 1 from the first to the last.
double parameterOf(std::size_t i, std::size_t count) {
    return count == 1 ? 0 : 2.0 * static_cast<double>(i) / static_cast<double>(count - 1) - 1;
}

// The view space of the camera before the viewer moves it: world space with its y and z axes rotated by the pitch about
// the x axis.
struct ViewSpace {
    double cos, sin, distance;
    explicit ViewSpace(const Oval& oval)
        : cos(std::cos(oval.pitch)), sin(std::sin(oval.pitch)), distance(oval.distance) {}
    double depth(const glm::dvec3& p) const { return distance - p.y * sin - p.z * cos; }
    double up(const glm::dvec3& p) const { return p.y * cos - p.z * sin; }
};

// Returns the bounds of the slices, projected onto the plane at distance 1 from the eye. Each slice is treated as a
// sphere whose projection is a circle, as if the sphere were on the optical axis.
Rect boundsOf(const std::vector<SlicePlacement>& placements, const ViewSpace& space, double radius) {
    constexpr double kInf = std::numeric_limits<double>::infinity();
    Rect bounds{kInf, -kInf, kInf, -kInf};
    for (std::size_t i = 0; i < placements.size(); ++i) {
        const double u = parameterOf(i, placements.size());
        const double r = radius * std::sqrt(1 - u * u) / space.depth(placements[i].position);
        const double x = placements[i].position.x / space.depth(placements[i].position);
        const double y = space.up(placements[i].position) / space.depth(placements[i].position);
        bounds = {std::min(bounds.left, x - r), std::max(bounds.right, x + r), std::min(bounds.bottom, y - r),
                  std::max(bounds.top, y + r)};
    }
    return bounds;
}

// Extends `bounds` by the projection of the whole object.
void include(const ProjectionPlacement& placement, const ViewSpace& space, Rect& bounds) {
    const double depth = space.depth(placement.position);
    const double x = placement.position.x / depth, y = space.up(placement.position) / depth;
    const double r = placement.radius / depth;
    bounds = {std::min(bounds.left, x - r), std::max(bounds.right, x + r), std::min(bounds.bottom, y - r),
              std::max(bounds.top, y + r)};
}

// Places the projection beside the focus slice, whose radius is `reach`, or above it in a tall window.
ProjectionPlacement besideFocusSlice(double aspect, double reach) {
    constexpr double kGap = 0.2;
    const double radius = 1.1 * reach, distance = reach + radius + kGap;
    return {true, aspect > 1 ? glm::dvec3(distance, 0, 0) : glm::dvec3(0, distance, 0), radius};
}

// Places the projection in the middle of the oval, above the parabola's axis: where the largest circle on the screen
// fits between the slices, and below `top`, a height on the plane at distance 1 from the eye.
ProjectionPlacement insideOval(const std::vector<SlicePlacement>& placements, const Oval& oval, double radius,
                               double top) {
    constexpr double kGap = 0.94;
    const ViewSpace space(oval);
    const auto radiusAt = [&](double depthOfOval) {
        const glm::dvec3 p{0, 0, -depthOfOval};
        const double y = space.up(p) / space.depth(p);
        double room = top - y;
        for (std::size_t i = 0; i < placements.size(); ++i) {
            const double u = parameterOf(i, placements.size());
            const glm::dvec3& q = placements[i].position;
            const double depth = space.depth(q);
            const double r = radius * std::sqrt(1 - u * u) / depth;
            room = std::min(room, std::hypot(q.x / depth, space.up(q) / depth - y) - r);
        }
        return room;
    };
    // The room grows with the distance from the focus slice and shrinks with that from the upper end of the oval. So it
    // has one maximum, which a golden-section search finds.
    constexpr double kGolden = std::numbers::phi - 1;
    constexpr int kSteps = 24;
    double from = 0, to = oval.depth;
    double left = to - kGolden * (to - from), right = from + kGolden * (to - from);
    double atLeft = radiusAt(left), atRight = radiusAt(right);
    for (int step = 0; step < kSteps; ++step) {
        if (atLeft > atRight) {
            to = right, right = left, atRight = atLeft;
            left = to - kGolden * (to - from), atLeft = radiusAt(left);
        } else {
            from = left, left = right, atLeft = atRight;
            right = from + kGolden * (to - from), atRight = radiusAt(right);
        }
    }
    const glm::dvec3 position{0, 0, -(from + to) / 2};
    return {true, position, kGap * std::max(radiusAt(-position.z), 0.0) * space.depth(position)};
}

// Returns the magnification at which `bounds` fills `room`.
double scaleFor(const Rect& bounds, const Rect& room) {
    return std::min((room.right - room.left) / (bounds.right - bounds.left),
                    (room.top - room.bottom) / (bounds.top - bounds.bottom));
}

// Sets the camera's field of view and shift so that `bounds`, magnified by `zoom`, fills `room`.
void fit(const Rect& bounds, const Rect& room, double aspect, double zoom, Camera& camera) {
    const double scale = scaleFor(bounds, room);
    camera.fieldOfView = 2 * std::atan(0.5 / (scale * zoom));
    const double x = (room.left + room.right) / 2 - scale * (bounds.left + bounds.right) / 2;
    const double y = (room.bottom + room.top) / 2 - scale * (bounds.bottom + bounds.top) / 2;
    camera.shiftX = x / aspect - 0.5;
    camera.shiftY = y - 0.5;
}

// Places the slices along the oval, and sets the text and size of their labels.
void placeSlices(const geometry::Hyperplanes& planes, int focus, const Oval& oval, const Look& look,
                 std::vector<SlicePlacement>& placements) {
    placements.resize(planes.count);
    const double half = std::max((planes.count - 1) / 2.0, 1.0);
    const ViewSpace space(oval);
    for (int i = 0; i < planes.count; ++i) {
        SlicePlacement& placement = placements[i];
        const double u = (planes.first + i - focus) / half;
        placement.index = planes.first + i;
        placement.w = planes.w(i);
        placement.focus = placement.index == focus;
        placement.drawn = look.view == View::oval || placement.focus;
        placement.position = {oval.halfWidth * u, 0, -oval.depth * u * u};
        placement.label = !look.parts.labels ? "" : labelOf(placement.w, decimalsFor(planes.spacing), placement.focus);
        const double away = space.depth(placement.position) / space.distance;
        placement.labelSize = placement.focus ? 1.15 : std::clamp(std::pow(away, -0.25), 0.62, 1.0);
    }
}

// Points the camera at the focus slice from the direction that `orbit` specifies, and sets its clipping planes.
void aim(const CameraOrbit& orbit, const Oval& oval, Camera& camera) {
    constexpr double kMaxPitch = 1.55;  // less than π/2, where the up vector would be undefined
    const double pitch = std::clamp(oval.pitch + orbit.elevation, -kMaxPitch, kMaxPitch);
    const glm::dvec3 away{std::sin(orbit.azimuth) * std::cos(pitch), std::sin(pitch),
                          std::cos(orbit.azimuth) * std::cos(pitch)};
    camera.target = glm::dvec3(0);
    camera.eye = away * oval.distance;
    camera.up = {0, 1, 0};
    camera.near = 0.05 * oval.distance;
    camera.far = oval.distance + 2 * (oval.depth + oval.halfWidth) + 10;
}

// Places each label on the outer side of the oval, where there is no neighboring slice: below the focus slice, and
// beside and somewhat below the slices on the arms of the oval.
void placeLabels(const Oval& oval, double radius, const Camera& camera, std::vector<SlicePlacement>& placements) {
    const ViewSpace space(oval);
    const glm::dmat4 view = camera.view();
    const glm::dvec3 right(view[0][0], view[1][0], view[2][0]);
    const glm::dvec3 up(view[0][1], view[1][1], view[2][1]);
    const double pixels = 0.5 / std::tan(camera.fieldOfView / 2);  // viewport heights per world unit at depth 1
    const auto onScreen = [&](double u) {
        const glm::dvec3 p{oval.halfWidth * u, 0, -oval.depth * u * u};
        return glm::dvec2(p.x, space.up(p)) / space.depth(p);
    };
    for (std::size_t i = 0; i < placements.size(); ++i) {
        SlicePlacement& placement = placements[i];
        const double u = parameterOf(i, placements.size());
        const glm::dvec2 along = onScreen(u + 1e-3) - onScreen(u - 1e-3);
        glm::dvec2 outward{0, -1};
        if (glm::length(along) > 0)
            outward = glm::normalize(glm::normalize(glm::dvec2(along.y, -along.x)) + glm::dvec2(0, -0.7));
        const double depth = -(view * glm::dvec4(placement.position, 1)).z;
        const double height = style().textHeight * placement.labelSize;
        const glm::dvec2 half{0.27 * height * static_cast<double>(placement.label.size()), 0.5 * height};
        const double reach = radius * std::sqrt(1 - u * u) * pixels / depth + kLabelGap + std::abs(outward.x) * half.x +
                             std::abs(outward.y) * half.y;
        const glm::dvec2 top = outward * reach + glm::dvec2(0, half.y);
        placement.labelAt = placement.position + (right * top.x + up * top.y) * (depth / pixels);
    }
}

}  // namespace

void layOut(const geometry::Hyperplanes& planes, int focus, std::size_t vertices, double ballRadius, const Look& look,
            Viewport viewport, Layout& out) {
    const double aspect = static_cast<double>(viewport.width) / viewport.height;
    layOutCoordinates(vertices, aspect, out.coordinates);
    out.axes = {0.06, 0.075, 0.045};
    Rect room{kMargin + kLabelRoom, aspect - kMargin - kLabelRoom, kMargin + kLabelRoom, 1 - kMargin};
    if (look.parts.coordinates) room.bottom += out.coordinates.zero + out.coordinates.amplitude;
    const bool single = look.view == View::single;
    const Oval oval = single ? Oval{0, 0, 0, kSingleDistance} : ovalFor(aspect);
    // With twice as many slices on the same parabola, each slice has about half the space.
    out.sliceRadius =
        single ? 1 : std::clamp(std::pow(static_cast<double>(kReferenceCount) / planes.count, 0.8), 0.1, 1.25);
    const double reach = out.sliceRadius * (1 + ballRadius);
    placeSlices(planes, focus, oval, look, out.placements);
    aim(look.orbit, oval, out.camera);
    Rect bounds = boundsOf(out.placements, ViewSpace(oval), reach);
    out.projectionPlacement = {};
    if (look.projection.kind != ProjectionKind::off) {
        if (single || planes.count == 1) {
            out.projectionPlacement = besideFocusSlice(aspect, reach);
            include(out.projectionPlacement, ViewSpace(oval), bounds);
        } else {
            const double scale = scaleFor(bounds, room);
            const double top = (bounds.bottom + bounds.top) / 2 + (room.top - room.bottom) / 2 / scale;
            out.projectionPlacement = insideOval(out.placements, oval, reach, top);
        }
    }
    fit(bounds, room, aspect, look.orbit.zoom, out.camera);
    placeLabels(oval, reach, out.camera, out.placements);
}

}  // namespace oval4d::scene
