#include "render/renderer.hpp"

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <stdexcept>

#include <glm/common.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "parallel/ownership.hpp"
#include "render/context.hpp"
#include "render/overlay/annotations.hpp"
#include "render/overlay/density_strip.hpp"
#include "render/overlay/matrix_panels.hpp"
#include "render/overlay/overlay.hpp"
#include "render/projection.hpp"
#include "render/slices/convex_slices.hpp"
#include "render/slices/nonconvex_slices.hpp"
#include "render/slices/projection_painter.hpp"
#include "render/slices/shape_batch.hpp"

namespace oval4d::render {

std::string fontFile() {
    const char* file = std::getenv("OVAL4D_FONT");
    return file != nullptr && *file != '\0' ? file : OVAL4D_FONT;
}

namespace {

// The minimum number of indices of a batch. While the driver's threads rasterize one batch, this thread prepares the
// next one.
constexpr std::size_t kBatchIndices = 12'000;

/// Returns a lock that every use of Mesa must hold, because all contexts of a process share state. A context that draws
/// reads the llvmpipe scenes of the other contexts (llvmpipe_is_resource_referenced), which in Mesa 22.3 another thread
/// may free at the same time.
std::unique_lock<std::mutex> lockDriver() {
    static std::mutex driver;
    return std::unique_lock(driver);
}

/// Clears the depth buffer where the projection of the whole object is drawn. To clear all of it would take longer than
/// to draw the projection.
void clearDepthBehindProjection(const scene::Scene& scene) {
    const auto& [shown, position, radius] = scene.projectionPlacement;
    const glm::dvec3 center(scene.camera.view() * glm::dvec4(position, 1));
    const double nearest = -center.z - radius;  // the distance of the nearest point from the eye, along the view axis
    if (nearest > 0) {
        const Projection projection = Projection::of(scene.camera, scene.viewport);
        const glm::vec2 middle = projection.pixel(center);
        const float reach = projection.focalLength() * static_cast<float>(radius / nearest) + 1;
        const glm::vec2 size(scene.viewport.width, scene.viewport.height);
        const glm::ivec2 from(glm::clamp(glm::floor(middle - reach), glm::vec2(0), size));
        const glm::ivec2 to(glm::clamp(glm::ceil(middle + reach), glm::vec2(0), size));
        glEnable(GL_SCISSOR_TEST);
        glScissor(from.x, from.y, to.x - from.x, to.y - from.y);
    }
    glClear(GL_DEPTH_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
}

}  // namespace

struct Renderer::Impl {
    explicit Impl(const std::string& font)
        : patchDepthProgram(scene::style(), ShapeProgram::DepthSource::patch),
          surfaceDepthProgram(scene::style(), ShapeProgram::DepthSource::surface),
          overlay(font) {}

    void flushShapes();
    void drawLayers(const scene::Scene& scene);
    void drawProjection(DepthRange depths);

    parallel::ThreadOwned owner;
    Context context;  // before the members that need a current context
    ShapeProgram patchDepthProgram, surfaceDepthProgram;
    DensityStrip densityStrip;
    Overlay overlay;
    ShapeBatch shapes;
    ConvexSlicePainter convexPainter;
    NonconvexSlicePainter crossingPainter;
    NonconvexSlicePainter::Layers layers;
    ProjectionPainter projectionPainter;
    ProjectionPainter::Layers projectionLayers;
};

void Renderer::Impl::flushShapes() {
    patchDepthProgram.draw(shapes);
    context.flush();
    shapes.clear();
}

// Draws slices that need not be convex, with the projection of the whole object if it is shown.
void Renderer::Impl::drawLayers(const scene::Scene& scene) {
    DepthRange depths = layers.depths;
    if (scene.projectionPlacement.shown) {
        projectionPainter.paint(scene, projectionLayers);
        const DepthRange more = projectionLayers.depths;
        depths = {std::min(depths.from, more.from), std::max(depths.to, more.to)};
    }
    glEnable(GL_DEPTH_TEST);
    glClear(GL_DEPTH_BUFFER_BIT);
    glDisable(GL_BLEND);
    patchDepthProgram.drawWithDepth(depths, layers.faces);
    context.flush();
    glEnable(GL_BLEND);
    surfaceDepthProgram.drawWithDepth(depths, layers.skeleton);
    if (scene.projectionPlacement.shown) drawProjection(depths);
    glDepthMask(GL_FALSE);
    surfaceDepthProgram.drawWithDepth(depths, layers.faded);
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);
}

// Draws the prepared projection of the whole object. The depth test must be enabled.
void Renderer::Impl::drawProjection(DepthRange depths) {
    surfaceDepthProgram.drawWithDepth(depths, projectionLayers.solid);
    context.flush();
    glDepthMask(GL_FALSE);
    surfaceDepthProgram.drawWithDepth(depths, projectionLayers.translucent);
    glDepthMask(GL_TRUE);
}

Renderer::Renderer(const std::string& font) {
    {
        const auto lock = lockDriver();
        impl_ = std::make_unique<Impl>(font);
    }
    // Mesa compiles a shader at its first draw call, so draw an empty scene now.
    image::Image image;
    scene::Scene scene;
    scene.viewport = {64, 64};
    scene.axes = {0.5, 0.5, 0.4};
    draw(scene, image);
}

Renderer::~Renderer() {
    const auto lock = lockDriver();
    impl_.reset();
}

void Renderer::freeMemory() {
    impl_->shapes = {};
    impl_->convexPainter = {};
    impl_->crossingPainter = {};
    impl_->layers = {};
    impl_->projectionPainter = {};
    impl_->projectionLayers = {};
}

void Renderer::draw(const scene::Scene& scene, image::Image& out) {
    out.width = scene.viewport.width;
    out.height = scene.viewport.height;
    out.pixels.resize(image::byteCount(scene.viewport));
    draw(scene, std::span(out.pixels));
}

void Renderer::draw(const scene::Scene& scene, std::span<std::uint8_t> pixels) {
    if (pixels.size() != image::byteCount(scene.viewport))
        throw std::invalid_argument("the pixel buffer does not have the size of the viewport");
    ShapeBatch& shapes = impl_->shapes;
    Overlay& overlay = impl_->overlay;
    impl_->owner.assertOwner();
    const auto lock = lockDriver();
    impl_->context.begin(scene.viewport.width, scene.viewport.height, pixels.data());

    const scene::Color background = scene::style().background;
    const auto channel = [&](int shift) { return static_cast<float>(background >> shift & 255) / 255; };
    glClearColor(channel(16), channel(8), channel(0), 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // premultiplied alpha, for which blending is cheaper

    shapes.begin(scene::style());
    overlay.begin(scene.viewport);
    if (!scene.crossing) {
        const auto painted = [this] {
            if (impl_->shapes.indices().size() >= kBatchIndices) impl_->flushShapes();
        };
        const auto paintProjection = [this, &scene] {
            impl_->flushShapes();
            impl_->projectionPainter.paint(scene, impl_->projectionLayers);
            glEnable(GL_DEPTH_TEST);
            clearDepthBehindProjection(scene);
            impl_->drawProjection(impl_->projectionLayers.depths);
            glDisable(GL_DEPTH_TEST);
        };
        impl_->convexPainter.paint(scene, shapes, painted, paintProjection);
    } else {
        impl_->crossingPainter.paint(scene, impl_->layers);
        impl_->drawLayers(scene);
    }
    paintAxes(scene, shapes, overlay);
    paintCoordinates(scene, overlay);
    paintLabels(scene, overlay);
    paintMatrix(scene, overlay);

    impl_->patchDepthProgram.draw(shapes);
    impl_->densityStrip.draw(scene);
    overlay.draw();
    impl_->context.finish();
}

}  // namespace oval4d::render
