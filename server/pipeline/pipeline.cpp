#include "pipeline/pipeline.hpp"

#include <utility>

#include "scene/pick.hpp"
#include "scene/pick_level.hpp"
#include "slicing/field_sample.hpp"
#include "slicing/slice_edges.hpp"
#include "wire/messages.hpp"

namespace oval4d::pipeline {

using raster::measureSeconds;

Pipeline::Pipeline(std::unique_ptr<raster::Rasterizer> rasterizer, parallel::ForkJoin* forkJoin,
                   PictureWorkLimits limits)
    : rasterizer_(std::move(rasterizer)), forkJoin_(forkJoin), limits_(limits), workspace_(forkJoin) {}

slicing::NamedSection Pipeline::nameFocusSection(const scene::PictureRequest& picture,
                                                 const slicing::SliceSet* slices) {
    const parallel::ExclusiveUseAssertion::ScopedUse use(inUse_);
    scene::Composer& composer = workspace_.composer;
    FocusSectionNamer& namer = workspace_.sectionNamer;
    const double w = picture.focusPlane().w(0);
    if (const auto& known = composer.namedSection();
        known && known->isSectionOf(picture.object, picture.orientation, w))
        return *known;
    composer.reuseSectionNames(slices != nullptr ? namer.name(picture, *slices) : namer.name(picture));
    return *composer.namedSection();
}

void Pipeline::reuseFocusSectionNames(const slicing::NamedSection& section) {
    const parallel::ExclusiveUseAssertion::ScopedUse use(inUse_);
    workspace_.composer.reuseSectionNames(section);
}

void Pipeline::slice(const scene::PictureRequest& picture, slicing::SliceSet& out) {
    const parallel::ExclusiveUseAssertion::ScopedUse use(inUse_);
    times_ = {};
    times_.slice = measureSeconds([&] {
        slicing::checkSliceEdges(picture.object, picture.orientation, picture.planes, limits_.sliceEdges);
        const double circumradius = slicing::infoOf(picture.object).circumradius;
        slicing::setUniformDetail(circumradius, picture.planes, picture.quality, workspace_.detail);
        slicing::setUniformFogSteps(circumradius, picture.planes, workspace_.detail);
        workspace_.detail.secondValues = scene::colorsByValue(picture.look);
        workspace_.slicer.slice(picture.object, picture.orientation, picture.planes, picture.look.field,
                                workspace_.detail, out);
    });
}

void Pipeline::writeSlices(const scene::PictureRequest& picture, const slicing::SliceSet& slices,
                           std::uint64_t revision, std::optional<double> id, wire::Encoding encoding,
                           std::string& out) {
    const parallel::ExclusiveUseAssertion::ScopedUse use(inUse_);
    workspace_.composer.limitFaceFilling(limits_.fillSteps);
    workspace_.composer.limitOcclusion(limits_.occlusionSteps);
    times_.compose = measureSeconds([&] {
        workspace_.composer.compose(picture.object, picture.orientation, slices, picture.focus, picture.look,
                                    picture.viewport, workspace_.scene, picture.quality);
    });
    times_.write = measureSeconds(
        [&] { workspace_.slicesWriter.write(workspace_.scene, revision, id, encoding, out, picture.quality); });
}

std::string Pipeline::describePoint(const scene::PictureRequest& picture, std::uint64_t revision,
                                    std::optional<double> id, glm::dvec2 point) {
    const parallel::ExclusiveUseAssertion::ScopedUse use(inUse_);
    workspace_.composer.limitOcclusion(limits_.occlusionSteps);
    workspace_.composer.compose(picture.object, picture.orientation, slicesForPointing(picture), picture.focus,
                                picture.look, picture.viewport, workspace_.scene, picture.quality,
                                scene::ScenePurpose::pointing);
    const scene::Scene& composed = workspace_.scene;
    wire::PictureAtPixel at;
    at.element = scene::pickElement(composed, picture.object, point);
    at.panelPoint = scene::matrixPointAt(composed, point);
    if (const fields::Field* const field = slicing::fieldIn(picture.object)) {
        at.level = scene::pickLevel(composed, *field, picture.orientation, point, at.element);
        if (at.level) {
            at.element.reset();
            at.sample = slicing::sampleField(*field, picture.orientation, at.level->point);
        }
    }
    return wire::pickMessage(at, composed, picture.object, picture.source, revision, id);
}

const slicing::SliceSet& Pipeline::slicesForPointing(const scene::PictureRequest& picture) {
    auto& [input, slices] = workspace_.toPointAt;
    SlicesForPointing::SlicingInput wanted{slicing::infoOf(picture.object).serial, picture.orientation, picture.planes};
    if (input != wanted) {
        input.reset();  // so that `slices` does not count as valid if one of the next calls throws
        slicing::checkSliceEdges(picture.object, picture.orientation, wanted.planes, limits_.sliceEdges);
        workspace_.slicer.sliceWithoutSurfaces(picture.object, picture.orientation, wanted.planes, slices);
        input = std::move(wanted);
    }
    return slices;
}

void Pipeline::drawPng(const scene::PictureRequest& picture, std::string_view stateText, std::vector<std::uint8_t>& out,
                       const std::function<void()>& drawn) {
    const parallel::ExclusiveUseAssertion::ScopedUse use(inUse_);
    times_ = {};
    slicing::checkSliceEdges(picture.object, picture.orientation, picture.planes, limits_.sliceEdges);
    const auto pixels = rasterizer_->draw(picture, times_);
    const image::ImageView image{picture.viewport.width, picture.viewport.height, pixels,
                                 picture.look.background == scene::Background::transparent};
    if (drawn) drawn();
    times_.encode = measureSeconds([&] { workspace_.encoder.encode(image, stateText, out); });
}

void Pipeline::freeMemory() {
    const parallel::ExclusiveUseAssertion::ScopedUse use(inUse_);
    workspace_ = Workspace(forkJoin_);
    rasterizer_->freeMemory();
}

}  // namespace oval4d::pipeline
