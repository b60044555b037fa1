#include "raster/rasterizer.hpp"

namespace oval4d::raster {

void LocalRasterizer::warmUp() {
    if (!renderer_) renderer_.emplace(render::fontFile(), render::ShapeBackend::fastest, forkJoin_);
}

std::span<const std::uint8_t> LocalRasterizer::draw(const session::State& state, scene::Viewport viewport,
                                                    slicing::Quality quality, DrawTimes& times) {
    workspace_.pixels.resize(image::byteCount(viewport));
    draw(state, viewport, quality, workspace_.pixels, times);
    return workspace_.pixels;
}

void LocalRasterizer::draw(const session::State& state, scene::Viewport viewport, slicing::Quality quality,
                           std::span<std::uint8_t> pixels, DrawTimes& times) {
    warmUp();
    Workspace& m = workspace_;
    m.composer.limitFaceFilling(fillSteps_);
    times.slice = measureSeconds([&] {
        const geometry::Hyperplanes planes = state.hyperplanes();
        m.composer.layOutAndChooseDetail(state.object, planes, state.slices.focus, state.look, viewport, quality,
                                         m.scene, m.detail);
        m.slicer.slice(state.object, state.orientation, planes, state.look.field, m.detail, m.slices);
    });
    times.compose = measureSeconds([&] {
        m.composer.compose(state.object, state.orientation, m.slices, state.slices.focus, state.look, viewport, m.scene,
                           quality);
    });
    times.draw = measureSeconds([&] { renderer_->draw(m.scene, pixels); });
}

void LocalRasterizer::freeMemory() {
    workspace_ = Workspace(forkJoin_);
    if (renderer_) renderer_->freeMemory();
}

}  // namespace oval4d::raster
