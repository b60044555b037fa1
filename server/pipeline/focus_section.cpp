#include "pipeline/focus_section.hpp"

namespace oval4d::pipeline {

slicing::SectionNamePair FocusSectionNamer::names(const session::State& state) {
    if (!slicing::SectionNamer::mayHaveName(state.object, state.orientation, state.focusW())) return {};
    const auto& [count, spacing, focus, offset] = state.slices;
    slicer_.sliceWithoutSurfaces(state.object, state.orientation, {focus, 1, spacing, offset}, slice_);
    return {namer_.nameOfSlice(slice_, 0),
            namer_.nameOfObjectVertices(slice_, 0, slicing::elementCounts(state.object)[1])};
}

}  // namespace oval4d::pipeline
