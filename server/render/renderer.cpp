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

std::string defaultFontPath() {
    const char* file = std::getenv("OVAL4D_FONT");
    return file != nullptr && *file != '\0' ? file : OVAL4D_FONT;
}

namespace {

// The minimum size of a batch of patches (flat polygons, see shape_batch.hpp) when convex slices are drawn with OpenGL.
// Only the last batch may be smaller. While the threads of the driver rasterize one batch, this thread prepares the
// next batch.
constexpr std::size_t kBatchPatches = 2'000;

// If a projection has fewer shapes than this, the thread that prepares the slices also prepares the projection. Waking
// another thread would take about as long as preparing it.
constexpr std::size_t kFewShapes = 500;

/// Returns a lock that every use of Mesa must hold, because all contexts of a process share state. A context that draws
/// reads data of the other contexts: the scenes of llvmpipe, Mesa's rasterizer (see llvmpipe_is_resource_referenced in
/// Mesa). In Mesa 22.3, another thread may free these scenes at the same time.
std::unique_lock<std::mutex> lockDriver() {
    static std::mutex driver;
    return std::unique_lock(driver);
}

/// Returns whether several threads may draw a picture. The environment variable LP_NUM_THREADS sets the number of
/// threads of llvmpipe, Mesa's rasterizer. If it is 0 or 1, a second thread for drawing without OpenGL is forbidden,
/// too.
bool mayUseThreads() {
    const char* threads = std::getenv("LP_NUM_THREADS");
    return threads == nullptr || std::atoi(threads) > 1;
}

/// Returns whether the slices have fog, which can be drawn only with OpenGL.
bool needsOpenGl(const scene::Scene& scene) { return !scene.fog.empty(); }

/// Sets the color with which OpenGL clears pictures: the background color multiplied by the opacity of the background.
void setClearColor(const scene::PictureStyle& style) {
    const auto alpha = static_cast<float>(style.backgroundOpacity);
    const auto channel = [&](int shift) { return alpha * static_cast<float>(style.background >> shift & 255) / 255; };
    glClearColor(channel(16), channel(8), channel(0), alpha);
}

/// If the viewer has moved the camera, clears the part of the picture that belongs to the parallel coordinates, because
/// slices may extend into this part.
void clearCoordinatesArea(const scene::Scene& scene) {
    if (!scene.clearsCoordinatesArea()) return;
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, scene.viewport.width,
              static_cast<int>(std::lround(scene.coordinates.top() * scene.viewport.height)));
    setClearColor(scene.style());
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
}

/// Clears the part `area` of the depth buffer of OpenGL.
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
    void addProjectionToRasterizer();
    void drawProjectionWithOpenGl(const scene::Scene& scene);
    void prepareConvexSlicesForRasterizer(const scene::Scene& scene);
    void drawConvexSlicesWithOpenGl(const scene::Scene& scene);
    void addNonconvexSlicesToRasterizer(const scene::Scene& scene);
    void drawNonconvexSlicesWithOpenGl(const scene::Scene& scene);
    void drawOpaqueSurfaces(DepthRange depths);
    void prepareFog(const scene::Scene& scene, DepthRange depths);
    void drawFogBehindSkeleton(const scene::Scene& scene);
    void drawFogAndSurfaces(const scene::Scene& scene, DepthRange depths);

    /// The surfaces of some slices, prepared for drawing without OpenGL.
    struct SoftwareDrawnSurfaces {
        SurfaceBatch batch;
        SurfaceRasterizer rasterizer;

        void prepare(const scene::Scene& scene, SurfaceBatch::SliceSelection selection) {
            DepthRange depths;  // a range of depths that collect() writes, but only drawing with OpenGL reads
            batch.collect(scene, depths, selection);
            rasterizer.projectAndLight(scene.viewport, scene.style(), batch);
        }
        std::span<const std::uint32_t> opaqueIndices() const {
            return std::span(batch.opaqueIndices()).first(batch.antialiasingFringesBegin());
        }
        std::span<const std::uint32_t> antialiasingFringes() const {
            return std::span(batch.opaqueIndices()).subspan(batch.antialiasingFringesBegin());
        }
        std::span<const std::uint32_t> translucentIndices() const { return batch.translucentIndices(); }
    };

    parallel::ThreadOwnerAssertion owner;
    OffscreenGlContext context;          // declared before the members that need a current context
    const bool shapesInMemory;           // whether shapes are drawn without OpenGL where this is possible
    parallel::ForkJoin* const forkJoin;  // null if only one thread draws pictures
    ShapeRasterizer shapeRasterizer;
    ShapeProgram patchDepthProgram, surfaceDepthProgram;
    SurfaceProgram surfaceProgram;
    DensityStripOrHistogramPainter coordinatesPlot;
    Overlay overlay;
    ShapeBatch shapes, strokes;  // `strokes` is drawn over everything else, without OpenGL
    ConvexShapeCollector convexCollector;
    NonconvexShapeCollector nonconvexCollector;
    NonconvexShapeCollector::Layers layers;
    ProjectionShapeCollector projectionCollector;
    ProjectionShapeCollector::Layers projectionLayers;
    SurfaceBatch surfaces;  // the surfaces of the projection, and later those of all slices, for drawing with OpenGL
    // The surfaces of the nearer slices, and those of the farther slices.
    std::array<SoftwareDrawnSurfaces, 2> surfaceHalves;
    SoftwareDrawnSurfaces projectionSurfaces;
    std::optional<FogPainter> fogPainter;  // created for the first picture with fog
};

void Renderer::Impl::flushShapes() {
    patchDepthProgram.draw(shapes);
    context.flush();
    shapes.clear();
}

// Returns the part of the picture in which the depth buffer must be cleared for the projection of the whole object,
// which must have been collected. If the projection is small, clearing the whole depth buffer would take longer than
// drawing the projection.
PixelArea Renderer::Impl::depthAreaOfProjection(const scene::Scene& scene) const {
    if (scene.projection.focusSurface) return {{0, 0}, {scene.viewport.width, scene.viewport.height}};
    return projectionLayers.pixelArea(scene.viewport);
}

// Prepares the projection of the whole object for drawing without OpenGL.
void Renderer::Impl::prepareProjection(const scene::Scene& scene) {
    projectionCollector.collect(scene, projectionLayers);
    projectionSurfaces.prepare(scene, SurfaceBatch::SliceSelection::projection);
}

// Adds the projection of the whole object, which must have been prepared, to the rasterizer. The projection must never
// hide a slice. Therefore shapes that are added later must not be tested against the depths of the projection. Before
// the caller adds such shapes, it must add a clearing of the depth buffer, or it must add them with DepthUse::unused.
void Renderer::Impl::addProjectionToRasterizer() {
    using DepthUse = ShapeRasterizer::DepthUse;
    using Blending = SurfaceRasterizer::Blending;
    const auto& [solid, translucent, depths] = projectionLayers;
    const SoftwareDrawnSurfaces& own = projectionSurfaces;
    shapeRasterizer.add(own.rasterizer, own.opaqueIndices(), Blending::none);
    shapeRasterizer.add(own.rasterizer, own.antialiasingFringes(), Blending::alpha);
    shapeRasterizer.add(solid, DepthUse::written);
    shapeRasterizer.add(translucent, DepthUse::tested);
    shapeRasterizer.add(own.rasterizer, own.translucentIndices(), Blending::alpha);
}

// Draws the projection of the whole object with OpenGL, if the scene shows it. Leaves the depths of the projection in
// the depth buffer. The projection must never hide a slice. Therefore the caller must clear these depths before it
// draws slices with the depth test.
void Renderer::Impl::drawProjectionWithOpenGl(const scene::Scene& scene) {
    if (!scene.projectionPlacement.shown) return;
    projectionCollector.collect(scene, projectionLayers);
    DepthRange depths = projectionLayers.depths;
    surfaces.collect(scene, depths, SurfaceBatch::SliceSelection::projection);
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
void Renderer::Impl::drawConvexSlicesWithOpenGl(const scene::Scene& scene) {
    const auto painted = [this] {
        if (shapes.patches().size() >= kBatchPatches) flushShapes();
    };
    convexCollector.collect(scene, shapes, painted);
}

// Prepares convex slices and, if the scene shows it, the projection of the whole object for drawing without OpenGL.
// Adds the projection to the rasterizer. Collects the slices in `shapes`, which the caller must then add.
void Renderer::Impl::prepareConvexSlicesForRasterizer(const scene::Scene& scene) {
    const auto collectSlices = [&] { convexCollector.collect(scene, shapes, [] {}); };
    if (!scene.projectionPlacement.shown) return collectSlices();
    const auto collectProjection = [&] { prepareProjection(scene); };
    const slicing::SliceSet& elements = scene.projection.elements;
    const std::size_t count = elements.vertices.size() + elements.edges.size() + elements.faceSource.size();
    parallel::invoke(count < kFewShapes ? nullptr : forkJoin, std::ref(collectSlices), std::ref(collectProjection));
    shapeRasterizer.setDepthArea(depthAreaOfProjection(scene));
    addProjectionToRasterizer();
}

// Prepares slices that may be nonconvex, surfaces and, if the scene shows it, the projection of the whole object for
// drawing without OpenGL. Adds them to the rasterizer in the order in which drawProjectionWithOpenGl() and
// drawNonconvexSlicesWithOpenGl() draw them.
void Renderer::Impl::addNonconvexSlicesToRasterizer(const scene::Scene& scene) {
    using DepthUse = ShapeRasterizer::DepthUse;
    using Blending = SurfaceRasterizer::Blending;
    auto& [near, far] = surfaceHalves;
    const auto prepareNear = [&] {
        near.prepare(scene, SurfaceBatch::SliceSelection::nearer_slices);
        nonconvexCollector.collect(scene, layers);
    };
    const auto prepareFar = [&] {
        far.prepare(scene, SurfaceBatch::SliceSelection::farther_slices);
        if (scene.projectionPlacement.shown) prepareProjection(scene);
    };
    parallel::invoke(forkJoin, std::ref(prepareNear), std::ref(prepareFar));

    shapeRasterizer.setDepthArea({{0, 0}, {scene.viewport.width, scene.viewport.height}});
    if (scene.projectionPlacement.shown) {
        addProjectionToRasterizer();
        shapeRasterizer.addDepthClearing(depthAreaOfProjection(scene));
    }
    shapeRasterizer.add(layers.faces, DepthUse::written);
    for (const SoftwareDrawnSurfaces* pass : {&near, &far})
        shapeRasterizer.add(pass->rasterizer, pass->opaqueIndices(), Blending::none);
    for (const SoftwareDrawnSurfaces* pass : {&near, &far})
        shapeRasterizer.add(pass->rasterizer, pass->antialiasingFringes(), Blending::alpha);
    shapeRasterizer.add(layers.skeleton, DepthUse::written);
    for (const SoftwareDrawnSurfaces* pass : {&far, &near})
        shapeRasterizer.add(pass->rasterizer, pass->translucentIndices(), Blending::alpha);
    shapeRasterizer.add(layers.faded, DepthUse::tested);
}

// Draws slices that may be nonconvex, surfaces and fog, with OpenGL.
void Renderer::Impl::drawNonconvexSlicesWithOpenGl(const scene::Scene& scene) {
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
    if (hasFog) drawFogBehindSkeleton(scene);
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

// Draws the opaque surfaces in `surfaces`. The depth test must be enabled. Leaves blending enabled.
void Renderer::Impl::drawOpaqueSurfaces(DepthRange depths) {
    glDisable(GL_BLEND);
    surfaceProgram.uploadTriangles(depths, surfaces, surfaces.opaqueIndices());
    surfaceProgram.drawIndexRange(0, surfaces.antialiasingFringesBegin());
    context.flush();
    glEnable(GL_BLEND);
    glDepthMask(GL_FALSE);
    surfaceProgram.drawIndexRange(surfaces.antialiasingFringesBegin(), surfaces.opaqueIndices().size());
    glDepthMask(GL_TRUE);
}

// Prepares for drawing fog: loads the fog lattices of the slices, and copies the depths of opaque balls and bars to the
// fog painter. Leaves the depth buffer cleared.
void Renderer::Impl::prepareFog(const scene::Scene& scene, DepthRange depths) {
    if (!fogPainter) fogPainter.emplace();
    fogPainter->begin(scene, depths);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    surfaceDepthProgram.drawWithDepth(depths, layers.skeleton);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    fogPainter->copyOccluderDepths(scene.viewport, FogPainter::FogOccluders::frame);
    glClear(GL_DEPTH_BUFFER_BIT);
}

// Draws the fog behind balls and bars. The opaque surfaces must have been drawn before, but no balls and bars.
void Renderer::Impl::drawFogBehindSkeleton(const scene::Scene& scene) {
    fogPainter->copyOccluderDepths(scene.viewport, FogPainter::FogOccluders::surfaces);
    for (const SurfaceBatch::SurfacePlacement& place : surfaces.slicesFarToNear())
        fogPainter->draw(scene, place.slice, FogPainter::FogPart::behind);
}

// Draws the translucent surfaces and the fog of the slices, from the farthest slice to the nearest: in each slice,
// first the surfaces and then the fog.
void Renderer::Impl::drawFogAndSurfaces(const scene::Scene& scene, DepthRange depths) {
    surfaceProgram.uploadTriangles(depths, surfaces, surfaces.translucentIndices());
    std::size_t begin = 0;
    for (std::size_t i = 0; i < surfaces.slicesFarToNear().size(); ++i) {
        const std::size_t end = surfaces.translucentEnds()[i];
        surfaceProgram.drawIndexRange(begin, end);
        fogPainter->draw(scene, surfaces.slicesFarToNear()[i].slice, FogPainter::FogPart::in_front);
        begin = end;
    }
}

Renderer::Renderer(const std::string& font, ShapeBackend drawing, parallel::ForkJoin* forkJoin) {
    {
        const auto lock = lockDriver();
        impl_ = std::make_unique<Impl>(font, drawing, forkJoin);
    }
    // Mesa finishes compiling a shader only when the shader first draws. Therefore an empty scene is drawn now.
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
    strokes.setProjection(ViewProjection::fromCamera(scene.camera, scene.viewport));
    overlay.begin(scene.viewport);
    const bool inMemory =
        impl_->shapesInMemory && !needsOpenGl(scene) && scene.viewport.width >= ShapeRasterizer::kMinWidth;
    if (inMemory) {
        impl_->shapeRasterizer.begin(scene.viewport, scene.style(), pixels);
        if (scene.needsDepthBuffer) {
            impl_->addNonconvexSlicesToRasterizer(scene);
        } else {
            impl_->prepareConvexSlicesForRasterizer(scene);
        }
    } else {
        setClearColor(scene.style());
        glClear(GL_COLOR_BUFFER_BIT);
    }
    glEnable(GL_BLEND);
    // Colors are multiplied by alpha beforehand, because blending is then cheaper.
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    // The projection of the whole object must never cover a slice, wherever the viewer moves the camera. So it is drawn
    // before the slices, and slices are not tested against its depths.
    if (!inMemory) {
        impl_->drawProjectionWithOpenGl(scene);
        if (scene.needsDepthBuffer) {
            impl_->drawNonconvexSlicesWithOpenGl(scene);
        } else {
            impl_->drawConvexSlicesWithOpenGl(scene);
        }
    }
    addAxesSymbol(scene, shapes, overlay);
    addCoordinatesOverlay(scene, overlay,
                          {.below = inMemory && !scene.clearsCoordinatesArea() ? &shapes : nullptr,
                           .above = inMemory ? &strokes : nullptr});
    addLabels(scene, overlay);
    addMatrixAndFocusLines(scene, overlay);

    if (inMemory) {
        impl_->shapeRasterizer.add(shapes, ShapeRasterizer::DepthUse::unused);
        impl_->shapeRasterizer.drawAdded(impl_->forkJoin);
        impl_->context.replacePicture(pixels.data());
    } else {
        impl_->patchDepthProgram.draw(shapes);
    }
    clearCoordinatesArea(scene);
    impl_->coordinatesPlot.drawStripOrHistogram(scene);
    overlay.draw();
    impl_->context.readPixels();
    if (strokes.patches().empty()) return;
    impl_->shapeRasterizer.beginOverPicture(scene.viewport, scene.style(), pixels);
    impl_->shapeRasterizer.add(strokes, ShapeRasterizer::DepthUse::unused);
    impl_->shapeRasterizer.drawAdded(nullptr);  // on one thread, because waking a second thread would take longer
}

}  // namespace oval4d::render
