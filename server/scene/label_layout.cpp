#include "scene/label_layout.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/slice_label.hpp"
#include "scene/style.hpp"

namespace oval4d::scene {

namespace {

constexpr double kLabelGap = 0.014;  // the gap between a slice and its label, in viewport heights

// The sizes of characters and of the plates behind labels, as multiples of the font size. The widths of characters are
// those of DejaVu Sans, rounded up. kFocusPrefixWidth is the width of "w = ".
constexpr double kDigitWidth = 0.64, kSignWidth = 0.84, kPointWidth = 0.32, kFocusPrefixWidth = 2.31;
// The mean width of the letters of a section's name, rounded up, as a multiple of the font size.
constexpr double kLetterWidth = 0.62;
constexpr double kDigitHeight = 0.73;
constexpr double kPlateMarginX = 0.19, kPlateMarginY = 0.1, kFocusPlateMarginX = 0.66, kFocusPlateMarginY = 0.44;

constexpr double kLeastLabelSize = 0.45;  // the least SlicePlacement::labelSize to which labels shrink

}  // namespace

LabelLayout::LabelLayout(const SliceArrangement& arrangement, int decimals, double originW,
                         std::vector<SlicePlacement>& placements)
    : arrangement_(arrangement), space_(arrangement), placements_(placements) {
    // All labels have room for the longest number with a sign. So the layout stays the same when the focus moves.
    double w = 0;
    for (const SlicePlacement& placement : placements) w = std::max(w, std::abs(originW + placement.w));
    const double digits = std::max(std::floor(std::log10(w + 0.5 * std::pow(10, -decimals))), 0.0) + 1 + decimals;
    width_ = kSignWidth + digits * kDigitWidth + kPointWidth;
    // With an exponent, the number is shorter than with all its decimals. No character in it is wider than a digit.
    if (decimals > kMaxPlainDecimals)
        width_ = kSignWidth + static_cast<double>(labelNumber(w, decimals).size()) * kDigitWidth;
}

void LabelLayout::shrinkLabels(double columnWidth) {
    for (SlicePlacement& placement : placements_) {
        if (placement.focus && !arrangement_.labelsAreBeside) continue;
        const double width = columnWidth - (arrangement_.labelsAreBeside ? labelGapOf(placement) : 0);
        const double size = placement.labelSize * width / (2 * halfPlateSize(placement).x);
        placement.labelSize = std::clamp(size, kLeastLabelSize, placement.labelSize);
    }
}

Rect LabelLayout::overhang(const Rect& bounds, double scale) const {
    Rect out{0, 0, 0, 0};
    for (std::size_t i = 0; i < placements_.size(); ++i) {
        if (!placements_[i].drawn) continue;
        const CenteredRect box = labelBoxInInitialView(i, scale);
        out.left = std::max(out.left, bounds.left * scale - (box.center.x - box.half.x));
        out.right = std::max(out.right, box.center.x + box.half.x - bounds.right * scale);
        out.bottom = std::max(out.bottom, bounds.bottom * scale - (box.center.y - box.half.y));
        out.top = std::max(out.top, box.center.y + box.half.y - bounds.top * scale);
    }
    return out;
}

void LabelLayout::placeLabels(const Camera& camera) {
    const glm::dmat4 view = camera.view();
    const glm::dvec3 right(view[0][0], view[1][0], view[2][0]);
    const glm::dvec3 up(view[0][1], view[1][1], view[2][1]);
    const double pixels = camera.focalLength();
    for (std::size_t i = 0; i < placements_.size(); ++i) {
        SlicePlacement& placement = placements_[i];
        const double depth = -(view * glm::dvec4(placement.position, 1)).z;
        const glm::dvec2 top = labelOffset(i, pixels / depth) + glm::dvec2(0, kDigitHeight / 2 * fontSize(placement));
        placement.labelAt = placement.position + (right * top.x + up * top.y) * (depth / pixels);
    }
}

void LabelLayout::appendNameToFocusLabel(std::string_view name, const Camera& camera, double aspect) {
    const auto focus = std::ranges::find_if(placements_, &SlicePlacement::focus);
    if (name.empty() || focus == placements_.end()) return;
    nameWidth_ = kLetterWidth * static_cast<double>(name.size() + 2);
    const glm::dmat4 view = camera.view();
    const glm::dvec3 withoutName = focus->labelAt;
    if (arrangement_.labelsAreBeside) {
        const glm::dvec3 right(view[0][0], view[1][0], view[2][0]);
        const double depth = -(view * glm::dvec4(focus->position, 1)).z;
        focus->labelAt += right * (fontSize(*focus) * nameWidth_ / 2 * depth / camera.focalLength());
    }
    const CenteredRect box = labelBoxSeenBy(camera, view, aspect, *focus);
    if (box.center.x < box.half.x || box.center.x > aspect - box.half.x) {
        nameWidth_ = 0;
        focus->labelAt = withoutName;
    } else {
        focus->label.append(", ").append(name);
    }
}

void LabelLayout::removeOverlappingLabels(const Camera& camera, double aspect, double bottom, const CenteredRect& axes,
                                          bool isMoved) {
    const auto count = static_cast<std::ptrdiff_t>(placements_.size());
    const auto focus = std::ranges::find_if(placements_, &SlicePlacement::focus) - placements_.begin();
    const std::ptrdiff_t step = smallestLabelStep(focus, camera.focalLength());
    const glm::dmat4 toView = camera.view();
    const auto boxOf = [&](std::ptrdiff_t i) { return labelBoxSeenBy(camera, toView, aspect, placements_[i]); };
    const auto keeps = [&](std::ptrdiff_t i, std::ptrdiff_t distance) {
        const SlicePlacement& placement = placements_[i];
        if (placement.focus || !placement.drawn) return true;
        if (distance % step != 0 || (toView * glm::dvec4(placement.labelAt, 1)).z > -camera.near) return false;
        const CenteredRect box = boxOf(i);
        if (box.center.x < box.half.x || box.center.x > aspect - box.half.x) return false;
        if (box.center.y < box.half.y || box.center.y > 1 - box.half.y) return false;
        if (isMoved && (box.center.y < bottom + box.half.y || overlap(box, axes) ||
                        overlapsOtherSlice(i, box, camera, toView, aspect)))
            return false;
        // The labels of slices nearer to the focus slice (the middle one) have been decided before this label. If the
        // other slice at the same distance from the focus slice has the smaller index, its label has been decided, too.
        // This label must not overlap a decided label that is kept.
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

double LabelLayout::fontSize(const SlicePlacement& placement) { return style().textHeight * placement.labelSize; }

double LabelLayout::labelGapOf(const SlicePlacement& placement) const {
    return kLabelGap + (placement.focus ? arrangement_.focusLabelDrop * style().textHeight : 0);
}

glm::dvec2 LabelLayout::halfTextSize(const SlicePlacement& placement) const {
    return fontSize(placement) * glm::dvec2(width_ + (placement.focus ? kFocusPrefixWidth : 0), kDigitHeight) / 2.0;
}

glm::dvec2 LabelLayout::halfPlateSize(const SlicePlacement& placement) const {
    const glm::dvec2 margin =
        placement.focus ? glm::dvec2(kFocusPlateMarginX, kFocusPlateMarginY) : glm::dvec2(kPlateMarginX, kPlateMarginY);
    return halfTextSize(placement) + fontSize(placement) * margin;
}

glm::dvec2 LabelLayout::sliceCenterOnPlane(double u) const {
    const glm::dvec3 p = arrangement_.positionAt(u);
    return glm::dvec2(p.x, space_.heightAboveAxis(p)) / space_.depth(p);
}

double LabelLayout::screenExtentOfSlice(double u, const glm::dvec2& direction, double scale) const {
    const double r = arrangement_.reach * arrangement_.relativeSliceRadiusAt(u);
    const glm::dvec3 p = arrangement_.positionAt(u);
    const double d = space_.depth(p), a = glm::dot(direction, glm::dvec2(p.x, space_.heightAboveAxis(p)));
    const double e = (a * d + r * std::sqrt(std::max(a * a + d * d - r * r, 0.0))) / (d * d - r * r);
    return (e * d - a) * scale;
}

glm::dvec2 LabelLayout::labelOffset(std::size_t i, double scale) const {
    const double u = sliceParameter(i, placements_.size());
    const glm::dvec2 along = sliceCenterOnPlane(u + 1e-3) - sliceCenterOnPlane(u - 1e-3);
    glm::dvec2 outward{0, -1};
    if (glm::length(along) > 0)
        outward =
            glm::normalize(glm::normalize(glm::dvec2(along.y, -along.x)) + glm::dvec2(0, -arrangement_.labelDrop));
    const double radius = screenExtentOfSlice(u, outward, scale);
    const SlicePlacement& placement = placements_[i];
    return outward * (radius + labelGapOf(placement) + glm::dot(glm::abs(outward), halfTextSize(placement)));
}

CenteredRect LabelLayout::labelBoxInInitialView(std::size_t i, double scale) const {
    const double u = sliceParameter(i, placements_.size());
    return {scale * sliceCenterOnPlane(u) + labelOffset(i, scale / space_.depth(placements_[i].position)),
            halfPlateSize(placements_[i])};
}

glm::dvec2 LabelLayout::screenPosition(const glm::dvec3& p, const Camera& camera, double aspect) {
    return glm::dvec2(p) * (camera.focalLength() / -p.z) +
           glm::dvec2((0.5 + camera.shiftX) * aspect, 0.5 + camera.shiftY);
}

bool LabelLayout::overlapsOtherSlice(std::ptrdiff_t i, const CenteredRect& box, const Camera& camera,
                                     const glm::dmat4& toView, double aspect) const {
    for (std::size_t j = 0; j < placements_.size(); ++j) {
        const glm::dvec3 p(toView * glm::dvec4(placements_[j].position, 1));
        if (static_cast<std::ptrdiff_t>(j) == i || !placements_[j].drawn || p.z > -camera.near) continue;
        const double u = sliceParameter(j, placements_.size());
        const double radius = arrangement_.reach * arrangement_.relativeSliceRadiusAt(u) * camera.focalLength() / -p.z;
        if (overlap(box, screenPosition(p, camera, aspect), radius)) return true;
    }
    return false;
}

CenteredRect LabelLayout::labelBoxSeenBy(const Camera& camera, const glm::dmat4& toView, double aspect,
                                         const SlicePlacement& placement) const {
    const glm::dvec3 p(toView * glm::dvec4(placement.labelAt, 1));
    const glm::dvec2 top = screenPosition(p, camera, aspect);
    const double name = placement.focus ? fontSize(placement) * nameWidth_ / 2 : 0;
    return {top - glm::dvec2(0, kDigitHeight / 2 * fontSize(placement)),
            halfPlateSize(placement) + glm::dvec2(name, 0)};
}

std::ptrdiff_t LabelLayout::smallestLabelStep(std::ptrdiff_t focus, double scale) const {
    const auto count = static_cast<std::ptrdiff_t>(placements_.size());
    const auto fits = [&](std::ptrdiff_t step) {
        for (std::ptrdiff_t i = focus % step; i < count; i += step) {
            if (!placements_[i].drawn) continue;
            const CenteredRect box = labelBoxInInitialView(i, scale);
            for (std::ptrdiff_t j = i + step; j < count; j += step)
                if (placements_[j].drawn && overlap(box, labelBoxInInitialView(j, scale))) return false;
        }
        return true;
    };
    std::ptrdiff_t step = 1;
    while (step < count && !fits(step)) ++step;
    return step;
}

}  // namespace oval4d::scene
