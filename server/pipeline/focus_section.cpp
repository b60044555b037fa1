#include "pipeline/focus_section.hpp"

#include <cstddef>
#include <numeric>

namespace oval4d::pipeline {

bool FocusSectionNamer::isFast(const slicing::Object& object) {
    constexpr std::size_t kFew = 1000;
    if (!slicing::propertiesOf(object).sectionsHaveNames) return true;  // see SectionNamer::mayHaveName()
    const auto counts = slicing::elementCounts(object);
    return std::accumulate(counts.begin(), counts.end(), std::size_t{0}) <= kFew;
}

slicing::SectionNamePair FocusSectionNamer::names(const scene::PictureRequest& picture) {
    const geometry::Hyperplanes plane = picture.focusPlane();
    if (!slicing::SectionNamer::mayHaveName(picture.object, picture.orientation, plane.w(0))) return {};
    slicer_.sliceWithoutSurfaces(picture.object, picture.orientation, plane, slice_);
    return {namer_.nameOfSlice(slice_, 0),
            namer_.nameOfObjectVertices(slice_, 0, slicing::elementCounts(picture.object)[1])};
}

}  // namespace oval4d::pipeline
