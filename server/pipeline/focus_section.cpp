#include "pipeline/focus_section.hpp"

#include <cstddef>
#include <numeric>

namespace oval4d::pipeline {

bool FocusSectionNamer::isFast(const session::State& state) {
    constexpr std::size_t kFew = 1000;
    if (!slicing::propertiesOf(state.object).sectionsHaveNames) return true;  // see SectionNamer::mayHaveName()
    const auto counts = slicing::elementCounts(state.object);
    return std::accumulate(counts.begin(), counts.end(), std::size_t{0}) <= kFew;
}

slicing::SectionNamePair FocusSectionNamer::names(const session::State& state) {
    if (!slicing::SectionNamer::mayHaveName(state.object, state.orientation, state.focusW())) return {};
    const auto& [count, spacing, focus, offset] = state.slices;
    slicer_.sliceWithoutSurfaces(state.object, state.orientation, {focus, 1, spacing, offset}, slice_);
    return {namer_.nameOfSlice(slice_, 0),
            namer_.nameOfObjectVertices(slice_, 0, slicing::elementCounts(state.object)[1])};
}

}  // namespace oval4d::pipeline
