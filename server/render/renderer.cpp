#include "render/renderer.hpp"

#include <cstdlib>
#include <stdexcept>

#include "render/annotations.hpp"
#include "render/context.hpp"
#include "render/crossing.hpp"
#include "render/overlay.hpp"
#include "render/slices.hpp"
#include "render/solids.hpp"
#include "render/strip.hpp"

namespace oval4d::render {

std::string fontFile() {
    const char* file = std::getenv("OVAL4D_FONT");
    return file != nullptr && *file != '\0' ? file : OVAL4D_FONT;
}

namespace {

// Indices. So many are drawn at once: while the driver's threads fill their pixels, this one prepares the next.
constexpr std::size_t kPart = 12'000;

}  // namespace

struct Renderer::Impl {
    explicit Impl(const std::string& font)
        : flatProgram(scene::style(), SolidProgram::Depth::flat),
          roundProgram(scene::style(), SolidProgram::Depth::round),
          overlay(font) {}

    void drawLayers();

    Context context;  // first: all else lives in it
    SolidProgram flatProgram, roundProgram;
    Strip strip;
    Overlay overlay;
    Solids solids;
    SlicePainter slicePainter;
    CrossingPainter crossingPainter;
    CrossingPainter::Layers layers;
};

void Renderer::Impl::drawLayers() {
    glEnable(GL_DEPTH_TEST);
    glClear(GL_DEPTH_BUFFER_BIT);
    glDisable(GL_BLEND);
    flatProgram.drawWithin(layers.depths, layers.faces);
    context.start();
    glEnable(GL_BLEND);
    roundProgram.drawWithin(layers.depths, layers.frame);
    glDepthMask(GL_FALSE);
    roundProgram.drawWithin(layers.depths, layers.faded);
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);
}

Renderer::Renderer(const std::string& font) : impl_(std::make_unique<Impl>(font)) {
    // Mesa compiles a shader when it first draws with it.
    Image image;
    scene::Scene scene;
    scene.viewport = {64, 64};
    scene.axes = {0.5, 0.5, 0.4};
    draw({}, {}, scene, image);
}

Renderer::~Renderer() = default;

void Renderer::forget() {
    impl_->solids = {};
    impl_->slicePainter = {};
    impl_->crossingPainter = {};
    impl_->layers = {};
}

void Renderer::draw(const geometry::Polytope& polytope, const geometry::SliceSet& slices, const scene::Scene& scene,
                    Image& out) {
    out.width = scene.viewport.width;
    out.height = scene.viewport.height;
    out.pixels.resize(bytesOf(scene.viewport));
    draw(polytope, slices, scene, std::span(out.pixels));
}

void Renderer::draw(const geometry::Polytope& polytope, const geometry::SliceSet& slices, const scene::Scene& scene,
                    std::span<std::uint8_t> pixels) {
    if (pixels.size() != bytesOf(scene.viewport)) throw std::invalid_argument("the picture has no place to go");
    Solids& solids = impl_->solids;
    Overlay& overlay = impl_->overlay;
    impl_->context.begin(scene.viewport.width, scene.viewport.height, pixels.data());

    const scene::Colour background = scene::style().background;
    const auto channel = [&](int shift) { return static_cast<float>(background >> shift & 255) / 255; };
    glClearColor(channel(16), channel(8), channel(0), 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // colours come times their opacity: blending is cheaper so

    solids.begin(scene::style());
    overlay.begin(scene.viewport);
    if (polytope.convex) {
        impl_->slicePainter.paint(polytope, slices, scene, solids, [this, &solids] {
            if (solids.indices().size() < kPart) return;
            impl_->flatProgram.draw(solids);
            impl_->context.start();
            solids.clear();
        });
    } else {
        impl_->crossingPainter.paint(polytope, slices, scene, impl_->layers);
        impl_->drawLayers();
    }
    paintAxes(scene, solids, overlay);
    paintCoordinates(slices, scene, overlay);
    paintLabels(scene, overlay);

    impl_->flatProgram.draw(solids);
    impl_->strip.draw(scene);
    overlay.draw();
    impl_->context.finish();
}

}  // namespace oval4d::render
