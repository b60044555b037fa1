#include "pipeline/pipeline.hpp"

#include <utility>

#include "pipeline/picture_of_state.hpp"
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

slicing::SectionNamePair Pipeline::nameFocusSection(const session::State& state) {
    const parallel::ExclusiveUseAssertion::ScopedUse use(inUse_);
    return workspace_.sectionNamer.names(state);
}

void Pipeline::slice(const session::State& state, slicing::Quality quality, slicing::SliceSet& out) {
    const parallel::ExclusiveUseAssertion::ScopedUse use(inUse_);
    times_ = {};
    times_.slice = measureSeconds([&] {
        const geometry::Hyperplanes planes = state.hyperplanes();
        slicing::checkSliceEdges(state.object, state.orientation, planes, limits_.sliceEdges);
        const double circumradius = slicing::infoOf(state.object).circumradius;
        slicing::setUniformDetail(circumradius, planes, quality, workspace_.detail);
        slicing::setUniformFogSteps(circumradius, planes, workspace_.detail);
        workspace_.detail.secondValues = scene::colorsByValue(state.look);
        workspace_.slicer.slice(state.object, state.orientation, planes, state.look.field, workspace_.detail, out);
    });
}

void Pipeline::writeSlices(const session::State& state, const slicing::SliceSet& slices, std::uint64_t revision,
                           std::optional<double> id, scene::Viewport viewport, wire::Encoding encoding,
                           std::string& out, slicing::Quality quality) {
    const parallel::ExclusiveUseAssertion::ScopedUse use(inUse_);
    workspace_.composer.limitFaceFilling(limits_.fillSteps);
    times_.compose = measureSeconds([&] {
        workspace_.composer.compose(state.object, state.orientation, slices, state.slices.focus, state.look, viewport,
                                    workspace_.scene, quality);
    });
    times_.write =
        measureSeconds([&] { workspace_.slicesWriter.write(workspace_.scene, revision, id, encoding, out, quality); });
}

std::string Pipeline::describePoint(const session::State& state, std::uint64_t revision, std::optional<double> id,
                                    scene::Viewport viewport, glm::dvec2 point) {
    const parallel::ExclusiveUseAssertion::ScopedUse use(inUse_);
    workspace_.composer.compose(state.object, state.orientation, sliceToPointAt(state), state.slices.focus, state.look,
                                viewport, workspace_.scene, slicing::Quality::full, scene::ScenePurpose::pointing);
    const scene::Scene& composed = workspace_.scene;
    wire::PictureAtPixel at;
    at.element = scene::pickElement(composed, state.object, point);
    at.panelPoint = scene::matrixPointAt(composed, point);
    if (const fields::Field* const field = slicing::fieldIn(state.object)) {
        at.level = scene::pickLevel(composed, *field, state.orientation, point, at.element);
        if (at.level) {
            at.element.reset();
            at.sample = slicing::sampleField(*field, state.orientation, at.level->point);
        }
    }
    return wire::atMessage(at, composed, state.object, state.source, revision, id);
}

const slicing::SliceSet& Pipeline::sliceToPointAt(const session::State& state) {
    auto& [input, slices] = workspace_.toPointAt;
    SlicesToPointAt::Input wanted{slicing::infoOf(state.object).serial, state.orientation, state.hyperplanes()};
    if (input != wanted) {
        input.reset();  // in case of an exception
        slicing::checkSliceEdges(state.object, state.orientation, wanted.planes, limits_.sliceEdges);
        workspace_.slicer.sliceWithoutSurfaces(state.object, state.orientation, wanted.planes, slices);
        input = std::move(wanted);
    }
    return slices;
}

void Pipeline::drawPng(const session::State& state, std::string_view stateText, scene::Viewport viewport,
                       slicing::Quality quality, std::vector<std::uint8_t>& out, const std::function<void()>& drawn) {
    const parallel::ExclusiveUseAssertion::ScopedUse use(inUse_);
    times_ = {};
    slicing::checkSliceEdges(state.object, state.orientation, state.hyperplanes(), limits_.sliceEdges);
    writePictureOfState(state, viewport, quality, workspace_.picture);
    const auto pixels = rasterizer_->draw(workspace_.picture, times_);
    const image::ImageView image{viewport.width, viewport.height, pixels,
                                 state.look.background == scene::Background::transparent};
    if (drawn) drawn();
    times_.encode = measureSeconds([&] { workspace_.encoder.encode(image, stateText, out); });
}

void Pipeline::freeMemory() {
    const parallel::ExclusiveUseAssertion::ScopedUse use(inUse_);
    workspace_ = Workspace(forkJoin_);
    rasterizer_->freeMemory();
}

}  // namespace oval4d::pipeline
