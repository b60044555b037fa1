#include "pipeline/focus_section.hpp"

#include <cstddef>
#include <numeric>

namespace oval4d::pipeline {

bool FocusSectionNamer::isFast(const slicing::Object& object) {
    constexpr std::size_t kFew = 1000;
    // The sections have no names, so nothing is cut: see SectionNamer::mayHaveName().
    if (!slicing::propertiesOf(object).sectionsHaveNames) return true;
    const auto counts = slicing::elementCounts(object);
    return std::accumulate(counts.begin(), counts.end(), std::size_t{0}) <= kFew;
}

slicing::NamedSection FocusSectionNamer::name(const scene::PictureRequest& picture) {
    const geometry::Hyperplanes plane = picture.focusPlane();
    slicing::NamedSection section{slicing::infoOf(picture.object).serial, picture.orientation, plane.w(0), {}};
    if (!slicing::SectionNamer::mayHaveName(picture.object, picture.orientation, section.w)) return section;
    slicer_.sliceWithoutSurfaces(picture.object, picture.orientation, plane, slice_);
    return name(picture, slice_);
}

slicing::NamedSection FocusSectionNamer::name(const scene::PictureRequest& picture, const slicing::SliceSet& slices) {
    const int slice = picture.focus - slices.planes.first;
    slicing::NamedSection section{
        slicing::infoOf(picture.object).serial, picture.orientation, picture.focusPlane().w(0), {}};
    if (!slicing::propertiesOf(picture.object).sectionsHaveNames) return section;
    section.names = {namer_.nameOfSlice(slices, slice),
                     namer_.nameOfHullOfObjectVertices(slices, slice, slicing::elementCounts(picture.object)[1])};
    return section;
}

}  // namespace oval4d::pipeline
