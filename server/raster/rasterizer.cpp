#include "raster/rasterizer.hpp"

namespace oval4d::raster {

void LocalRasterizer::warmUp() {
    if (!renderer_) renderer_.emplace(render::defaultFontPath(), render::ShapeBackend::fastest, forkJoin_);
}

std::span<const std::uint8_t> LocalRasterizer::draw(const scene::PictureRequest& picture, DrawTimes& times) {
    workspace_.pixels.resize(image::byteCount(picture.viewport.width, picture.viewport.height));
    draw(picture, workspace_.pixels, times);
    return workspace_.pixels;
}

void LocalRasterizer::draw(const scene::PictureRequest& picture, std::span<std::uint8_t> pixels, DrawTimes& times) {
    warmUp();
    Workspace& m = workspace_;
    m.composer.limitFaceFilling(fillSteps_);
    m.composer.limitOcclusion(occlusionSteps_);
    times.slice = measureSeconds([&] {
        m.composer.layOutAndChooseDetail(picture.object, picture.planes, picture.focus, picture.look, picture.viewport,
                                         picture.quality, m.scene, m.detail);
        m.slicer.slice(picture.object, picture.orientation, picture.planes, picture.look.field, m.detail, m.slices);
    });
    times.compose = measureSeconds([&] {
        m.composer.compose(picture.object, picture.orientation, m.slices, picture.focus, picture.look, picture.viewport,
                           m.scene, picture.quality);
    });
    times.draw = measureSeconds([&] { renderer_->draw(m.scene, pixels); });
}

void LocalRasterizer::freeMemory() {
    workspace_ = Workspace(forkJoin_);
    if (renderer_) renderer_->freeMemory();
}

}  // namespace oval4d::raster
