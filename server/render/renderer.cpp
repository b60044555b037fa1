#include "render/renderer.hpp"

#include <cstdlib>
#include <mutex>
#include <stdexcept>

#include "parallel/ownership.hpp"
#include "render/context.hpp"
#include "render/overlay/annotations.hpp"
#include "render/overlay/density_strip.hpp"
#include "render/overlay/overlay.hpp"
#include "render/slices/convex_slices.hpp"
#include "render/slices/nonconvex_slices.hpp"
#include "render/slices/shape_batch.hpp"

namespace oval4d::render {

std::string fontFile() {
    const char* file = std::getenv("OVAL4D_FONT");
    return file != nullptr && *file != '\0' ? file : OVAL4D_FONT;
}

namespace {

// The number of indices drawn in one batch: while the driver's threads rasterize a batch, this thread prepares the
// next.
constexpr std::size_t kBatchIndices = 12'000;

/// Returns a lock that every use of Mesa must hold, because all contexts of a process share state: a context that draws
/// reads the llvmpipe scenes of the other contexts (llvmpipe_is_resource_referenced), and Mesa 22.3 does not guard
/// these against being freed by another thread.
std::unique_lock<std::mutex> lockDriver() {
    static std::mutex driver;
    return std::unique_lock(driver);
}

}  // namespace

struct Renderer::Impl {
    explicit Impl(const std::string& font)
        : flatProgram(scene::style(), ShapeProgram::Depth::flat),
          roundProgram(scene::style(), ShapeProgram::Depth::round),
          overlay(font) {}

    void drawLayers();

    parallel::ThreadOwned owner;
    Context context;  // before the members that need a current context
    ShapeProgram flatProgram, roundProgram;
    DensityStrip densityStrip;
    Overlay overlay;
    ShapeBatch shapes;
    ConvexSlicePainter convexPainter;
    NonconvexSlicePainter crossingPainter;
    NonconvexSlicePainter::Layers layers;
};

void Renderer::Impl::drawLayers() {
    glEnable(GL_DEPTH_TEST);
    glClear(GL_DEPTH_BUFFER_BIT);
    glDisable(GL_BLEND);
    flatProgram.drawWithDepth(layers.depths, layers.faces);
    context.start();
    glEnable(GL_BLEND);
    roundProgram.drawWithDepth(layers.depths, layers.skeleton);
    glDepthMask(GL_FALSE);
    roundProgram.drawWithDepth(layers.depths, layers.faded);
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);
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
}

void Renderer::draw(const scene::Scene& scene, image::Image& out) {
    out.width = scene.viewport.width;
    out.height = scene.viewport.height;
    out.pixels.resize(image::bytesOf(scene.viewport));
    draw(scene, std::span(out.pixels));
}

void Renderer::draw(const scene::Scene& scene, std::span<std::uint8_t> pixels) {
    if (pixels.size() != image::bytesOf(scene.viewport))
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
        impl_->convexPainter.paint(scene, shapes, [this, &shapes] {
            if (shapes.indices().size() < kBatchIndices) return;
            impl_->flatProgram.draw(shapes);
            impl_->context.start();
            shapes.clear();
        });
    } else {
        impl_->crossingPainter.paint(scene, impl_->layers);
        impl_->drawLayers();
    }
    paintAxes(scene, shapes, overlay);
    paintCoordinates(scene, overlay);
    paintLabels(scene, overlay);

    impl_->flatProgram.draw(shapes);
    impl_->densityStrip.draw(scene);
    overlay.draw();
    impl_->context.finish();
}

}  // namespace oval4d::render
