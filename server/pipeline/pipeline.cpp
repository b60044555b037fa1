#include "pipeline/pipeline.hpp"

#include <utility>

#include "scene/pick.hpp"
#include "wire/messages.hpp"

namespace oval4d::pipeline {

using raster::measureSeconds;

Pipeline::Pipeline(std::unique_ptr<raster::Rasterizer> rasterizer, parallel::ForkJoin* forkJoin, std::size_t fillSteps)
    : rasterizer_(std::move(rasterizer)), forkJoin_(forkJoin), fillSteps_(fillSteps), memory_(forkJoin) {}

slicing::SectionNames Pipeline::nameFocusSection(const session::State& state) {
    const parallel::ExclusiveUse::Use use(inUse_);
    return memory_.sectionNamer.names(state);
}

void Pipeline::slice(const session::State& state, slicing::Quality quality, slicing::SliceSet& out) {
    const parallel::ExclusiveUse::Use use(inUse_);
    times_ = {};
    times_.slice = measureSeconds([&] {
        const geometry::Hyperplanes planes = state.hyperplanes();
        const double circumradius = slicing::infoOf(state.object).circumradius;
        slicing::setEvenDetail(circumradius, planes, quality, memory_.detail);
        slicing::addEvenFog(circumradius, planes, memory_.detail);
        memory_.detail.secondValues = scene::colorsByValue(state.look);
        memory_.slicer.slice(state.object, state.orientation, planes, state.look.field, memory_.detail, out);
    });
}

void Pipeline::writeSlices(const session::State& state, const slicing::SliceSet& slices, std::uint64_t revision,
                           std::optional<double> id, scene::Viewport viewport, wire::Encoding encoding,
                           std::string& out, slicing::Quality quality) {
    const parallel::ExclusiveUse::Use use(inUse_);
    memory_.composer.limitFill(fillSteps_);
    times_.compose = measureSeconds([&] {
        memory_.composer.compose(state.object, state.orientation, slices, state.slices.focus, state.look, viewport,
                                 memory_.scene);
    });
    times_.write =
        measureSeconds([&] { memory_.slicesWriter.write(memory_.scene, revision, id, encoding, out, quality); });
}

std::string Pipeline::describePoint(const session::State& state, const slicing::SliceSet& slices,
                                    std::uint64_t revision, std::optional<double> id, scene::Viewport viewport,
                                    glm::dvec2 point) {
    const parallel::ExclusiveUse::Use use(inUse_);
    memory_.composer.limitFill(0);  // the triangles that fill faces are not needed
    memory_.composer.compose(state.object, state.orientation, slices, state.slices.focus, state.look, viewport,
                             memory_.scene);
    return wire::atMessage(scene::pickElement(memory_.scene, state.object, point),
                           scene::matrixPointAt(memory_.scene, point), memory_.scene, state.object, revision, id);
}

void Pipeline::drawPng(const session::State& state, std::string_view stateText, scene::Viewport viewport,
                       slicing::Quality quality, std::vector<std::uint8_t>& out, const std::function<void()>& drawn) {
    const parallel::ExclusiveUse::Use use(inUse_);
    times_ = {};
    const image::ImageView image{viewport.width, viewport.height, rasterizer_->draw(state, viewport, quality, times_),
                                 state.look.background == scene::Background::transparent};
    if (drawn) drawn();
    times_.encode = measureSeconds([&] { memory_.encoder.encode(image, stateText, out); });
}

void Pipeline::freeMemory() {
    const parallel::ExclusiveUse::Use use(inUse_);
    memory_ = Memory(forkJoin_);
    rasterizer_->freeMemory();
}

}  // namespace oval4d::pipeline
