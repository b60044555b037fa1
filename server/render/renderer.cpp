#include "render/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "parallel/ownership.hpp"
#include "render/offscreen_gl_context.hpp"
#include "render/overlay/annotations.hpp"
#include "render/overlay/coordinates_plot.hpp"
#include "render/overlay/matrix_panels.hpp"
#include "render/overlay/overlay.hpp"
#include "render/slices/convex_slices.hpp"
#include "render/slices/fog_painter.hpp"
#include "render/slices/nonconvex_slices.hpp"
#include "render/slices/projection_shapes.hpp"
#include "render/slices/shape_batch.hpp"
#include "render/slices/shape_rasterizer.hpp"
#include "render/slices/surface_batch.hpp"
#include "render/slices/surface_rasterizer.hpp"

namespace oval4d::render {

std::string fontFile() {
    const char* file = std::getenv("OVAL4D_FONT");
    return file != nullptr && *file != '\0' ? file : OVAL4D_FONT;
}

namespace {

// With OpenGL, the patches (see shape_batch.hpp) of convex slices are drawn in batches of at least this many. Only the
// last batch, and the last one before the projection of the whole object, may be smaller. While the threads of the
// driver rasterize one batch, this thread prepares the next one.
constexpr std::size_t kBatchPatches = 2'000;

/// Returns a lock that every use of Mesa must hold, because all contexts of a process share state. A context that draws
/// reads the llvmpipe scenes of the other contexts (llvmpipe_is_resource_referenced). In Mesa 22.3, another thread may
/// free these scenes at the same time.
std::unique_lock<std::mutex> lockDriver() {
    static std::mutex driver;
    return std::unique_lock(driver);
}

/// Returns whether a picture may be drawn with several threads. The environment variable LP_NUM_THREADS sets the number
/// of threads of llvmpipe; the values 0 and 1 also forbid a second thread for drawing without OpenGL.
bool mayUseThreads() {
    const char* threads = std::getenv("LP_NUM_THREADS");
    return threads == nullptr || std::atoi(threads) > 1;
}

/// Returns whether the slices can be drawn only with OpenGL, because they have fog.
bool needsOpenGl(const scene::Scene& scene) { return !scene.fog.empty(); }

/// Returns a rectangle of the picture that contains all pixels of these shapes. The caller clears only this part of the
/// depth buffer; elsewhere, depths of earlier pictures remain. The rectangle is computed from the vertices of the
/// shapes, not from ProjectionPlacement::radius: far from the view axis, the image of a sphere is an ellipse, and balls
/// of a cloud may extend beyond the sphere.
PixelArea areaOf(const ProjectionShapeCollector::Layers& layers, scene::Viewport viewport) {
    const glm::vec2 most(viewport.width, viewport.height);
    glm::vec2 least(1), greatest(-1);
    for (const ShapeBatch* shapes : {&layers.solid, &layers.translucent}) {
        for (const Patch& patch : shapes->patches()) {
            least = glm::min(least, patch.least);
            greatest = glm::max(greatest, patch.greatest);
        }
    }
    const glm::vec2 from = (least * 0.5F + 0.5F) * most, to = (greatest * 0.5F + 0.5F) * most;
    // One pixel more on each side, because of rounding errors.
    const glm::vec2 first = glm::clamp(glm::floor(from) - 1.0F, glm::vec2(0), most);
    const glm::vec2 end = glm::clamp(glm::ceil(to) + 1.0F, first, most);
    return {glm::ivec2(first), glm::ivec2(end)};
}

/// Sets the color to which OpenGL clears pictures: the background, multiplied by its opacity.
void setClearColor(const scene::Style& style) {
    const auto alpha = static_cast<float>(style.backgroundOpacity);
    const auto channel = [&](int shift) { return alpha * static_cast<float>(style.background >> shift & 255) / 255; };
    glClearColor(channel(16), channel(8), channel(0), alpha);
}

/// If the viewer has moved the camera, clears the part of the picture that belongs to the parallel coordinates, because
/// slices may then extend into it.
void clearCoordinatesArea(const scene::Scene& scene) {
    if (!scene.clearsCoordinatesArea()) return;
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, scene.viewport.width,
              static_cast<int>(std::lround(scene.coordinates.top() * scene.viewport.height)));
    setClearColor(scene.style());
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
}

/// Clears a part of the depth buffer of OpenGL.
void clearDepth(const PixelArea& area) {
    glEnable(GL_SCISSOR_TEST);
    glScissor(area.from.x, area.from.y, area.to.x - area.from.x, area.to.y - area.from.y);
    glClear(GL_DEPTH_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
}

}  // namespace

struct Renderer::Impl {
    Impl(const std::string& font, ShapeBackend drawing, parallel::ForkJoin* forkJoinOrNull)
        : shapesInMemory(drawing == ShapeBackend::fastest && ShapeRasterizer::isSupported()),
          forkJoin(mayUseThreads() ? forkJoinOrNull : nullptr),
          patchDepthProgram(scene::style(), ShapeProgram::DepthSource::patch),
          surfaceDepthProgram(scene::style(), ShapeProgram::DepthSource::surface),
          surfaceProgram(scene::style()),
          overlay(font) {}

    void flushShapes();
    void drawConvexSlices(const scene::Scene& scene);
    std::size_t addConvexSlices(const scene::Scene& scene);
    void addLayers(const scene::Scene& scene);
    void drawLayers(const scene::Scene& scene);
    void drawProjection(DepthRange depths);
    void prepareFog(const scene::Scene& scene, DepthRange depths);
    void drawFogBehindFrame(const scene::Scene& scene);
    void drawFogAndSurfaces(const scene::Scene& scene, DepthRange depths);

    /// The surfaces of the nearer or of the farther slices, for drawing without OpenGL.
    struct NearOrFarSurfaces {
        SurfaceBatch batch;
        SurfaceRasterizer rasterizer;
    };

    parallel::ThreadOwnerAssertion owner;
    OffscreenGlContext context;          // declared before the members that need a current context
    const bool shapesInMemory;           // whether shapes are drawn without OpenGL where possible
    parallel::ForkJoin* const forkJoin;  // null if pictures are drawn with one thread
    ShapeRasterizer shapeRasterizer;
    ShapeProgram patchDepthProgram, surfaceDepthProgram;
    SurfaceProgram surfaceProgram;
    CoordinatesPlot coordinatesPlot;
    Overlay overlay;
    ShapeBatch shapes;
    ConvexShapeCollector convexCollector;
    NonconvexShapeCollector nonconvexCollector;
    NonconvexShapeCollector::Layers layers;
    ProjectionShapeCollector projectionCollector;
    ProjectionShapeCollector::Layers projectionLayers;
    SurfaceBatch surfaces;                           // of all slices, for drawing with OpenGL
    std::array<NearOrFarSurfaces, 2> surfaceHalves;  // of the nearer slices; of the farther slices
    std::optional<FogPainter> fogPainter;            // made for the first picture with fog
};

void Renderer::Impl::flushShapes() {
    patchDepthProgram.draw(shapes);
    context.flush();
    shapes.clear();
}

// Draws convex slices and the projection of the whole object with OpenGL.
void Renderer::Impl::drawConvexSlices(const scene::Scene& scene) {
    const auto painted = [this] {
        if (shapes.patches().size() >= kBatchPatches) flushShapes();
    };
    const auto paintProjection = [this, &scene] {
        flushShapes();
        projectionCollector.collect(scene, projectionLayers);
        glEnable(GL_DEPTH_TEST);
        // Clears only a part, because clearing the whole depth buffer would take longer than drawing the projection.
        clearDepth(areaOf(projectionLayers, scene.viewport));
        drawProjection(projectionLayers.depths);
        glDisable(GL_DEPTH_TEST);
    };
    convexCollector.collect(scene, shapes, painted, paintProjection);
}

// Prepares convex slices and the projection of the whole object for drawing without OpenGL: collects the slices in
// `shapes`, and adds the slices that are farther than the projection, and then the projection, to the rasterizer.
// Returns the index of the first patch of `shapes` that is not added; the caller must add the patches from there on. If
// the projection is not shown, adds nothing to the rasterizer and returns 0.
std::size_t Renderer::Impl::addConvexSlices(const scene::Scene& scene) {
    using DepthUse = ShapeRasterizer::DepthUse;
    std::size_t nearer = 0;
    const auto paintSlices = [&] {
        convexCollector.collect(scene, shapes, [] {}, [&] { nearer = shapes.patches().size(); });
    };
    if (!scene.projectionPlacement.shown) {
        paintSlices();
        return 0;
    }
    const auto paintProjection = [&] { projectionCollector.collect(scene, projectionLayers); };
    parallel::invoke(forkJoin, std::ref(paintSlices), std::ref(paintProjection));
    shapeRasterizer.setDepthArea(areaOf(projectionLayers, scene.viewport));
    shapeRasterizer.add(shapes, 0, nearer, DepthUse::unused);
    const auto& [solid, translucent, depths] = projectionLayers;
    shapeRasterizer.add(solid, 0, solid.patches().size(), DepthUse::written);
    shapeRasterizer.add(translucent, 0, translucent.patches().size(), DepthUse::tested);
    return nearer;
}

// Prepares slices that may be nonconvex, surfaces and, if shown, the projection of the whole object for drawing without
// OpenGL: adds them to the rasterizer in the order in which drawLayers() draws them.
void Renderer::Impl::addLayers(const scene::Scene& scene) {
    using DepthUse = ShapeRasterizer::DepthUse;
    using Blending = SurfaceRasterizer::Blending;
    auto& [near, far] = surfaceHalves;
    const auto prepare = [&](NearOrFarSurfaces& pass, SurfaceBatch::DepthHalf half) {
        DepthRange depths;  // collect() writes it, but only drawing with OpenGL reads it
        pass.batch.collect(scene, depths, half);
        pass.rasterizer.projectAndLight(scene.viewport, scene.style(), pass.batch);
    };
    const auto prepareNear = [&] {
        prepare(near, SurfaceBatch::DepthHalf::near);
        nonconvexCollector.collect(scene, layers);
    };
    const auto prepareFar = [&] {
        prepare(far, SurfaceBatch::DepthHalf::far);
        if (scene.projectionPlacement.shown) projectionCollector.collect(scene, projectionLayers);
    };
    parallel::invoke(forkJoin, std::ref(prepareNear), std::ref(prepareFar));

    shapeRasterizer.setDepthArea({{0, 0}, {scene.viewport.width, scene.viewport.height}});
    const auto opaque = [](const NearOrFarSurfaces& pass) { return std::span(pass.batch.opaqueIndices()); };
    const auto add = [this](const ShapeBatch& batch, DepthUse depth) {
        shapeRasterizer.add(batch, 0, batch.patches().size(), depth);
    };
    add(layers.faces, DepthUse::written);
    for (const NearOrFarSurfaces* pass : {&near, &far})
        shapeRasterizer.add(pass->rasterizer, opaque(*pass).first(pass->batch.fringesBegin()), Blending::none);
    for (const NearOrFarSurfaces* pass : {&near, &far})
        shapeRasterizer.add(pass->rasterizer, opaque(*pass).subspan(pass->batch.fringesBegin()), Blending::alpha);
    add(layers.skeleton, DepthUse::written);
    if (scene.projectionPlacement.shown) {
        add(projectionLayers.solid, DepthUse::written);
        add(projectionLayers.translucent, DepthUse::tested);
    }
    for (const NearOrFarSurfaces* pass : {&far, &near})
        shapeRasterizer.add(pass->rasterizer, pass->batch.translucentIndices(), Blending::alpha);
    add(layers.faded, DepthUse::tested);
}

// Uses OpenGL to draw slices that may be nonconvex, surfaces, fog and, if shown, the projection of the whole object.
void Renderer::Impl::drawLayers(const scene::Scene& scene) {
    DepthRange depths = layers.depths;
    surfaces.collect(scene, depths);
    if (scene.projectionPlacement.shown) {
        projectionCollector.collect(scene, projectionLayers);
        const DepthRange more = projectionLayers.depths;
        depths = {std::min(depths.from, more.from), std::max(depths.to, more.to)};
    }
    glEnable(GL_DEPTH_TEST);
    glClear(GL_DEPTH_BUFFER_BIT);
    const bool hasFog = !scene.fog.empty();
    if (hasFog) prepareFog(scene, depths);
    glDisable(GL_BLEND);
    patchDepthProgram.drawWithDepth(depths, layers.faces);
    surfaceProgram.load(depths, surfaces, surfaces.opaqueIndices());
    surfaceProgram.drawPart(0, surfaces.fringesBegin());
    context.flush();
    glEnable(GL_BLEND);
    glDepthMask(GL_FALSE);
    surfaceProgram.drawPart(surfaces.fringesBegin(), surfaces.opaqueIndices().size());
    glDepthMask(GL_TRUE);
    if (hasFog) drawFogBehindFrame(scene);
    surfaceDepthProgram.drawWithDepth(depths, layers.skeleton);
    if (scene.projectionPlacement.shown) drawProjection(depths);
    glDepthMask(GL_FALSE);
    if (hasFog) {
        drawFogAndSurfaces(scene, depths);
    } else {
        surfaceProgram.draw(depths, surfaces, surfaces.translucentIndices());
    }
    surfaceDepthProgram.drawWithDepth(depths, layers.faded);
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);
}

// Prepares for drawing fog: loads the lattices of the slices, and copies the depths of opaque balls and bars to the fog
// painter. Leaves the depth buffer cleared.
void Renderer::Impl::prepareFog(const scene::Scene& scene, DepthRange depths) {
    if (!fogPainter) fogPainter.emplace();
    fogPainter->begin(scene, depths);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    surfaceDepthProgram.drawWithDepth(depths, layers.skeleton);
    if (scene.projectionPlacement.shown) surfaceDepthProgram.drawWithDepth(depths, projectionLayers.solid);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    fogPainter->copyDepths(scene.viewport, FogPainter::FogOccluders::frame);
    glClear(GL_DEPTH_BUFFER_BIT);
}

// Draws the fog behind balls and bars. Must be called when the opaque surfaces, but no balls and bars, have been drawn.
void Renderer::Impl::drawFogBehindFrame(const scene::Scene& scene) {
    fogPainter->copyDepths(scene.viewport, FogPainter::FogOccluders::surfaces);
    for (const SurfaceBatch::Place& place : surfaces.placesFarToNear()) {
        if (!place.isProjection) fogPainter->draw(scene, place.slice, FogPainter::FogPart::behind);
    }
}

// Draws, slice by slice from far to near, first the slice's translucent surfaces and then its fog. The projection of
// the whole object shows no fog.
void Renderer::Impl::drawFogAndSurfaces(const scene::Scene& scene, DepthRange depths) {
    surfaceProgram.load(depths, surfaces, surfaces.translucentIndices());
    std::size_t begin = 0;
    for (std::size_t i = 0; i < surfaces.placesFarToNear().size(); ++i) {
        const std::size_t end = surfaces.translucentEnds()[i];
        surfaceProgram.drawPart(begin, end);
        const SurfaceBatch::Place& place = surfaces.placesFarToNear()[i];
        if (!place.isProjection) fogPainter->draw(scene, place.slice, FogPainter::FogPart::in_front);
        begin = end;
    }
}

// Draws the projection of the whole object from projectionLayers. The depth test must be enabled.
void Renderer::Impl::drawProjection(DepthRange depths) {
    surfaceDepthProgram.drawWithDepth(depths, projectionLayers.solid);
    context.flush();
    glDepthMask(GL_FALSE);
    surfaceDepthProgram.drawWithDepth(depths, projectionLayers.translucent);
    glDepthMask(GL_TRUE);
}

Renderer::Renderer(const std::string& font, ShapeBackend drawing, parallel::ForkJoin* forkJoin) {
    {
        const auto lock = lockDriver();
        impl_ = std::make_unique<Impl>(font, drawing, forkJoin);
    }
    // Mesa finishes compiling a shader only at its first draw call. Therefore an empty scene is drawn now.
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
    impl_->shapeRasterizer.freeMemory();
    impl_->convexCollector = {};
    impl_->nonconvexCollector = {};
    impl_->layers = {};
    impl_->projectionCollector = {};
    impl_->projectionLayers = {};
    impl_->surfaces = {};
    impl_->surfaceHalves = {};
    if (impl_->fogPainter) impl_->fogPainter->freeMemory();
}

void Renderer::draw(const scene::Scene& scene, image::Image& out) {
    out.width = scene.viewport.width;
    out.height = scene.viewport.height;
    out.pixels.resize(image::byteCount(scene.viewport.width, scene.viewport.height));
    draw(scene, std::span(out.pixels));
}

void Renderer::draw(const scene::Scene& scene, std::span<std::uint8_t> pixels) {
    if (pixels.size() != image::byteCount(scene.viewport.width, scene.viewport.height))
        throw std::invalid_argument("the pixel buffer does not have the size of the viewport");
    ShapeBatch& shapes = impl_->shapes;
    Overlay& overlay = impl_->overlay;
    impl_->owner.assertOwner();
    const auto lock = lockDriver();
    impl_->context.begin(scene.viewport.width, scene.viewport.height, pixels.data());

    shapes.begin(scene.style());
    overlay.begin(scene.viewport);
    const bool inMemory =
        impl_->shapesInMemory && !needsOpenGl(scene) && scene.viewport.width >= ShapeRasterizer::kMinWidth;
    std::size_t notAdded = 0;  // the first patch of `shapes` that is not yet added to the rasterizer
    if (inMemory) {
        impl_->shapeRasterizer.begin(scene.viewport, scene.style(), pixels);
        if (scene.needsDepthBuffer) {
            impl_->addLayers(scene);
        } else {
            notAdded = impl_->addConvexSlices(scene);
        }
    } else {
        setClearColor(scene.style());
        glClear(GL_COLOR_BUFFER_BIT);
    }
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // colors are premultiplied by alpha, because blending is then cheaper
    if (scene.needsDepthBuffer && !inMemory) {
        impl_->nonconvexCollector.collect(scene, impl_->layers);
        impl_->drawLayers(scene);
    } else if (!inMemory) {
        impl_->drawConvexSlices(scene);
    }
    addAxes(scene, shapes, overlay);
    addCoordinates(scene, overlay);
    addLabels(scene, overlay);
    addMatrixAndFocusLines(scene, overlay);

    if (inMemory) {
        impl_->shapeRasterizer.add(shapes, notAdded, shapes.patches().size(), ShapeRasterizer::DepthUse::unused);
        impl_->shapeRasterizer.finish(impl_->forkJoin);
        impl_->context.replacePicture(pixels.data());
    } else {
        impl_->patchDepthProgram.draw(shapes);
    }
    clearCoordinatesArea(scene);
    impl_->coordinatesPlot.draw(scene);
    overlay.draw();
    impl_->context.finish();
}

}  // namespace oval4d::render
