#include "render/renderer.hpp"

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
// last batch may be smaller. While the threads of the driver rasterize one batch, this thread prepares the next one.
constexpr std::size_t kBatchPatches = 2'000;

// A projection with fewer shapes than this is prepared by the thread that prepares the slices: waking another thread
// would take about as long.
constexpr std::size_t kFewShapes = 500;

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
    PixelArea depthAreaOfProjection(const scene::Scene& scene) const;
    void prepareProjection(const scene::Scene& scene);
    void addProjection();
    void drawProjection(const scene::Scene& scene);
    void addConvexSlices(const scene::Scene& scene);
    void drawConvexSlices(const scene::Scene& scene);
    void addLayers(const scene::Scene& scene);
    void drawLayers(const scene::Scene& scene);
    void drawOpaqueSurfaces(DepthRange depths);
    void prepareFog(const scene::Scene& scene, DepthRange depths);
    void drawFogBehindFrame(const scene::Scene& scene);
    void drawFogAndSurfaces(const scene::Scene& scene, DepthRange depths);

    /// Surfaces for drawing without OpenGL.
    struct SurfacesInMemory {
        SurfaceBatch batch;
        SurfaceRasterizer rasterizer;

        void prepare(const scene::Scene& scene, SurfaceBatch::Selection selection) {
            DepthRange depths;  // collect() writes it, but only drawing with OpenGL reads it
            batch.collect(scene, depths, selection);
            rasterizer.projectAndLight(scene.viewport, scene.style(), batch);
        }
        std::span<const std::uint32_t> opaque() const {
            return std::span(batch.opaqueIndices()).first(batch.fringesBegin());
        }
        std::span<const std::uint32_t> fringes() const {
            return std::span(batch.opaqueIndices()).subspan(batch.fringesBegin());
        }
        std::span<const std::uint32_t> translucent() const { return batch.translucentIndices(); }
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
    ShapeBatch shapes, strokes;  // `strokes` are drawn without OpenGL over everything else
    ConvexShapeCollector convexCollector;
    NonconvexShapeCollector nonconvexCollector;
    NonconvexShapeCollector::Layers layers;
    ProjectionShapeCollector projectionCollector;
    ProjectionShapeCollector::Layers projectionLayers;
    SurfaceBatch surfaces;                          // of the projection and then of all slices, for drawing with OpenGL
    std::array<SurfacesInMemory, 2> surfaceHalves;  // of the nearer slices; of the farther slices
    SurfacesInMemory projectionSurfaces;
    std::optional<FogPainter> fogPainter;  // made for the first picture with fog
};

void Renderer::Impl::flushShapes() {
    patchDepthProgram.draw(shapes);
    context.flush();
    shapes.clear();
}

// Returns a part of the picture that contains the projection of the whole object, which must have been collected. Where
// it is small, clearing the whole depth buffer would take longer than drawing the projection.
PixelArea Renderer::Impl::depthAreaOfProjection(const scene::Scene& scene) const {
    if (scene.projection.focusSurface) return {{0, 0}, {scene.viewport.width, scene.viewport.height}};
    return projectionLayers.pixelArea(scene.viewport);
}

// Prepares the projection of the whole object for drawing without OpenGL.
void Renderer::Impl::prepareProjection(const scene::Scene& scene) {
    projectionCollector.collect(scene, projectionLayers);
    projectionSurfaces.prepare(scene, SurfaceBatch::Selection::projection);
}

// Adds the projection of the whole object, which must have been prepared, to the rasterizer. So that the projection
// never hides a slice, what is added later must not be tested against its depths: the caller adds a clearing of the
// depth buffer first, or uses DepthUse::unused.
void Renderer::Impl::addProjection() {
    using DepthUse = ShapeRasterizer::DepthUse;
    using Blending = SurfaceRasterizer::Blending;
    const auto& [solid, translucent, depths] = projectionLayers;
    const SurfacesInMemory& own = projectionSurfaces;
    shapeRasterizer.add(own.rasterizer, own.opaque(), Blending::none);
    shapeRasterizer.add(own.rasterizer, own.fringes(), Blending::alpha);
    shapeRasterizer.add(solid, DepthUse::written);
    shapeRasterizer.add(translucent, DepthUse::tested);
    shapeRasterizer.add(own.rasterizer, own.translucent(), Blending::alpha);
}

// Draws the projection of the whole object with OpenGL, if it is shown. Leaves the depths of the projection in the
// depth buffer. So that the projection never hides a slice, the caller must clear them before it draws slices with the
// depth test.
void Renderer::Impl::drawProjection(const scene::Scene& scene) {
    if (!scene.projectionPlacement.shown) return;
    projectionCollector.collect(scene, projectionLayers);
    DepthRange depths = projectionLayers.depths;
    surfaces.collect(scene, depths, SurfaceBatch::Selection::projection);
    glEnable(GL_DEPTH_TEST);
    clearDepth(depthAreaOfProjection(scene));
    drawOpaqueSurfaces(depths);
    surfaceDepthProgram.drawWithDepth(depths, projectionLayers.solid);
    context.flush();
    glDepthMask(GL_FALSE);
    surfaceDepthProgram.drawWithDepth(depths, projectionLayers.translucent);
    surfaceProgram.draw(depths, surfaces, surfaces.translucentIndices());
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);
}

// Draws convex slices with OpenGL, without a depth buffer.
void Renderer::Impl::drawConvexSlices(const scene::Scene& scene) {
    const auto painted = [this] {
        if (shapes.patches().size() >= kBatchPatches) flushShapes();
    };
    convexCollector.collect(scene, shapes, painted);
}

// Prepares convex slices and, if shown, the projection of the whole object for drawing without OpenGL: adds the
// projection to the rasterizer, and collects the slices in `shapes`, which the caller must add.
void Renderer::Impl::addConvexSlices(const scene::Scene& scene) {
    const auto collectSlices = [&] { convexCollector.collect(scene, shapes, [] {}); };
    if (!scene.projectionPlacement.shown) return collectSlices();
    const auto collectProjection = [&] { prepareProjection(scene); };
    const slicing::SliceSet& elements = scene.projection.elements;
    const std::size_t count = elements.vertices.size() + elements.edges.size() + elements.faceSource.size();
    parallel::invoke(count < kFewShapes ? nullptr : forkJoin, std::ref(collectSlices), std::ref(collectProjection));
    shapeRasterizer.setDepthArea(depthAreaOfProjection(scene));
    addProjection();
}

// Prepares slices that may be nonconvex, surfaces and, if shown, the projection of the whole object for drawing without
// OpenGL: adds them to the rasterizer in the order in which drawProjection() and drawLayers() draw them.
void Renderer::Impl::addLayers(const scene::Scene& scene) {
    using DepthUse = ShapeRasterizer::DepthUse;
    using Blending = SurfaceRasterizer::Blending;
    auto& [near, far] = surfaceHalves;
    const auto prepareNear = [&] {
        near.prepare(scene, SurfaceBatch::Selection::nearer_slices);
        nonconvexCollector.collect(scene, layers);
    };
    const auto prepareFar = [&] {
        far.prepare(scene, SurfaceBatch::Selection::farther_slices);
        if (scene.projectionPlacement.shown) prepareProjection(scene);
    };
    parallel::invoke(forkJoin, std::ref(prepareNear), std::ref(prepareFar));

    shapeRasterizer.setDepthArea({{0, 0}, {scene.viewport.width, scene.viewport.height}});
    if (scene.projectionPlacement.shown) {
        addProjection();
        shapeRasterizer.addDepthClearing(depthAreaOfProjection(scene));
    }
    shapeRasterizer.add(layers.faces, DepthUse::written);
    for (const SurfacesInMemory* pass : {&near, &far})
        shapeRasterizer.add(pass->rasterizer, pass->opaque(), Blending::none);
    for (const SurfacesInMemory* pass : {&near, &far})
        shapeRasterizer.add(pass->rasterizer, pass->fringes(), Blending::alpha);
    shapeRasterizer.add(layers.skeleton, DepthUse::written);
    for (const SurfacesInMemory* pass : {&far, &near})
        shapeRasterizer.add(pass->rasterizer, pass->translucent(), Blending::alpha);
    shapeRasterizer.add(layers.faded, DepthUse::tested);
}

// Uses OpenGL to draw slices that may be nonconvex, surfaces and fog.
void Renderer::Impl::drawLayers(const scene::Scene& scene) {
    nonconvexCollector.collect(scene, layers);
    DepthRange depths = layers.depths;
    surfaces.collect(scene, depths);
    glEnable(GL_DEPTH_TEST);
    glClear(GL_DEPTH_BUFFER_BIT);
    const bool hasFog = !scene.fog.empty();
    if (hasFog) prepareFog(scene, depths);
    glDisable(GL_BLEND);
    patchDepthProgram.drawWithDepth(depths, layers.faces);
    drawOpaqueSurfaces(depths);
    if (hasFog) drawFogBehindFrame(scene);
    surfaceDepthProgram.drawWithDepth(depths, layers.skeleton);
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

// Draws the opaque ones of `surfaces`. The depth test must be enabled. Leaves blending enabled.
void Renderer::Impl::drawOpaqueSurfaces(DepthRange depths) {
    glDisable(GL_BLEND);
    surfaceProgram.load(depths, surfaces, surfaces.opaqueIndices());
    surfaceProgram.drawPart(0, surfaces.fringesBegin());
    context.flush();
    glEnable(GL_BLEND);
    glDepthMask(GL_FALSE);
    surfaceProgram.drawPart(surfaces.fringesBegin(), surfaces.opaqueIndices().size());
    glDepthMask(GL_TRUE);
}

// Prepares for drawing fog: loads the lattices of the slices, and copies the depths of opaque balls and bars to the fog
// painter. Leaves the depth buffer cleared.
void Renderer::Impl::prepareFog(const scene::Scene& scene, DepthRange depths) {
    if (!fogPainter) fogPainter.emplace();
    fogPainter->begin(scene, depths);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    surfaceDepthProgram.drawWithDepth(depths, layers.skeleton);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    fogPainter->copyDepths(scene.viewport, FogPainter::FogOccluders::frame);
    glClear(GL_DEPTH_BUFFER_BIT);
}

// Draws the fog behind balls and bars. Must be called when the opaque surfaces, but no balls and bars, have been drawn.
void Renderer::Impl::drawFogBehindFrame(const scene::Scene& scene) {
    fogPainter->copyDepths(scene.viewport, FogPainter::FogOccluders::surfaces);
    for (const SurfaceBatch::Place& place : surfaces.placesFarToNear())
        fogPainter->draw(scene, place.slice, FogPainter::FogPart::behind);
}

// Draws, slice by slice from far to near, first the slice's translucent surfaces and then its fog.
void Renderer::Impl::drawFogAndSurfaces(const scene::Scene& scene, DepthRange depths) {
    surfaceProgram.load(depths, surfaces, surfaces.translucentIndices());
    std::size_t begin = 0;
    for (std::size_t i = 0; i < surfaces.placesFarToNear().size(); ++i) {
        const std::size_t end = surfaces.translucentEnds()[i];
        surfaceProgram.drawPart(begin, end);
        fogPainter->draw(scene, surfaces.placesFarToNear()[i].slice, FogPainter::FogPart::in_front);
        begin = end;
    }
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
    impl_->strokes = {};
    impl_->shapeRasterizer.freeMemory();
    impl_->convexCollector = {};
    impl_->nonconvexCollector = {};
    impl_->layers = {};
    impl_->projectionCollector = {};
    impl_->projectionLayers = {};
    impl_->surfaces = {};
    impl_->surfaceHalves = {};
    impl_->projectionSurfaces = {};
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

    ShapeBatch& strokes = impl_->strokes;
    shapes.begin(scene.style());
    strokes.begin(scene.style());
    strokes.setProjection(Projection::of(scene.camera, scene.viewport));
    overlay.begin(scene.viewport);
    const bool inMemory =
        impl_->shapesInMemory && !needsOpenGl(scene) && scene.viewport.width >= ShapeRasterizer::kMinWidth;
    if (inMemory) {
        impl_->shapeRasterizer.begin(scene.viewport, scene.style(), pixels);
        if (scene.needsDepthBuffer) {
            impl_->addLayers(scene);
        } else {
            impl_->addConvexSlices(scene);
        }
    } else {
        setClearColor(scene.style());
        glClear(GL_COLOR_BUFFER_BIT);
    }
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // colors are premultiplied by alpha, because blending is then cheaper
    // The projection is drawn before the slices, and slices are not tested against its depths, so that it never covers
    // a slice, wherever the viewer moves the camera.
    if (!inMemory) {
        impl_->drawProjection(scene);
        if (scene.needsDepthBuffer) {
            impl_->drawLayers(scene);
        } else {
            impl_->drawConvexSlices(scene);
        }
    }
    addAxes(scene, shapes, overlay);
    addCoordinates(scene, overlay,
                   {.below = inMemory && !scene.clearsCoordinatesArea() ? &shapes : nullptr,
                    .above = inMemory ? &strokes : nullptr});
    addLabels(scene, overlay);
    addMatrixAndFocusLines(scene, overlay);

    if (inMemory) {
        impl_->shapeRasterizer.add(shapes, ShapeRasterizer::DepthUse::unused);
        impl_->shapeRasterizer.finish(impl_->forkJoin);
        impl_->context.replacePicture(pixels.data());
    } else {
        impl_->patchDepthProgram.draw(shapes);
    }
    clearCoordinatesArea(scene);
    impl_->coordinatesPlot.draw(scene);
    overlay.draw();
    impl_->context.finish();
    if (strokes.patches().empty()) return;
    impl_->shapeRasterizer.beginOver(scene.viewport, scene.style(), pixels);
    impl_->shapeRasterizer.add(strokes, ShapeRasterizer::DepthUse::unused);
    impl_->shapeRasterizer.finish(nullptr);  // waking another thread would take longer
}

}  // namespace oval4d::render
