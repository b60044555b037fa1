#include "raster/rasterizer.hpp"

namespace oval4d::raster {

void LocalRasterizer::warmUp() {
    if (!renderer_) renderer_.emplace();
}

std::span<const std::uint8_t> LocalRasterizer::draw(const session::State& state, scene::Viewport viewport,
                                                    DrawTimes& times) {
    memory_.pixels.resize(image::byteCount(viewport));
    draw(state, viewport, memory_.pixels, times);
    return memory_.pixels;
}

void LocalRasterizer::draw(const session::State& state, scene::Viewport viewport, std::span<std::uint8_t> pixels,
                           DrawTimes& times) {
    warmUp();
    Memory& m = memory_;
    m.composer.limitFill(fillSteps_);
    times.slice =
        measureSeconds([&] { m.slicer.slice(state.object, state.orientation, state.hyperplanes(), m.slices); });
    times.compose = measureSeconds([&] {
        m.composer.compose(state.object, state.orientation, m.slices, state.slices.focus, state.look, viewport,
                           m.scene);
    });
    times.draw = measureSeconds([&] { renderer_->draw(m.scene, pixels); });
}

void LocalRasterizer::freeMemory() {
    memory_ = Memory(forkJoin_);
    if (renderer_) renderer_->freeMemory();
}

}  // namespace oval4d::raster
