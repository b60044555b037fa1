#include "scene/layout.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vector_relational.hpp>

#include "scene/slice_label.hpp"
#include "scene/style.hpp"

namespace oval4d::scene {

namespace {

// The shape of the oval, for a circumradius of 1. The slice with the parameter u (from −1 for the first slice to 1 for
// the last) is at (halfWidth · u, 0, −depth · u²). The camera looks at the focus slice from the distance `distance`,
// downward by the angle `pitch` (radians). The numbers were found by a search for the largest focus slice at which
// neighboring slices hide little of each other; they differ for wide and tall windows. If the depth is 0, the slices
// are in a straight row.
struct Oval {
    double halfWidth, depth, pitch, distance;

    // Returns the radius of the circle within which a slice is assumed to lie, relative to the circumradius. On the
    // curve, there is just room for slices that span the object.
    double reachAt(double u) const { return depth == 0 ? 1 : std::sqrt(1 - u * u); }
    bool isRow() const { return depth == 0 && halfWidth > 0; }
};
constexpr Oval kWide{20.5, 49.0, 0.46, 8.3};
constexpr Oval kTall{7.0, 72.0, 0.52, 9.6};
constexpr int kReferenceCount = 21;  // the number of slices for which the oval was designed

// Fractions of the viewport's height.
constexpr double kMargin = 0.02;     // around the picture
constexpr double kLabelGap = 0.014;  // between a slice and its label

// Labels are placed in the direction away from the curve of the oval, and somewhat below it, by this part of a unit
// vector. With more, they would cover the next slice; with less, those at the sides would leave less room for the
// slices.
constexpr double kLabelDrop = 0.54;

// The size of labels, as fractions of their font size. The characters' widths are those of DejaVu Sans, rounded up; the
// margins are those of the plates behind the labels.
constexpr double kDigitWidth = 0.64, kSignWidth = 0.84, kPointWidth = 0.32, kFocusPrefixWidth = 2.31;
constexpr double kLetterWidth = 0.62;  // the mean width of the letters of a section's name, rounded up
constexpr double kDigitHeight = 0.73;
constexpr double kPlateMarginX = 0.19, kPlateMarginY = 0.1, kFocusPlateMarginX = 0.66, kFocusPlateMarginY = 0.44;

constexpr double kStripStep = 2.12;   // between neighboring slices in the strip view, in radii of slices with balls
constexpr double kStripDistance = 4;  // from the eye to the strip, in half widths: nearly a parallel projection
constexpr double kLeastStripLabel = 0.45;  // the least size of labels in the strip view
constexpr double kStripFocusDrop = 1.4;    // from the row of labels down to that of the focus slice, in heights of text
constexpr double kSingleDistance = 7;      // from the eye to the slice in the single view, in circumradii

double mix(double a, double b, double t) { return a + (b - a) * t; }

Oval ovalFor(double aspect) {
    const double t = std::clamp((1.6 - aspect) / 1.04, 0.0, 1.0);
    return {mix(kWide.halfWidth, kTall.halfWidth, t), mix(kWide.depth, kTall.depth, t),
            mix(kWide.pitch, kTall.pitch, t), mix(kWide.distance, kTall.distance, t)};
}

// Returns the straight row of the strip view; `reach` is the radius of a slice with its balls.
Oval rowFor(int count, double reach) {
    const double halfWidth = kStripStep * reach * (count - 1) / 2;
    return {halfWidth, 0, 0, kStripDistance * halfWidth + kSingleDistance};
}

// A rectangle. In the viewport, the unit is the viewport's height.
struct Rect {
    double left, right, bottom, top;
};

// Returns the width available between the margins, at least half the viewport's width.
double availableWidth(double aspect) { return std::max(aspect - 4 * kMargin, aspect / 2); }

constexpr double kMaxAxisStep = 0.42;                            // between neighboring axes of a strip or histogram
constexpr double kStripAmplitude = 0.056, kStripNameRoom = 1.1;  // the room in heights of text

void layOutStrip(std::size_t vertices, double aspect, CoordinatesLayout& out) {
    out = {.rows = 1, .perRow = static_cast<int>(vertices), .lineWidth = 0.0022, .amplitude = kStripAmplitude};
    out.density = true;
    out.lineStep = std::clamp((availableWidth(aspect) - out.lineWidth) / 3, 0.0, kMaxAxisStep);
    out.left = (aspect - 3 * out.lineStep - out.lineWidth) / 2;
    out.zero = kMargin + kStripNameRoom * style().textHeight + kStripAmplitude;
}

void layOutHistogram(double aspect, CoordinatesLayout& out) {
    constexpr double kGap = 0.08;  // between two panels, as a fraction of the distance from one to the next
    out = {.lineWidth = 0.0022, .amplitude = kStripAmplitude};
    out.lineStep = std::clamp(availableWidth(aspect) / (4 - kGap), 0.0, kMaxAxisStep);
    out.panel = (1 - kGap) * out.lineStep;
    out.left = (aspect - 3 * out.lineStep - out.panel) / 2;
    out.zero = kMargin + kStripNameRoom * style().textHeight + kStripAmplitude;
}

void layOutCoordinates(const LayoutContent& content, double aspect, CoordinatesLayout& out) {
    if (content.isField) {
        layOutHistogram(aspect, out);
        return;
    }
    const std::size_t vertices = content.vertices;
    constexpr double kMinColumn = 0.0095;
    constexpr double kMaxColumn = 0.15;
    if (vertices > kMaxVerticesAsLines) {
        layOutStrip(vertices, aspect, out);
        return;
    }
    const double width = availableWidth(aspect);
    out.density = false;
    out.panel = 0;
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
Rect boundsOf(const std::vector<SlicePlacement>& placements, const Oval& oval, double radius) {
    const ViewSpace space(oval);
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

// Places the projection above the row of the strip view, whose half width is `halfWidth`, so that both fill a room with
// this aspect ratio if the row leaves enough of it.
ProjectionPlacement aboveRow(double halfWidth, double aspect, double reach) {
    constexpr double kGap = 0.3, kShare = 0.9;
    const double left = 2 * halfWidth / aspect - 2 * reach;  // the height that the row leaves
    const double radius = std::clamp(kShare * left / 2, reach, halfWidth);
    return {true, {0, reach + kGap + radius, 0}, radius};
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
void placeSlices(const geometry::Hyperplanes& planes, int focus, double originW, int decimals, const Oval& oval,
                 const Look& look, std::vector<SlicePlacement>& placements) {
    placements.resize(planes.count);
    const double half = std::max((planes.count - 1) / 2.0, 1.0);
    const ViewSpace space(oval);
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

// A box on the screen. The unit is the viewport's height.
struct Box {
    glm::dvec2 center, half;
};

bool overlap(const Box& a, const Box& b) {
    return glm::all(glm::lessThan(glm::abs(a.center - b.center), a.half + b.half));
}

// Returns the box of the symbol of the axes, which may point in any direction, with their names.
Box boxOf(const AxesLayout& axes) {
    constexpr double kNameRoom = 0.02;
    return {{axes.x, 1 - axes.y}, glm::dvec2(axes.length + kNameRoom)};
}

bool overlap(const Box& box, const glm::dvec2& center, double radius) {
    return glm::length(glm::max(glm::abs(center - box.center) - box.half, glm::dvec2(0))) < radius;
}

// Decides where the labels are and which of them are shown.
class Labels {
  public:
    // `radius` is that of the slices with their balls.
    Labels(const Oval& oval, double radius, int decimals, double originW, std::vector<SlicePlacement>& placements)
        : oval_(oval), space_(oval), radius_(radius), placements_(placements) {
        // All labels have room for the longest one, with a sign. So the layout stays the same when the focus moves.
        double w = 0;
        for (const SlicePlacement& placement : placements) w = std::max(w, std::abs(originW + placement.w));
        const double digits = std::max(std::floor(std::log10(w + 0.5 * std::pow(10, -decimals))), 0.0) + 1 + decimals;
        width_ = kSignWidth + digits * kDigitWidth + kPointWidth;
    }

    // Reduces the size of all labels but that of the focus slice so that they fit side by side in columns of this
    // width.
    void shrink(double columnWidth) {
        const double size = columnWidth / ((width_ + 2 * kPlateMarginX) * style().textHeight);
        for (SlicePlacement& placement : placements_)
            if (!placement.focus) placement.labelSize = std::clamp(size, kLeastStripLabel, 1.0);
    }

    // Returns how far the labels extend beyond `bounds`, the bounds of the slices, on each side, if one unit on the
    // plane at distance 1 from the eye appears as `scale` viewport heights.
    Rect overhang(const Rect& bounds, double scale) const {
        Rect out{0, 0, 0, 0};
        for (std::size_t i = 0; i < placements_.size(); ++i) {
            if (!placements_[i].drawn) continue;
            const Box box = boxAt(i, scale);
            out.left = std::max(out.left, bounds.left * scale - (box.center.x - box.half.x));
            out.right = std::max(out.right, box.center.x + box.half.x - bounds.right * scale);
            out.bottom = std::max(out.bottom, bounds.bottom * scale - (box.center.y - box.half.y));
            out.top = std::max(out.top, box.center.y + box.half.y - bounds.top * scale);
        }
        return out;
    }

    // Places each label on the outer side of the oval, where there is no neighboring slice: below the focus slice, and
    // beside and somewhat below the slices on the arms of the oval.
    void place(const Camera& camera) {
        const glm::dmat4 view = camera.view();
        const glm::dvec3 right(view[0][0], view[1][0], view[2][0]);
        const glm::dvec3 up(view[0][1], view[1][1], view[2][1]);
        const double pixels = camera.magnification();
        for (std::size_t i = 0; i < placements_.size(); ++i) {
            SlicePlacement& placement = placements_[i];
            const double depth = -(view * glm::dvec4(placement.position, 1)).z;
            const glm::dvec2 top = offsetOf(i, pixels / depth) + glm::dvec2(0, kDigitHeight / 2 * fontSize(placement));
            placement.labelAt = placement.position + (right * top.x + up * top.y) * (depth / pixels);
        }
    }

    // Appends the name of the section to the focus slice's label, if there is room for it in the picture.
    void nameFocusSlice(std::string_view name, const Camera& camera, double aspect) {
        const auto focus = std::ranges::find_if(placements_, &SlicePlacement::focus);
        if (name.empty() || focus == placements_.end()) return;
        nameWidth_ = kLetterWidth * static_cast<double>(name.size() + 2);
        const Box box = boxSeenBy(camera, camera.view(), aspect, *focus);
        if (box.center.x < box.half.x || box.center.x > aspect - box.half.x) {
            nameWidth_ = 0;
        } else {
            focus->label.append(", ").append(name);
        }
    }

    // Removes labels so that none overlaps another: keeps the focus slice's label and, of the others, every k-th. If
    // the viewer has moved the camera, also removes those that overlap labels nearer to the focus slice's, another
    // slice, or the box of the axes, or extend below `bottom`, where the coordinates are.
    void thin(const Camera& camera, double aspect, double bottom, const Box& axes, bool isMoved) {
        const auto count = static_cast<std::ptrdiff_t>(placements_.size());
        const auto focus = std::ranges::find_if(placements_, &SlicePlacement::focus) - placements_.begin();
        const std::ptrdiff_t step = smallestStep(focus, camera.magnification());
        const glm::dmat4 toView = camera.view();
        const auto boxOf = [&](std::ptrdiff_t i) { return boxSeenBy(camera, toView, aspect, placements_[i]); };
        const auto keeps = [&](std::ptrdiff_t i, std::ptrdiff_t distance) {
            const SlicePlacement& placement = placements_[i];
            if (placement.focus || !placement.drawn) return true;
            if (distance % step != 0 || (toView * glm::dvec4(placement.labelAt, 1)).z > -camera.near) return false;
            const Box box = boxOf(i);
            if (box.center.x < box.half.x || box.center.x > aspect - box.half.x) return false;
            if (box.center.y < box.half.y || box.center.y > 1 - box.half.y) return false;
            if (isMoved && (box.center.y < bottom + box.half.y || overlap(box, axes) ||
                            isOverSlice(i, box, camera, toView, aspect)))
                return false;
            // The labels between the focus slice and this one, and as many on the other side, have been decided on.
            for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(focus - distance, 0);
                 j <= std::min(focus + distance, count - 1); ++j) {
                const bool decided = std::abs(j - focus) < distance || j < i;
                if (decided && placements_[j].drawn && !placements_[j].label.empty() && overlap(boxOf(j), box))
                    return false;
            }
            return true;
        };
        for (std::ptrdiff_t distance = 1; distance < count; ++distance) {
            for (const std::ptrdiff_t i : {focus - distance, focus + distance})
                if (i >= 0 && i < count && !keeps(i, distance)) placements_[i].label.clear();
        }
    }

  private:
    static double fontSize(const SlicePlacement& placement) { return style().textHeight * placement.labelSize; }

    glm::dvec2 halfText(const SlicePlacement& placement) const {
        return fontSize(placement) * glm::dvec2(width_ + (placement.focus ? kFocusPrefixWidth : 0), kDigitHeight) / 2.0;
    }

    // Half the size of the plate behind a label.
    glm::dvec2 halfPlate(const SlicePlacement& placement) const {
        const glm::dvec2 margin = placement.focus ? glm::dvec2(kFocusPlateMarginX, kFocusPlateMarginY)
                                                  : glm::dvec2(kPlateMarginX, kPlateMarginY);
        return halfText(placement) + fontSize(placement) * margin;
    }

    // The center of the slice with the parameter u, on the plane at distance 1 from the eye.
    glm::dvec2 onPlane(double u) const {
        const glm::dvec3 p{oval_.halfWidth * u, 0, -oval_.depth * u * u};
        return glm::dvec2(p.x, space_.up(p)) / space_.depth(p);
    }

    // Returns how far the slice with the parameter u, a sphere, extends on the screen from its center in the direction
    // of a unit vector; at its depth, a world unit appears as `scale` viewport heights. Away from the optical axis,
    // perspective stretches the sphere: the planes through the eye that touch it, n · p = e d for points p on the
    // screen and depths d, fulfill (n · c − e d)² = r² (1 + e²) for its center c.
    double extentOf(double u, const glm::dvec2& direction, double scale) const {
        const double r = radius_ * oval_.reachAt(u);
        const glm::dvec3 p{oval_.halfWidth * u, 0, -oval_.depth * u * u};
        const double d = space_.depth(p), a = glm::dot(direction, glm::dvec2(p.x, space_.up(p)));
        const double e = (a * d + r * std::sqrt(std::max(a * a + d * d - r * r, 0.0))) / (d * d - r * r);
        return (e * d - a) * scale;
    }

    // Returns the vector on the screen from slice i to the center of its label; at the slice's depth, a world unit
    // appears as `scale` viewport heights.
    glm::dvec2 offsetOf(std::size_t i, double scale) const {
        const double u = parameterOf(i, placements_.size());
        const glm::dvec2 along = onPlane(u + 1e-3) - onPlane(u - 1e-3);
        glm::dvec2 outward{0, -1};
        if (glm::length(along) > 0)
            outward = glm::normalize(glm::normalize(glm::dvec2(along.y, -along.x)) + glm::dvec2(0, -kLabelDrop));
        const double radius = extentOf(u, outward, scale);
        const double drop = oval_.isRow() && placements_[i].focus ? kStripFocusDrop * style().textHeight : 0;
        return outward * (radius + kLabelGap + drop + glm::dot(glm::abs(outward), halfText(placements_[i])));
    }

    // Returns the box of label i before the viewer moves the camera, measured from the center of the focus slice, if
    // one unit on the plane at distance 1 from the eye appears as `scale` viewport heights.
    Box boxAt(std::size_t i, double scale) const {
        const double u = parameterOf(i, placements_.size());
        return {scale * onPlane(u) + offsetOf(i, scale / space_.depth(placements_[i].position)),
                halfPlate(placements_[i])};
    }

    // Returns the place on the screen of a point in view coordinates.
    static glm::dvec2 onScreen(const glm::dvec3& p, const Camera& camera, double aspect) {
        return glm::dvec2(p) * (camera.magnification() / -p.z) +
               glm::dvec2((0.5 + camera.shiftX) * aspect, 0.5 + camera.shiftY);
    }

    // Returns whether the box of label i overlaps another slice than its own.
    bool isOverSlice(std::ptrdiff_t i, const Box& box, const Camera& camera, const glm::dmat4& toView,
                     double aspect) const {
        for (std::size_t j = 0; j < placements_.size(); ++j) {
            const glm::dvec3 p(toView * glm::dvec4(placements_[j].position, 1));
            if (static_cast<std::ptrdiff_t>(j) == i || !placements_[j].drawn || p.z > -camera.near) continue;
            const double u = parameterOf(j, placements_.size());
            const double radius = radius_ * oval_.reachAt(u) * camera.magnification() / -p.z;
            if (overlap(box, onScreen(p, camera, aspect), radius)) return true;
        }
        return false;
    }

    Box boxSeenBy(const Camera& camera, const glm::dmat4& toView, double aspect,
                  const SlicePlacement& placement) const {
        const glm::dvec3 p(toView * glm::dvec4(placement.labelAt, 1));
        const glm::dvec2 top = onScreen(p, camera, aspect);
        const double name = placement.focus ? fontSize(placement) * nameWidth_ / 2 : 0;
        return {top - glm::dvec2(0, kDigitHeight / 2 * fontSize(placement)),
                halfPlate(placement) + glm::dvec2(name, 0)};
    }

    // Returns the smallest k such that every k-th label, counted from the focus slice, overlaps no other before the
    // viewer moves the camera.
    std::ptrdiff_t smallestStep(std::ptrdiff_t focus, double scale) const {
        const auto count = static_cast<std::ptrdiff_t>(placements_.size());
        const auto fits = [&](std::ptrdiff_t step) {
            for (std::ptrdiff_t i = focus % step; i < count; i += step) {
                if (!placements_[i].drawn) continue;
                const Box box = boxAt(i, scale);
                for (std::ptrdiff_t j = i + step; j < count; j += step)
                    if (placements_[j].drawn && overlap(box, boxAt(j, scale))) return false;
            }
            return true;
        };
        std::ptrdiff_t step = 1;
        while (step < count && !fits(step)) ++step;
        return step;
    }

    const Oval& oval_;
    ViewSpace space_;
    double radius_, width_ = 0;
    double nameWidth_ = 0;  // of the section's name in the focus slice's label, as a multiple of the font size
    std::vector<SlicePlacement>& placements_;
};

// Returns the part of `room` that is left for the slices if their labels also have room, but at least half of its width
// and height.
Rect roomInside(const Rect& room, const Rect& bounds, const Labels& labels) {
    const double maxX = (room.right - room.left) / 4, maxY = (room.top - room.bottom) / 4;
    Rect inside = room;
    // The smaller the slices are, the farther their labels extend beyond them. A few steps suffice.
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

Circle circleOf(const ProjectionPlacement& placement, const ViewSpace& space) {
    const double depth = space.depth(placement.position);
    return {glm::dvec2(placement.position.x, space.up(placement.position)) / depth, placement.radius / depth};
}

// Returns the part of `room` for the slices as roomInside() does; if one of the circles would cover the axes, leaves
// out the columns or the rows of the axes, whichever leaves more room.
Rect clearOfAxes(const Rect& room, const Rect& bounds, const Labels& labels, const std::vector<Circle>& circles,
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
    // Sections of objects with many elements have many points, so these shrink with the balls.
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
    const Oval oval = single ? Oval{0, 0, 0, kSingleDistance} : strip ? rowFor(planes.count, reach) : ovalFor(aspect);
    const int decimals = labelDecimals(planes);
    placeSlices(planes, focus, content.originW, decimals, oval, look, out.placements);
    aim(look.orbit, oval, out.camera);
    Rect bounds = boundsOf(out.placements, oval, reach);
    const bool projected = look.projection.kind != ProjectionKind::off;
    const bool alone = single || planes.count == 1;
    out.projectionPlacement = {};
    if (projected && alone) {
        out.projectionPlacement = besideFocusSlice((room.right - room.left) / (room.top - room.bottom), reach);
        include(out.projectionPlacement, ViewSpace(oval), bounds);
    } else if (projected && strip) {
        out.projectionPlacement =
            aboveRow(oval.halfWidth + reach, (room.right - room.left) / (room.top - room.bottom), reach);
        include(out.projectionPlacement, ViewSpace(oval), bounds);
    }
    Labels labels(oval, reach, decimals, content.originW, out.placements);
    if (strip) labels.shrink((room.right - room.left) / planes.count);
    Rect inside = roomInside(room, bounds, labels);
    if (alone) {
        std::vector<Circle> circles{{glm::dvec2(0), reach / oval.distance}};
        if (projected) circles.push_back(circleOf(out.projectionPlacement, ViewSpace(oval)));
        inside = clearOfAxes(room, bounds, labels, circles, boxOf(out.axes));
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
