#include "scene/arrangement.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include <glm/common.hpp>

#include "scene/style.hpp"

namespace oval4d::scene {

namespace {

// The number of slices for which the shape of the oval was designed.
constexpr int kReferenceCount = 21;
// The shapes of the ovals in wide and in tall pictures. A search found their numbers: those for which the focus slice
// (the middle one) is largest while neighboring slices hide little of each other.
constexpr SliceArrangement kWideOval{.halfWidth = 20.5, .depth = 49.0, .pitch = 0.46, .distance = 8.3};
constexpr SliceArrangement kTallOval{.halfWidth = 7.0, .depth = 72.0, .pitch = 0.52, .distance = 9.6};

// The distance between neighboring slices in a row or column, as a multiple of the radius of a slice with its balls.
constexpr double kLineStep = 2.12;
// The distance of the eye from a row or column is kSingleDistance plus this multiple of the distance from its middle to
// its last slice. From so far away, the projection is nearly parallel.
constexpr double kLineDistance = 4;
// How far the label of the focus slice (the middle one) is below the other labels of a row, in heights of text.
constexpr double kRowFocusDrop = 1.4;
// How far the label of the focus slice (the middle one) is to the right of the other labels of a column, in heights of
// text. The distance is needed because the plate behind this label is wider.
constexpr double kColumnFocusDrop = 0.8;
// In a grid, the gap between a slice and the slice below it, in heights of text. The gap contains the label of the
// upper slice.
constexpr double kGridLabelRoom = 2.3;
// In a grid, by how much the gap below the row of the focus slice (the middle one) exceeds the other gaps, in heights
// of text.
constexpr double kGridFocusRoom = 2.1;
// In a grid, the greatest width of labels, except that of the focus slice (the middle one), as a fraction of the column
// step.
constexpr double kGridLabelWidth = 0.94;
// The distance of the eye from a grid is kSingleDistance plus this multiple of the greater of two distances from the
// focus slice: to the farthest column and to the farthest row. From so far away, the slices in the corners look nearly
// like those in the middle.
constexpr double kGridDistance = 8;
constexpr double kSingleDistance = 7;  // the distance from the eye to a slice that is shown alone, in circumradii

double mix(double a, double b, double t) { return a + (b - a) * t; }

SliceArrangement ovalArrangement(int count, double aspect) {
    const double t = std::clamp((1.6 - aspect) / 1.04, 0.0, 1.0);
    SliceArrangement made;
    made.halfWidth = mix(kWideOval.halfWidth, kTallOval.halfWidth, t);
    made.depth = mix(kWideOval.depth, kTallOval.depth, t);
    made.pitch = mix(kWideOval.pitch, kTallOval.pitch, t);
    made.distance = mix(kWideOval.distance, kTallOval.distance, t);
    // The parabola has the same length for any number of slices. So with twice as many slices, the radius is little
    // more than half as large.
    made.sliceRadius = std::clamp(std::pow(static_cast<double>(kReferenceCount) / count, 0.8), 0.1, 1.25);
    made.isClearOfAxes = count == 1;
    return made;
}

// Returns a straight row of `count` slices. `reach` is the radius of a slice with its balls.
SliceArrangement rowArrangement(int count, double reach) {
    SliceArrangement made;
    made.halfWidth = kLineStep * reach * (count - 1) / 2;
    made.distance = kLineDistance * made.halfWidth + kSingleDistance;
    made.isClearOfAxes = count == 1;
    made.focusLabelDrop = count == 1 ? 0 : kRowFocusDrop;
    made.labelColumns = count;
    return made;
}

// Returns the arrangement of the focus slice alone.
SliceArrangement focusSliceArrangement() {
    SliceArrangement made;
    made.distance = kSingleDistance;
    made.isClearOfAxes = true;
    return made;
}

// Returns a straight column of `count` slices, with the last slice at the top: a row that is turned by a quarter.
// `reach` is the radius of a slice with its balls.
SliceArrangement columnArrangement(int count, double reach) {
    if (count == 1) return focusSliceArrangement();
    SliceArrangement made = rowArrangement(count, reach);
    std::swap(made.halfWidth, made.halfHeight);
    // If false, the uppermost slices would often cover the symbol of the axes in tall pictures.
    made.isClearOfAxes = true;
    made.labelDrop = 0;
    made.focusLabelDrop = kColumnFocusDrop;
    made.labelsAreBeside = true;
    made.labelColumns = 2;  // the room is divided into one column for the slices and one for their labels
    return made;
}

// Returns a grid with the number of columns at which the slices are largest. `reach` is the radius of a slice with its
// balls.
SliceArrangement gridArrangement(int count, double reach, const AvailableSpace& room) {
    // The projection of the whole object fills a square. The grid and the square are in `part`, a part of the room
    // beside the axes symbol. If the square is to the left of the grid, its side is kProjectionShare times the width of
    // `part`, but at most kProjectionBreadth times its height. If the square is above the grid, width and height are
    // exchanged.
    constexpr double kProjectionShare = 0.3, kProjectionBreadth = 0.9;
    // If the width of the room divided by its height is at least this, the projection is to the left of the grid,
    // otherwise above it.
    constexpr double kLeastWideAspect = 1.3;
    if (count == 1) return focusSliceArrangement();
    const double text = style().textHeight;
    SliceGrid grid;
    grid.count = count;
    grid.projectionIsAbove = room.size.x < kLeastWideAspect * room.size.y;
    double scale = 0;  // the length of a world unit in the picture, in viewport heights; the largest one found so far
    for (const glm::dvec2& part : room.besideAxes) {
        glm::dvec2 left = part;  // the size of `part` without the square of the projection
        double side = 0;
        if (room.hasProjection) {
            double& length = grid.projectionIsAbove ? left.y : left.x;
            side = std::min(kProjectionShare * length, kProjectionBreadth * (grid.projectionIsAbove ? left.x : left.y));
            length -= side;
        }
        for (int columns = 1; columns <= count; ++columns) {
            const int rows = (count + columns - 1) / columns;
            const double labels = (kGridLabelRoom * rows + kGridFocusRoom) * text;
            const double radius = std::min(left.x / (kLineStep * (columns - 1) + 2), (left.y - labels) / (2 * rows));
            if (radius / reach <= scale) continue;
            scale = radius / reach;
            grid.columns = columns;
            grid.projectionSide = side / scale;
        }
    }
    grid.columnStep = kLineStep * reach;
    grid.rowStep = 2 * reach + kGridLabelRoom * text / scale;
    grid.focusGap = kGridFocusRoom * text / scale;
    SliceArrangement made;
    made.grid = grid;
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 offset = glm::abs(grid.positionOf(i));
        made.halfWidth = std::max(made.halfWidth, offset.x);
        made.halfHeight = std::max(made.halfHeight, offset.y);
    }
    made.distance = kGridDistance * std::max(made.halfWidth, made.halfHeight) + kSingleDistance;
    made.isClearOfAxes = true;
    made.focusLabelDrop = kRowFocusDrop;
    made.labelColumns = room.size.x / (kGridLabelWidth * grid.columnStep * scale);
    return made;
}

// Places the projection of the whole object to the right of the focus slice (the middle one) or, in a tall room, above
// it.
ProjectionPlacement projectionBesideFocusSlice(double reach, double aspect) {
    constexpr double kGap = 0.2;
    const double radius = 1.1 * reach, distance = reach + radius + kGap;
    return {true, aspect > 1 ? glm::dvec3(distance, 0, 0) : glm::dvec3(0, distance, 0), radius};
}

// Places the projection of the whole object beside a row or column, in the direction of the unit vector `away`. The
// projection fills most of the breadth that the slices leave in the room. It is at least as large as a slice, and at
// most as long as the row or column. `halfLength` is half the length of the row or column, including its end slices.
// `aspect` is the length of the room in the direction of the row or column, divided by the breadth of the room.
ProjectionPlacement projectionBesideLine(const glm::dvec3& away, double halfLength, double reach, double aspect) {
    constexpr double kGap = 0.3, kShare = 0.9;
    const double left = 2 * halfLength / aspect - 2 * reach;  // the breadth that the slices leave, in world units
    const double radius = std::clamp(kShare * left / 2, reach, halfLength);
    return {true, (reach + kGap + radius) * away, radius};
}

// Places the projection of the whole object above a grid if grid.projectionIsAbove is true, otherwise to its left.
ProjectionPlacement projectionBesideGrid(const SliceGrid& grid, double reach) {
    // The diameter of the projection, as a fraction of the side of the square that contains it.
    constexpr double kShare = 0.94;
    const double half = grid.projectionSide / 2;
    const glm::dvec3 first = grid.positionOf(0), last = grid.positionOf(grid.count - 1);
    const glm::dvec3 center = grid.projectionIsAbove ? glm::dvec3(first.x + (grid.columns - 1) * grid.columnStep / 2,
                                                                  first.y + reach + half, 0)
                                                     : glm::dvec3(first.x - reach - half, (first.y + last.y) / 2, 0);
    return {true, center, kShare * half};
}

}  // namespace

// The following switches over the views have no default case, so that a view without a case does not compile.

SliceArrangement arrangementOf(View view, int count, double relativeBall, double aspect, const AvailableSpace& room) {
    SliceArrangement made;
    switch (view) {
        case View::oval:
            // The ends of an oval are far away from the viewer. If there are only two slices, as in some exported
            // files, both would be tiny at these ends. So they stand in a row.
            made = count == 2 ? rowArrangement(count, 1 + relativeBall) : ovalArrangement(count, aspect);
            break;
        case View::single:
            made = focusSliceArrangement();
            break;
        case View::matrix:
            made = focusSliceArrangement();
            made.showsMatrix = true;
            break;
        case View::strip:
            made = rowArrangement(count, 1 + relativeBall);
            break;
        case View::column:
            made = columnArrangement(count, 1 + relativeBall);
            break;
        case View::grid:
            made = gridArrangement(count, 1 + relativeBall, room);
            break;
    }
    made.reach = made.sliceRadius * (1 + relativeBall);
    return made;
}

ProjectionPlacement placeProjectionBeside(View view, const SliceArrangement& arrangement, int count, double aspect) {
    const double reach = arrangement.reach;
    if (count == 1) return projectionBesideFocusSlice(reach, aspect);
    switch (view) {
        case View::single:
        case View::matrix:
            return projectionBesideFocusSlice(reach, aspect);
        case View::oval:
            if (count > 2) break;
            [[fallthrough]];  // two slices of an oval stand in a row: see arrangementOf()
        case View::strip:
            return projectionBesideLine({0, 1, 0}, arrangement.halfWidth + reach, reach, aspect);
        case View::column:
            return projectionBesideLine({-1, 0, 0}, arrangement.halfHeight + reach, reach, 1 / aspect);
        case View::grid:
            return projectionBesideGrid(arrangement.grid, reach);
    }
    return {};
}

ProjectionPlacement placeProjectionInsideOval(const SliceArrangement& arrangement,
                                              const std::vector<SlicePlacement>& placements, double top) {
    constexpr double kGap = 0.94;
    const InitialViewSpace space(arrangement);
    const auto radiusAt = [&](double depthOfOval) {
        const glm::dvec3 p{0, 0, -depthOfOval};
        const double y = space.heightAboveAxis(p) / space.depth(p);
        double room = top - y;
        for (std::size_t i = 0; i < placements.size(); ++i) {
            const double u = sliceParameter(i, placements.size());
            const glm::dvec3& q = placements[i].position;
            const double depth = space.depth(q);
            const double r = arrangement.reach * arrangement.relativeSliceRadiusAt(u) / depth;
            room = std::min(room, std::hypot(q.x / depth, space.heightAboveAxis(q) / depth - y) - r);
        }
        return room;
    };
    // Along the axis of the parabola, the room for the projection first grows with the distance from the focus slice
    // (the middle one). Then it shrinks toward the upper end of the oval. So it has one maximum, which a golden-section
    // search finds.
    constexpr double kGolden = std::numbers::phi - 1;
    constexpr int kSteps = 24;
    double from = 0, to = arrangement.depth;
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

}  // namespace oval4d::scene
