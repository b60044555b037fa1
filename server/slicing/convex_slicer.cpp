#include "slicing/convex_slicer.hpp"

#include <algorithm>
#include <functional>

namespace oval4d::slicing {

namespace {

// Returns whether slicing `polytope` by `planes` hyperplanes is faster on two cores than on one. A sweep sorts the
// elements of the polytope once and writes them for each hyperplane. So its time is proportional to the number of
// elements times the sum of the number of hyperplanes and kSorting. If this product is at most kLarge, waking the other
// core takes longer than the time that it saves.
bool isWorthTwoCores(const polytopes::Polytope& polytope, int planes) {
    constexpr std::size_t kSorting = 40;  // sorting takes as long as writing the slices of this many hyperplanes
    constexpr std::size_t kLarge = 2'500'000;
    const std::size_t elements =
        polytope.vertices.size() + polytope.edges.size() + polytope.faces.size() + polytope.cells.size();
    return elements * (kSorting + planes) > kLarge;
}

}  // namespace

bool ConvexSlicer::cut(const polytopes::Polytope& polytope, PlanesBelowVertices planesBelow,
                       std::span<SliceSet* const> touching, SliceSet& out) {
    if (!planesBelow.anyOnPlane && isWorthTwoCores(polytope, out.planes.count))
        return cutInTwoSweeps(polytope, planesBelow, out);
    HyperplaneSweep& sweep = lower_.sweep;
    if (!sweep.begin(polytope, planesBelow, out.planes.count)) return false;
    SliceElementCounts size = sweep.maxSliceCounts();
    for (const SliceSet* slice : touching) {
        if (slice != nullptr) size = size + slice->totalCounts();
    }
    out.resize(size);
    SliceElementCounts end;
    if (!sweep.cut(polytope, touching, 0, end, out)) return false;
    out.finishSlices(end);
    return true;
}

// Cuts the slices in the lower and in the upper half of the hyperplanes at the same time, on two cores. Requires that
// no vertex lies in a hyperplane. Then HyperplaneSweep::maxSliceCounts() is exact, so that the position in `out` where
// the upper half begins is known before cutting.
bool ConvexSlicer::cutInTwoSweeps(const polytopes::Polytope& polytope, PlanesBelowVertices planesBelow, SliceSet& out) {
    const auto [least, most] = std::minmax_element(planesBelow.below.begin(), planesBelow.below.end());
    const std::int32_t middle = (*least + *most) / 2;
    const auto begin = [&](HalfSweep& half, std::int32_t first, std::int32_t end) {
        half.below.resize(planesBelow.below.size());
        std::transform(planesBelow.below.begin(), planesBelow.below.end(), half.below.begin(),
                       [&](std::int32_t below) { return std::clamp(below, first, end) - first; });
        half.sound = half.sweep.begin(polytope, {half.below, half.below, false}, end - first);
    };
    const auto cut = [&](HalfSweep& half, std::int32_t first) {
        half.sound = half.sweep.cut(polytope, {}, first, half.end, out);
    };
    const auto invoke = [&](const auto& lower, const auto& upper) {
        parallel::invoke(forkJoin_, std::ref(lower), std::ref(upper));
        return lower_.sound && upper_.sound;
    };
    if (!invoke([&] { begin(lower_, 0, middle); }, [&] { begin(upper_, middle, out.planes.count); })) return false;
    lower_.end = {};
    upper_.end = lower_.sweep.maxSliceCounts();
    out.resize(lower_.sweep.maxSliceCounts() + upper_.sweep.maxSliceCounts());
    if (!invoke([&] { cut(lower_, 0); }, [&] { cut(upper_, middle); })) return false;
    out.finishSlices(upper_.end);
    return true;
}

}  // namespace oval4d::slicing
