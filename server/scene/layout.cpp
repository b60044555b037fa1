#include "scene/layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vector_relational.hpp>

#include "scene/arrangement.hpp"
#include "scene/coordinates_layout.hpp"
#include "scene/label_layout.hpp"
#include "scene/picture_boxes.hpp"
#include "scene/slice_label.hpp"

namespace oval4d::scene {

namespace {

constexpr double kBarPerBall = 0.4;  // the radius of bars, as a fraction of the radius of balls

// A circle on the plane at distance 1 from the eye.
struct Circle {
    glm::dvec2 center;
    double radius;
};

// Returns a circle, on the plane at distance 1 from the eye, that approximates the outline of a sphere. The
// approximation is good for spheres that are small and near the optical axis.
Circle projectedOutlineOf(const glm::dvec3& position, double radius, const InitialViewSpace& space) {
    const double depth = space.depth(position);
    return {glm::dvec2(position.x, space.heightAboveAxis(position)) / depth, radius / depth};
}

// Returns circles, on the plane at distance 1 from the eye, within which the slices are assumed to lie.
std::vector<Circle> sliceOutlineCircles(const std::vector<SlicePlacement>& placements,
                                        const SliceArrangement& arrangement) {
    const InitialViewSpace space(arrangement);
    std::vector<Circle> circles;
    for (std::size_t i = 0; i < placements.size(); ++i) {
        const double radius =
            arrangement.reach * arrangement.relativeSliceRadiusAt(sliceParameter(i, placements.size()));
        circles.push_back(projectedOutlineOf(placements[i].position, radius, space));
    }
    return circles;
}

Rect boundsOf(const std::vector<Circle>& circles) {
    constexpr double kInf = std::numeric_limits<double>::infinity();
    Rect bounds{kInf, -kInf, kInf, -kInf};
    for (const auto& [center, radius] : circles) {
        bounds = {std::min(bounds.left, center.x - radius), std::max(bounds.right, center.x + radius),
                  std::min(bounds.bottom, center.y - radius), std::max(bounds.top, center.y + radius)};
    }
    return bounds;
}

// Sets the radii of the object, its balls and its bars in `placement`, so that the projection of the object with its
// balls fits into a sphere with the radius `placement.radius`. `relativeBall` is the radius of the balls of slices, as
// a fraction of the slice radius.
void setProjectionRadii(const ProjectionSettings& projection, double relativeBall, ProjectionPlacement& placement) {
    // The projection has many more bars in less room than a slice. So its balls and bars are thinner than those of
    // slices, by this factor.
    constexpr double kThinner = 0.55;
    // In perspective, points on the object's circumscribed sphere appear farther from the center of the projection by
    // at most this factor.
    const double eye = projection.eye;
    const double magnification = projection.kind == ProjectionKind::perspective ? eye / std::sqrt(eye * eye - 1) : 1;
    const double thinBall = kThinner * relativeBall;
    placement.objectRadius = placement.radius / (magnification + thinBall);
    placement.ballRadius = thinBall * placement.objectRadius;
    placement.barRadius = kBarPerBall * placement.ballRadius;
}

// Returns the width and the height of a rectangle.
glm::dvec2 sizeOf(const Rect& rect) { return {rect.right - rect.left, rect.top - rect.bottom}; }

// Returns the width of a rectangle, divided by its height.
double aspectOf(const Rect& rect) { return (rect.right - rect.left) / (rect.top - rect.bottom); }

// Returns the greatest magnification at which the rectangle `bounds` fits into the rectangle `room`.
double scaleToFit(const Rect& bounds, const Rect& room) {
    return std::min((room.right - room.left) / (bounds.right - bounds.left),
                    (room.top - room.bottom) / (bounds.top - bounds.bottom));
}

// Sets the camera's field of view and shift so that `bounds` fits into `room` and is centered in it. `bounds` is on the
// plane at distance 1 from the eye, and `room` is in viewport heights. Then magnifies the picture about the view axis
// by the factor `zoom`.
void fitCamera(const Rect& bounds, const Rect& room, double aspect, double zoom, Camera& camera) {
    const double scale = scaleToFit(bounds, room);
    camera.fieldOfView = 2 * std::atan(0.5 / (scale * zoom));
    const double x = (room.left + room.right) / 2 - scale * (bounds.left + bounds.right) / 2;
    const double y = (room.bottom + room.top) / 2 - scale * (bounds.bottom + bounds.top) / 2;
    camera.shiftX = x / aspect - 0.5;
    camera.shiftY = y - 0.5;
}

// Places the slices, and sets the text and size of their labels.
void placeSlices(const geometry::Hyperplanes& planes, int focus, double originW, int decimals,
                 const SliceArrangement& arrangement, const Look& look, std::vector<SlicePlacement>& placements) {
    placements.resize(planes.count);
    const InitialViewSpace space(arrangement);
    for (int i = 0; i < planes.count; ++i) {
        SlicePlacement& placement = placements[i];
        placement.index = planes.first + i;
        placement.w = planes.w(i);
        placement.focus = placement.index == focus;
        placement.drawn = showsAllSlices(look.view) || placement.focus;
        placement.position = arrangement.positionAt(sliceParameter(i, planes.count));
        placement.label.clear();
        if (look.parts.labels)
            placement.label = (placement.focus ? "w = " : "") + labelNumber(originW + placement.w, decimals);
        const double away = space.depth(placement.position) / space.distance;
        placement.labelSize = placement.focus ? 1.15 : std::clamp(std::pow(away, -0.25), 0.62, 1.0);
    }
}

// Points the camera at the focus slice (the middle one) from the direction that `orbit` specifies, and sets the
// camera's clipping planes.
void aimCamera(const CameraOrbit& orbit, const SliceArrangement& arrangement, Camera& camera) {
    constexpr double kMaxPitch = 1.55;  // a pitch less than π/2; at π/2, the up vector would be undefined
    const double pitch = std::clamp(arrangement.pitch + orbit.elevation, -kMaxPitch, kMaxPitch);
    const glm::dvec3 away{std::sin(orbit.azimuth) * std::cos(pitch), std::sin(pitch),
                          std::cos(orbit.azimuth) * std::cos(pitch)};
    camera.target = glm::dvec3(0);
    camera.eye = away * arrangement.distance;
    camera.up = {0, 1, 0};
    camera.near = 0.05 * arrangement.distance;
    camera.far = arrangement.distance + 2 * arrangement.maxDistanceFromFocus() + 10;
}

// Returns a box that contains the symbol of the axes with their names, whatever the directions of the axes are.
CenteredRect axesSymbolBox(const AxesSymbolLayout& axes) {
    constexpr double kNameRoom = 0.02;
    return {{axes.x, 1 - axes.y}, glm::dvec2(axes.length + kNameRoom)};
}

// Returns the part of `room` in which the slices must be placed so that their labels fit into `room`, too. This part
// has at least half the width and half the height of `room`. `bounds` are the bounds of the slices on the plane at
// distance 1 from the eye.
Rect roomForSlices(const Rect& room, const Rect& bounds, const LabelLayout& labels) {
    const double maxX = (room.right - room.left) / 4, maxY = (room.top - room.bottom) / 4;
    Rect inside = room;
    // How far labels extend beyond the slices depends on the scale of the slices. The scale depends on the room that
    // the labels leave. A few steps of this iteration suffice.
    for (int step = 0; step < 4; ++step) {
        const Rect overhang = labels.overhang(bounds, scaleToFit(bounds, inside));
        // If labels are only to the right of the slices, they may take half of the width of `room`.
        const double left = std::min(overhang.left, maxX);
        inside = {room.left + left, room.right - std::min(overhang.right, 2 * maxX - left),
                  room.bottom + std::min(overhang.bottom, maxY), room.top - std::min(overhang.top, maxY)};
    }
    return inside;
}

// Returns two parts of `room`: the part to the right of the axes symbol, and the part below it. The first part has at
// least half the width of `room`, the second at least half its height. `axes` is the box of the symbol.
std::array<Rect, 2> roomBesideAndBelow(const CenteredRect& axes, const Rect& room) {
    Rect right = room, below = room;
    right.left = std::min(axes.center.x + axes.half.x, (room.left + room.right) / 2);
    below.top = std::max(axes.center.y - axes.half.y, (room.bottom + room.top) / 2);
    return {right, below};
}

// Returns the part of `room` in which the slices must be placed, like roomForSlices(), but leaves the axes symbol free.
// `axes` is the box of the symbol. `circles` are the outlines of the slices and of the projection. If a circle would
// overlap the symbol, uses only a part of `room`: to the right of the symbol or below it, whichever lets the slices be
// larger. Uses the part to the right only if labels beside the slices take at most half of its width.
Rect roomClearOfAxes(const Rect& room, const Rect& bounds, const LabelLayout& labels,
                     const std::vector<Circle>& circles, const CenteredRect& axes) {
    const Rect inside = roomForSlices(room, bounds, labels);
    const double scale = scaleToFit(bounds, inside);
    const glm::dvec2 middle((inside.left + inside.right) / 2, (inside.bottom + inside.top) / 2);
    const glm::dvec2 middleOfBounds((bounds.left + bounds.right) / 2, (bounds.bottom + bounds.top) / 2);
    const bool isClear = std::ranges::none_of(circles, [&](const Circle& circle) {
        return overlap(axes, middle + scale * (circle.center - middleOfBounds), scale * circle.radius);
    });
    if (isClear) return inside;
    auto [right, below] = roomBesideAndBelow(axes, room);
    const bool labelsFit = 2 * labels.overhang(bounds, scale).right <= right.right - right.left;
    right = roomForSlices(right, bounds, labels);
    below = roomForSlices(below, bounds, labels);
    return labelsFit && scaleToFit(bounds, right) > scaleToFit(bounds, below) ? right : below;
}

// Places the matrix of planar sections at the right side of `room` or, if `room` is not wider than high, at its lower
// side. Reduces `room` by the place of the matrix. `relativeBall` is LayoutObjectInfo::relativeBallRadius. The matrix
// has no balls and bars, so it ignores Look::thickness.
SectionMatrixLayout placeMatrix(Rect& room, double relativeBall) {
    constexpr double kShare = 0.64, kGap = 0.03, kPanelGap = 0.06;
    const double width = room.right - room.left, height = room.top - room.bottom;
    const bool wide = width > height;
    const double side = wide ? std::min(height, kShare * width) : std::min(width, kShare * height);
    SectionMatrixLayout matrix;
    matrix.shown = true;
    matrix.step = side / (4 - kPanelGap);
    matrix.panel = (1 - kPanelGap) * matrix.step;
    // The sections of an object with many elements have many points. So these points are smaller, as the balls of such
    // an object are.
    matrix.pointRadius = std::min(relativeBall * matrix.panel, 0.0042);
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

std::optional<SectionMatrixLayout::Panel> SectionMatrixLayout::panelAt(glm::dvec2 position) const {
    if (!shown) return std::nullopt;
    const glm::dvec2 offset = (position - glm::dvec2(left, bottom)) / step, cell = glm::floor(offset);
    const glm::dvec2 inside = (offset - cell) * step;
    if (cell.x < 0 || cell.x > 3 || cell.y < 0 || cell.y > 3 || inside.x > panel || inside.y > panel)
        return std::nullopt;
    const Panel found{3 - static_cast<int>(cell.y), static_cast<int>(cell.x)};
    if (found.row == found.column) return std::nullopt;
    return found;
}

void layOutPicture(const geometry::Hyperplanes& planes, int focus, const LayoutObjectInfo& content, const Look& look,
                   Viewport viewport, std::string_view focusName, PictureLayout& out) {
    const double aspect = static_cast<double>(viewport.width) / viewport.height;
    layOutCoordinates(content, aspect, out.coordinates);
    out.axes = {0.06, 0.075, 0.045};
    // The margin at each side; at least half of the width of a narrow picture remains.
    const double side = std::min(kMargin, aspect / 4);
    Rect room{side, aspect - side, kMargin, 1 - kMargin};
    if (look.parts.coordinates) room.bottom += out.coordinates.zero + out.coordinates.amplitude;
    // The radius of the balls of slices, as a fraction of the slice radius. All radii of balls and bars in slices and
    // in the projection are proportional to it.
    const double relativeBall = look.thickness * content.relativeBallRadius;
    const bool projected = look.projection.kind != ProjectionKind::off;
    const auto [right, below] = roomBesideAndBelow(axesSymbolBox(out.axes), room);
    const AvailableSpace sliceRoom{sizeOf(room), {sizeOf(right), sizeOf(below)}, projected};
    const SliceArrangement arrangement = arrangementOf(look.view, planes.count, relativeBall, aspect, sliceRoom);
    out.matrix = arrangement.showsMatrix ? placeMatrix(room, content.relativeBallRadius) : SectionMatrixLayout{};
    out.sliceRadius = arrangement.sliceRadius;
    out.ballRadius = relativeBall * out.sliceRadius;
    out.barRadius = kBarPerBall * out.ballRadius;
    const int decimals = labelDecimals(planes);
    placeSlices(planes, focus, content.originW, decimals, arrangement, look, out.placements);
    aimCamera(look.orbit, arrangement, out.camera);
    LabelLayout labels(arrangement, decimals, content.originW, out.placements);
    if (arrangement.labelColumns > 0) labels.shrinkLabels((room.right - room.left) / arrangement.labelColumns);
    std::vector<Circle> circles = sliceOutlineCircles(out.placements, arrangement);
    ProjectionPlacement& projection = out.projectionPlacement;
    projection = {};
    if (projected) {
        const Rect beside = arrangement.labelsAreBeside ? roomForSlices(room, boundsOf(circles), labels) : room;
        projection = placeProjectionBeside(look.view, arrangement, planes.count, aspectOf(beside));
    }
    if (projection.shown)
        circles.push_back(projectedOutlineOf(projection.position, projection.radius, InitialViewSpace(arrangement)));
    const Rect bounds = boundsOf(circles);
    const Rect inside = arrangement.isClearOfAxes
                            ? roomClearOfAxes(room, bounds, labels, circles, axesSymbolBox(out.axes))
                            : roomForSlices(room, bounds, labels);
    if (projected && !projection.shown) {
        const double scale = scaleToFit(bounds, inside);
        const double top = (bounds.bottom + bounds.top) / 2 + (room.top - (inside.bottom + inside.top) / 2) / scale;
        projection = placeProjectionInsideOval(arrangement, out.placements, top);
    }
    if (projected) setProjectionRadii(look.projection, relativeBall, projection);
    fitCamera(bounds, inside, aspect, look.orbit.zoom, out.camera);
    labels.placeLabels(out.camera);
    if (look.parts.labels) {
        labels.appendNameToFocusLabel(focusName, out.camera, aspect);
        labels.removeOverlappingLabels(out.camera, aspect, room.bottom - kMargin, axesSymbolBox(out.axes),
                                       look.orbit != CameraOrbit{});
    }
}

}  // namespace oval4d::scene
