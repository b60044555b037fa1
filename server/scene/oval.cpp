#include "scene/oval.hpp"

#include <algorithm>

namespace oval4d::scene {

namespace {

constexpr Oval kWide{20.5, 49.0, 0.46, 8.3};
constexpr Oval kTall{7.0, 72.0, 0.52, 9.6};

constexpr double kStripStep = 2.12;    // between neighboring slices in the strip view, in radii of slices with balls
constexpr double kStripDistance = 4;   // from the eye to the strip, in half widths: nearly a parallel projection
constexpr double kSingleDistance = 7;  // from the eye to the slice in the single view, in circumradii

double mix(double a, double b, double t) { return a + (b - a) * t; }

}  // namespace

Oval ovalFor(double aspect) {
    const double t = std::clamp((1.6 - aspect) / 1.04, 0.0, 1.0);
    return {mix(kWide.halfWidth, kTall.halfWidth, t), mix(kWide.depth, kTall.depth, t),
            mix(kWide.pitch, kTall.pitch, t), mix(kWide.distance, kTall.distance, t)};
}

Oval rowFor(int count, double reach) {
    const double halfWidth = kStripStep * reach * (count - 1) / 2;
    return {halfWidth, 0, 0, kStripDistance * halfWidth + kSingleDistance};
}

Oval singleSlice() { return {0, 0, 0, kSingleDistance}; }

}  // namespace oval4d::scene
