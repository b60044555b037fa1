#include "render/slices/shape_rasterizer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "render/color.hpp"
#include "render/slices/depth_buffer.hpp"
#include "render/slices/patch_drawing.hpp"

namespace oval4d::render {

#if defined(__x86_64__)

namespace {

using Form = Patch::Form;
using DepthUse = ShapeRasterizer::DepthUse;

// Writes to `out` the part of a convex polygon that is in front of the eye at a depth of at least kNearPlane.
void cutAtNearPlane(std::span<const ShapeVertex> vertices, std::vector<ShapeVertex>& out) {
    out.clear();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const ShapeVertex &a = vertices[i], &b = vertices[(i + 1) % vertices.size()];
        const bool keepA = a.clip.z >= kNearPlane, keepB = b.clip.z >= kNearPlane;
        if (keepA) out.push_back(a);
        if (keepA == keepB) continue;
        const float t = (kNearPlane - a.clip.z) / (b.clip.z - a.clip.z);
        out.push_back(a);
        out.back().clip = glm::mix(a.clip, b.clip, t);
        out.back().place = glm::mix(a.place, b.place, t);
    }
}

}  // namespace

struct ShapeRasterizer::Impl {
    /// The patches (flat polygons) or the triangles that one call of add() has added, or the clearing that one call of
    /// addDepthClearing() has added.
    struct AddedShapes {
        const ShapeBatch* shapes = nullptr;  // the patches; null if triangles or a clearing were added
        DepthUse depth = DepthUse::unused;
        // The surfaces of the triangles; null if patches or a clearing were added.
        const SurfaceRasterizer* surfaces = nullptr;
        std::span<const std::uint32_t> triangles = {};  // three indices of vertices for each triangle
        SurfaceRasterizer::Blending blending = SurfaceRasterizer::Blending::none;
        PixelArea cleared{{0, 0}, {0, 0}};  // for a clearing: where depths are cleared

        std::span<const Patch> patches() const {
            return shapes == nullptr ? std::span<const Patch>() : shapes->patches();
        }
    };
    /// Working memory for drawing some of the rows of the picture.
    struct Workspace {
        std::vector<int> left, right;
        std::vector<ShapeVertex> clipped;
        std::vector<PatchCorner> corners;
    };

    int meanRowOfShapes() const;
    void drawRows(const RowRange& rows, Workspace& workspace) const;
    void clearDepth(const RowRange& rows, const PixelArea& area) const;
    void drawPatches(const PatchCanvas& part, const AddedShapes& layer, Workspace& workspace) const;

    PatchCanvas canvas;
    std::uint32_t background = 0;
    bool keepsPicture = false;  // whether shapes are drawn over the picture that is already in memory
    PixelArea depthArea{{0, 0}, {0, 0}};
    std::vector<AddedShapes> layers;
    std::vector<float> nearness;
    std::array<Workspace, 2> workspaces;
};

ShapeRasterizer::ShapeRasterizer() : impl_(std::make_unique<Impl>()) {}

bool ShapeRasterizer::isSupported() {
    return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
}

void ShapeRasterizer::begin(scene::Viewport viewport, const scene::PictureStyle& style,
                            std::span<std::uint8_t> pixels) {
    impl_->canvas = {.width = viewport.width,
                     .height = viewport.height,
                     .pixels = reinterpret_cast<std::uint32_t*>(pixels.data()),
                     .ambient = static_cast<float>(style.ambient),
                     .gloss = static_cast<float>(255 * style.specular),
                     .shininess = static_cast<unsigned>(std::lround(style.shininess)),
                     .opaque = style.backgroundOpacity == 1};
    impl_->keepsPicture = false;
    impl_->background = impl_->canvas.opaque ? rgba(style.background, 1) : 0;
    impl_->depthArea = {{0, 0}, {0, 0}};
    impl_->layers.clear();
}

void ShapeRasterizer::beginOverPicture(scene::Viewport viewport, const scene::PictureStyle& style,
                                       std::span<std::uint8_t> pixels) {
    begin(viewport, style, pixels);
    impl_->keepsPicture = true;
}

void ShapeRasterizer::add(const ShapeBatch& shapes, DepthUse depth) {
    impl_->layers.push_back({.shapes = &shapes, .depth = depth});
}

void ShapeRasterizer::add(const SurfaceRasterizer& surfaces, std::span<const std::uint32_t> indices,
                          SurfaceRasterizer::Blending blending) {
    impl_->layers.push_back({.surfaces = &surfaces, .triangles = indices, .blending = blending});
}

void ShapeRasterizer::addDepthClearing(const PixelArea& area) { impl_->layers.push_back({.cleared = area}); }

void ShapeRasterizer::setDepthArea(const PixelArea& area) {
    Impl& m = *impl_;
    const glm::ivec2 size(m.canvas.width, m.canvas.height);
    m.depthArea.from = glm::clamp(area.from, glm::ivec2(0), size);
    m.depthArea.to = glm::clamp(area.to, m.depthArea.from, size);
    m.nearness.resize(static_cast<std::size_t>(m.canvas.width) * static_cast<std::size_t>(m.canvas.height));
    m.canvas.nearness = m.nearness.data();
}

void ShapeRasterizer::drawAdded(parallel::ForkJoin* forkJoin) {
    Impl& m = *impl_;
    const int height = m.canvas.height;
    if (forkJoin == nullptr) return m.drawRows({0, height}, m.workspaces[0]);
    const int middle = m.meanRowOfShapes();
    const auto drawLower = [&] { m.drawRows({0, middle}, m.workspaces[0]); };
    const auto drawUpper = [&] { m.drawRows({middle, height}, m.workspaces[1]); };
    forkJoin->invoke(std::ref(drawLower), std::ref(drawUpper));
}

// Returns the mean row of the shapes. The parts of the picture below and above this row take about the same time to
// draw.
int ShapeRasterizer::Impl::meanRowOfShapes() const {
    // The sum of the vertical positions of the shapes; 0 is the lower edge of the picture, and 1 the upper edge.
    double sum = 0;
    std::size_t count = 0;
    for (const AddedShapes& layer : layers) {
        for (const Patch& patch : layer.patches()) {
            if (patch.count == 0) continue;
            sum += 0.5 + 0.25 * (std::clamp(patch.least.y, -1.0F, 1.0F) + std::clamp(patch.greatest.y, -1.0F, 1.0F));
        }
        const std::size_t triangles = layer.triangles.size() / 3;
        if (triangles > 0) sum += layer.surfaces->estimateMeanScreenY(layer.triangles) * static_cast<double>(triangles);
        count += layer.patches().size() + triangles;
    }
    const double mean = count == 0 ? 0.5 : sum / static_cast<double>(count);
    return static_cast<int>(mean * canvas.height);
}

void ShapeRasterizer::Impl::drawRows(const RowRange& rows, Workspace& workspace) const {
    for (std::vector<int>* bounds : {&workspace.left, &workspace.right})
        bounds->resize(static_cast<std::size_t>(canvas.height) + PatchCanvas::kLanes);
    PatchCanvas part = canvas;
    part.rows = rows;
    part.left = workspace.left.data();
    part.right = workspace.right.data();
    const auto startOf = [&](int y) { return static_cast<std::ptrdiff_t>(y) * canvas.width; };
    if (!keepsPicture) std::fill(canvas.pixels + startOf(rows.begin), canvas.pixels + startOf(rows.end), background);
    clearDepth(rows, depthArea);
    for (const AddedShapes& layer : layers) {
        if (layer.shapes != nullptr) {
            drawPatches(part, layer, workspace);
        } else if (layer.surfaces == nullptr) {
            clearDepth(rows, layer.cleared);
        } else {
            layer.surfaces->draw({canvas.width, canvas.height, rows.begin, rows.end, canvas.pixels, canvas.nearness},
                                 layer.triangles, layer.blending);
        }
    }
}

// Clears the depths in the part of `area` that lies in these rows and in the depth area.
void ShapeRasterizer::Impl::clearDepth(const RowRange& rows, const PixelArea& area) const {
    const glm::ivec2 from = glm::max(area.from, depthArea.from), to = glm::min(area.to, depthArea.to);
    for (int y = std::max(rows.begin, from.y); from.x < to.x && y < std::min(rows.end, to.y); ++y) {
        float* const row = canvas.nearness + static_cast<std::ptrdiff_t>(y) * canvas.width;
        std::fill(row + from.x, row + to.x, 0.0F);
    }
}

void ShapeRasterizer::Impl::drawPatches(const PatchCanvas& part, const AddedShapes& layer, Workspace& workspace) const {
    const float pixelSize = 1 / layer.shapes->projection().focalLengthInPixels();
    // Only shapes between the heights `lower` and `upper` (from −1 to 1 in the picture) may touch the drawn rows. These
    // heights leave room for antialiased edges, for which corners are moved by a pixel.
    constexpr int kRoom = 2;
    const auto heightOf = [&](int row) { return 2 * static_cast<float>(row) / static_cast<float>(canvas.height) - 1; };
    const float lower = heightOf(part.rows.begin - kRoom), upper = heightOf(part.rows.end + kRoom);
    for (const Patch& patch : layer.patches()) {
        if (patch.greatest.y < lower || patch.least.y > upper) continue;
        std::span<const ShapeVertex> vertices = layer.shapes->vertices().subspan(patch.first, patch.count);
        if (std::ranges::any_of(vertices, [](const ShapeVertex& v) { return v.clip.z < kNearPlane; })) {
            cutAtNearPlane(vertices, workspace.clipped);
            vertices = workspace.clipped;
        }
        if (vertices.size() < 3) continue;
        workspace.corners.resize(vertices.size());
        drawPatch(part, vertices, workspace.corners, patch.form, layer.depth, pixelSize);
    }
}

void ShapeRasterizer::freeMemory() { *impl_ = {}; }

#else

struct ShapeRasterizer::Impl {};

ShapeRasterizer::ShapeRasterizer() = default;
bool ShapeRasterizer::isSupported() { return false; }
void ShapeRasterizer::begin(scene::Viewport /*viewport*/, const scene::PictureStyle& /*style*/,
                            std::span<std::uint8_t> /*pixels*/) {}
void ShapeRasterizer::beginOverPicture(scene::Viewport /*viewport*/, const scene::PictureStyle& /*style*/,
                                       std::span<std::uint8_t> /*pixels*/) {}
void ShapeRasterizer::add(const ShapeBatch& /*shapes*/, DepthUse /*depth*/) {}
void ShapeRasterizer::add(const SurfaceRasterizer& /*surfaces*/, std::span<const std::uint32_t> /*indices*/,
                          SurfaceRasterizer::Blending /*blending*/) {}
void ShapeRasterizer::setDepthArea(const PixelArea& /*area*/) {}
void ShapeRasterizer::addDepthClearing(const PixelArea& /*area*/) {}
void ShapeRasterizer::drawAdded(parallel::ForkJoin* /*forkJoin*/) {}
void ShapeRasterizer::freeMemory() {}

#endif

ShapeRasterizer::~ShapeRasterizer() = default;

}  // namespace oval4d::render
