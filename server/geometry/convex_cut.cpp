#include "geometry/convex_cut.hpp"

#include <algorithm>
#include <functional>

#include "geometry/companion.hpp"

namespace oval4d::geometry {

namespace {

// What a sweep takes grows as the elements that it sorts, and those that it writes for each hyperplane. To wake another
// core takes as long as to sweep through half of a large polytope; only what is larger is worth it.
bool isWorthTwoCores(const Polytope& polytope, int planes) {
    constexpr std::size_t kSorting = 40;  // in hyperplanes
    constexpr std::size_t kLarge = 2'500'000;
    const std::size_t elements =
        polytope.vertices.size() + polytope.edges.size() + polytope.faces.size() + polytope.cells.size();
    return elements * (kSorting + planes) > kLarge;
}

}  // namespace

bool ConvexCut::cut(const Polytope& polytope, Levels levels, std::span<SliceSet* const> touching, SliceSet& out) {
    if (!levels.anyLie && isWorthTwoCores(polytope, out.planes.count)) return cutHalves(polytope, levels, out);
    Sweep& sweep = lower_.sweep;
    if (!sweep.begin(polytope, levels, out.planes.count)) return false;
    SliceSize size = sweep.size();
    for (const SliceSet* slice : touching) {
        if (slice != nullptr) size = size + slice->size();
    }
    out.resize(size);
    SliceSize end;
    if (!sweep.cut(polytope, touching, 0, end, out)) return false;
    out.end(end);
    return true;
}

// Where no vertex lies in a hyperplane: then the size of the lower half tells where the upper one begins.
bool ConvexCut::cutHalves(const Polytope& polytope, Levels levels, SliceSet& out) {
    const auto [least, most] = std::minmax_element(levels.below.begin(), levels.below.end());
    const std::int32_t middle = (*least + *most) / 2;
    const auto begin = [&](Half& half, std::int32_t first, std::int32_t end) {
        half.below.resize(levels.below.size());
        std::transform(levels.below.begin(), levels.below.end(), half.below.begin(),
                       [&](std::int32_t below) { return std::clamp(below, first, end) - first; });
        half.sound = half.sweep.begin(polytope, {half.below, half.below, false}, end - first);
    };
    const auto cut = [&](Half& half, std::int32_t first) {
        half.sound = half.sweep.cut(polytope, {}, first, half.end, out);
    };
    const auto doBoth = [&](const auto& lower, const auto& upper) {
        Companion::instance().doBoth(std::ref(lower), std::ref(upper));
        return lower_.sound && upper_.sound;
    };
    if (!doBoth([&] { begin(lower_, 0, middle); }, [&] { begin(upper_, middle, out.planes.count); })) return false;
    lower_.end = {};
    upper_.end = lower_.sweep.size();
    out.resize(lower_.sweep.size() + upper_.sweep.size());
    if (!doBoth([&] { cut(lower_, 0); }, [&] { cut(upper_, middle); })) return false;
    out.end(upper_.end);
    return true;
}

}  // namespace oval4d::geometry
