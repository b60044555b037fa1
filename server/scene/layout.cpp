#include "scene/layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vector_relational.hpp>

#include "scene/coordinates_layout.hpp"
#include "scene/label_layout.hpp"
#include "scene/oval.hpp"
#include "scene/picture_boxes.hpp"
#include "scene/slice_label.hpp"

namespace oval4d::scene {

namespace {

// Returns the bounds of the slices, projected onto the plane at distance 1 from the eye. Each slice is treated as a
// sphere whose projection is a circle, as if the sphere were on the optical axis.
Rect boundsOf(const std::vector<SlicePlacement>& placements, const Oval& oval, double radius) {
    const InitialViewSpace space(oval);
    constexpr double kInf = std::numeric_limits<double>::infinity();
    Rect bounds{kInf, -kInf, kInf, -kInf};
    for (std::size_t i = 0; i < placements.size(); ++i) {
        const double u = parameterOf(i, placements.size());
        const double r = radius * oval.reachAt(u) / space.depth(placements[i].position);
        const double x = placements[i].position.x / space.depth(placements[i].position);
        const double y = space.up(placements[i].position) / space.depth(placements[i].position);
        bounds = {std::min(bounds.left, x - r), std::max(bounds.right, x + r), std::min(bounds.bottom, y - r),
                  std::max(bounds.top, y + r)};
    }
    return bounds;
}

// Extends `bounds`, a rectangle in the plane at distance 1 from the eye, so that it also contains the 4-D projection,
// which stands at `placement`.
void include(const ProjectionPlacement& placement, const InitialViewSpace& space, Rect& bounds) {
    const double depth = space.depth(placement.position);
    const double x = placement.position.x / depth, y = space.up(placement.position) / depth;
    const double r = placement.radius / depth;
    bounds = {std::min(bounds.left, x - r), std::max(bounds.right, x + r), std::min(bounds.bottom, y - r),
              std::max(bounds.top, y + r)};
}

// Places the projection to the right of the focus slice or, in a tall room, above it. `reach`: the radius of the slice
// with its balls.
ProjectionPlacement besideFocusSlice(double aspect, double reach) {
    constexpr double kGap = 0.2;
    const double radius = 1.1 * reach, distance = reach + radius + kGap;
    return {true, aspect > 1 ? glm::dvec3(distance, 0, 0) : glm::dvec3(0, distance, 0), radius};
}

// Places the projection above the row of the strip view. `halfWidth`: half the width of the row. `reach`: the radius of
// a slice with its balls. The projection fills most of the height that the row leaves in a room with this aspect ratio,
// but it is at least as large as a slice and at most as wide as the row.
ProjectionPlacement aboveRow(double halfWidth, double aspect, double reach) {
    constexpr double kGap = 0.3, kShare = 0.9;
    const double left = 2 * halfWidth / aspect - 2 * reach;  // the height that the row leaves, in world units
    const double radius = std::clamp(kShare * left / 2, reach, halfWidth);
    return {true, {0, reach + kGap + radius, 0}, radius};
}

// Places the projection in the middle of the oval, on the axis of this parabola: at the point where the largest circle
// on the screen fits between the slices and below `top`, a height on the plane at distance 1 from the eye. `radius`:
// the radius of the slices with their balls.
ProjectionPlacement insideOval(const std::vector<SlicePlacement>& placements, const Oval& oval, double radius,
                               double top) {
    constexpr double kGap = 0.94;
    const InitialViewSpace space(oval);
    const auto radiusAt = [&](double depthOfOval) {
        const glm::dvec3 p{0, 0, -depthOfOval};
        const double y = space.up(p) / space.depth(p);
        double room = top - y;
        for (std::size_t i = 0; i < placements.size(); ++i) {
            const double u = parameterOf(i, placements.size());
            const glm::dvec3& q = placements[i].position;
            const double depth = space.depth(q);
            const double r = radius * oval.reachAt(u) / depth;
            room = std::min(room, std::hypot(q.x / depth, space.up(q) / depth - y) - r);
        }
        return room;
    };
    // Along the axis, the room first grows with the distance from the focus slice, and then shrinks toward the upper
    // end of the oval. So it has one maximum, which a golden-section search finds.
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

// Returns the greatest magnification at which `bounds` fits into `room`.
double scaleFor(const Rect& bounds, const Rect& room) {
    return std::min((room.right - room.left) / (bounds.right - bounds.left),
                    (room.top - room.bottom) / (bounds.top - bounds.bottom));
}

// Sets the camera's field of view and shift so that `bounds` fits into `room` and is centered in it. `zoom` then
// magnifies the picture about the view axis.
void fit(const Rect& bounds, const Rect& room, double aspect, double zoom, Camera& camera) {
    const double scale = scaleFor(bounds, room);
    camera.fieldOfView = 2 * std::atan(0.5 / (scale * zoom));
    const double x = (room.left + room.right) / 2 - scale * (bounds.left + bounds.right) / 2;
    const double y = (room.bottom + room.top) / 2 - scale * (bounds.bottom + bounds.top) / 2;
    camera.shiftX = x / aspect - 0.5;
    camera.shiftY = y - 0.5;
}

// Places the slices along the oval, and sets the text and size of their labels.
void placeSlices(const geometry::Hyperplanes& planes, int focus, double originW, int decimals, const Oval& oval,
                 const Look& look, std::vector<SlicePlacement>& placements) {
    placements.resize(planes.count);
    const double half = std::max((planes.count - 1) / 2.0, 1.0);
    const InitialViewSpace space(oval);
    for (int i = 0; i < planes.count; ++i) {
        SlicePlacement& placement = placements[i];
        const double u = (planes.first + i - focus) / half;
        placement.index = planes.first + i;
        placement.w = planes.w(i);
        placement.focus = placement.index == focus;
        placement.drawn = showsAllSlices(look.view) || placement.focus;
        placement.position = {oval.halfWidth * u, 0, -oval.depth * u * u};
        placement.label.clear();
        if (look.parts.labels)
            placement.label = (placement.focus ? "w = " : "") + labelNumber(originW + placement.w, decimals);
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

// Returns a box that contains the axes symbol and the names of the axes, in whatever direction the axes point.
Box boxOf(const AxesLayout& axes) {
    constexpr double kNameRoom = 0.02;
    return {{axes.x, 1 - axes.y}, glm::dvec2(axes.length + kNameRoom)};
}

// Returns the part of `room` in which the slices must be placed so that their labels fit into `room`, too. This part
// has at least half the width and half the height of `room`.
Rect roomInside(const Rect& room, const Rect& bounds, const LabelLayout& labels) {
    const double maxX = (room.right - room.left) / 4, maxY = (room.top - room.bottom) / 4;
    Rect inside = room;
    // How far labels extend beyond the slices depends on the scale, which depends on the room that the labels leave. A
    // few steps of this iteration suffice.
    for (int step = 0; step < 4; ++step) {
        const Rect overhang = labels.overhang(bounds, scaleFor(bounds, inside));
        inside = {room.left + std::min(overhang.left, maxX), room.right - std::min(overhang.right, maxX),
                  room.bottom + std::min(overhang.bottom, maxY), room.top - std::min(overhang.top, maxY)};
    }
    return inside;
}

// A circle on the plane at distance 1 from the eye.
struct Circle {
    glm::dvec2 center;
    double radius;
};

Circle circleOf(const ProjectionPlacement& placement, const InitialViewSpace& space) {
    const double depth = space.depth(placement.position);
    return {glm::dvec2(placement.position.x, space.up(placement.position)) / depth, placement.radius / depth};
}

// Like roomInside(), but leaves the axes symbol free. `axes`: the box of the symbol. `circles`: the outlines of the
// slice and of the projection. If one of them would overlap the symbol, uses only the part of `room` to the right of
// the symbol or the part below it, whichever lets the slice be larger.
Rect clearOfAxes(const Rect& room, const Rect& bounds, const LabelLayout& labels, std::span<const Circle> circles,
                 const Box& axes) {
    const Rect inside = roomInside(room, bounds, labels);
    const double scale = scaleFor(bounds, inside);
    const glm::dvec2 middle((inside.left + inside.right) / 2, (inside.bottom + inside.top) / 2);
    const glm::dvec2 middleOfBounds((bounds.left + bounds.right) / 2, (bounds.bottom + bounds.top) / 2);
    const bool isClear = std::ranges::none_of(circles, [&](const Circle& circle) {
        return overlap(axes, middle + scale * (circle.center - middleOfBounds), scale * circle.radius);
    });
    if (isClear) return inside;
    Rect right = room, below = room;
    right.left = std::min(axes.center.x + axes.half.x, (room.left + room.right) / 2);
    below.top = std::max(axes.center.y - axes.half.y, (room.bottom + room.top) / 2);
    right = roomInside(right, bounds, labels);
    below = roomInside(below, bounds, labels);
    return scaleFor(bounds, right) > scaleFor(bounds, below) ? right : below;
}

// Places the matrix at the right of `room`, or at its lower end if the room is tall, and shrinks the room accordingly.
MatrixLayout placeMatrix(Rect& room, double ballRadius) {
    constexpr double kShare = 0.64, kGap = 0.03, kPanelGap = 0.06;
    const double width = room.right - room.left, height = room.top - room.bottom;
    const bool wide = width > height;
    const double side = wide ? std::min(height, kShare * width) : std::min(width, kShare * height);
    MatrixLayout matrix;
    matrix.shown = true;
    matrix.step = side / (4 - kPanelGap);
    matrix.panel = (1 - kPanelGap) * matrix.step;
    // Objects with many elements have small balls and sections with many points. So these points are small, too.
    matrix.pointRadius = std::min(ballRadius * matrix.panel, 0.0042);
    matrix.lineWidth = std::clamp(1.5 * matrix.pointRadius, 0.0022, 0.0042);
    if (wide) {
        room.right -= side + kGap;
        matrix.left = room.right + kGap;
        matrix.bottom = room.bottom + (height - side) / 2;
    } else {
        room.bottom += side + kGap;
        matrix.left = room.left + (width - side) / 2;
        matrix.bottom = room.bottom - kGap - side;
    }
    return matrix;
}

}  // namespace

std::optional<MatrixLayout::Panel> MatrixLayout::panelAt(glm::dvec2 position) const {
    if (!shown) return std::nullopt;
    const glm::dvec2 offset = (position - glm::dvec2(left, bottom)) / step, cell = glm::floor(offset);
    const glm::dvec2 inside = (offset - cell) * step;
    if (cell.x < 0 || cell.x > 3 || cell.y < 0 || cell.y > 3 || inside.x > panel || inside.y > panel)
        return std::nullopt;
    const Panel found{3 - static_cast<int>(cell.y), static_cast<int>(cell.x)};
    if (found.row == found.column) return std::nullopt;
    return found;
}

void layOut(const geometry::Hyperplanes& planes, int focus, const LayoutContent& content, double ballRadius,
            const Look& look, Viewport viewport, std::string_view focusName, Layout& out) {
    const double aspect = static_cast<double>(viewport.width) / viewport.height;
    layOutCoordinates(content, aspect, out.coordinates);
    out.axes = {0.06, 0.075, 0.045};
    Rect room{kMargin, aspect - kMargin, kMargin, 1 - kMargin};
    if (look.parts.coordinates) room.bottom += out.coordinates.zero + out.coordinates.amplitude;
    out.matrix = look.view == View::matrix ? placeMatrix(room, ballRadius) : MatrixLayout{};
    const bool single = !showsAllSlices(look.view), strip = look.view == View::strip;
    // With twice as many slices on the same parabola, each slice has about half the space.
    out.sliceRadius =
        single || strip ? 1 : std::clamp(std::pow(static_cast<double>(kReferenceCount) / planes.count, 0.8), 0.1, 1.25);
    const double reach = out.sliceRadius * (1 + ballRadius);
    const Oval oval = single ? singleSlice() : strip ? rowFor(planes.count, reach) : ovalFor(aspect);
    const int decimals = labelDecimals(planes);
    placeSlices(planes, focus, content.originW, decimals, oval, look, out.placements);
    aim(look.orbit, oval, out.camera);
    Rect bounds = boundsOf(out.placements, oval, reach);
    const bool projected = look.projection.kind != ProjectionKind::off;
    const bool alone = single || planes.count == 1;
    out.projectionPlacement = {};
    if (projected && alone) {
        out.projectionPlacement = besideFocusSlice((room.right - room.left) / (room.top - room.bottom), reach);
        include(out.projectionPlacement, InitialViewSpace(oval), bounds);
    } else if (projected && strip) {
        out.projectionPlacement =
            aboveRow(oval.halfWidth + reach, (room.right - room.left) / (room.top - room.bottom), reach);
        include(out.projectionPlacement, InitialViewSpace(oval), bounds);
    }
    LabelLayout labels(oval, reach, decimals, content.originW, out.placements);
    if (strip) labels.shrink((room.right - room.left) / planes.count);
    Rect inside{};
    if (alone) {
        const Circle slice{glm::dvec2(0), reach / oval.distance};
        const std::array circles{slice, projected ? circleOf(out.projectionPlacement, InitialViewSpace(oval)) : slice};
        inside = clearOfAxes(room, bounds, labels, circles, boxOf(out.axes));
    } else {
        inside = roomInside(room, bounds, labels);
    }
    if (projected && !alone && !strip) {
        const double scale = scaleFor(bounds, inside);
        const double top = (bounds.bottom + bounds.top) / 2 + (room.top - (inside.bottom + inside.top) / 2) / scale;
        out.projectionPlacement = insideOval(out.placements, oval, reach, top);
    }
    fit(bounds, inside, aspect, look.orbit.zoom, out.camera);
    labels.place(out.camera);
    if (look.parts.labels) {
        labels.nameFocusSlice(focusName, out.camera, aspect);
        labels.thin(out.camera, aspect, room.bottom - kMargin, boxOf(out.axes), look.orbit != CameraOrbit{});
    }
}

}  // namespace oval4d::scene
