#include "render/slices/surface_batch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <ranges>
#include <string>
#include <tuple>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "render/color.hpp"
#include "render/slices/slice_ref.hpp"

namespace oval4d::render {

namespace {

constexpr std::uint32_t kNone = 0xffffffffU;

}  // namespace

void SurfaceBatch::collect(const scene::Scene& scene, DepthRange& depths, SliceSelection selection) {
    vertices_.clear();
    opaqueIndices_.clear();
    fringes_.clear();
    fringesBegin_ = 0;
    translucentIndices_.clear();
    order_.clear();
    translucentEnds_.clear();
    if (scene.surfaces.empty() && scene.fog.empty()) return;
    projection_ = ViewProjection::fromCamera(scene.camera, scene.viewport);
    const glm::dmat4 toView = scene.camera.view();
    if (selection != SliceSelection::projection) {
        for (std::uint32_t slice = 0; slice < scene.placements.size(); ++slice)
            order_.push_back({slice, scene.placements[slice].position, scene.scale});
    } else if (scene.projectionPlacement.shown && scene.projection.focusSurface) {
        const auto& [slice, scale] = *scene.projection.focusSurface;
        order_.push_back({static_cast<std::uint32_t>(slice), scene.projectionPlacement.position, scale});
    }
    const auto depth = [&](const SurfacePlacement& place) { return -(toView * glm::dvec4(place.position, 1)).z; };
    std::ranges::sort(order_, std::greater<>(),
                      [&](const SurfacePlacement& place) { return std::tuple(depth(place), place.slice); });
    if (selection == SliceSelection::nearer_slices || selection == SliceSelection::farther_slices)
        keepOnlySlicesIn(scene, selection);
    const auto add = [&](const SurfacePlacement& place, bool opaque) {
        const std::uint32_t slice = place.slice;
        const slicing::SliceSurface& surface = scene.slices->surfaces[slice];
        if (!scene.placements[slice].drawn || surface.triangles.empty()) return;
        const SliceTransform transform(toView, place.position, place.scale);
        const glm::mat3 turn{glm::dmat3(toView)};
        points_.clear();
        normals_.clear();
        for (const glm::vec3& point : surface.points) {
            points_.push_back(transform(point));
            const float z = -points_.back().z;
            depths = {std::min(depths.from, z), std::max(depths.to, z)};
        }
        for (const glm::vec3& normal : surface.normals) normals_.push_back(turn * normal);
        for (const scene::SurfaceLook::LevelLook& level : scene.surfaces.levels) {
            if ((level.opacity == 1) == opaque) addLevel(scene, slice, level);
        }
    };
    if (!scene.surfaces.empty()) {
        for (const SurfacePlacement& place : order_ | std::views::reverse) add(place, true);
    }
    fringesBegin_ = opaqueIndices_.size();
    opaqueIndices_.insert(opaqueIndices_.end(), fringes_.begin(), fringes_.end());
    const bool isOpaque =
        std::ranges::all_of(scene.surfaces.levels, [](const auto& level) { return level.opacity == 1; });
    for (const SurfacePlacement& place : order_) {
        if (!isOpaque) add(place, false);
        translucentEnds_.push_back(translucentIndices_.size());
    }
}

// Removes from order_ the slices that do not belong to `half`, the nearer or the farther slices.
void SurfaceBatch::keepOnlySlicesIn(const scene::Scene& scene, SliceSelection half) {
    const auto triangles = [&](const SurfacePlacement& place) {
        return scene.placements[place.slice].drawn ? scene.slices->surfaces[place.slice].triangles.size() : 0;
    };
    std::size_t all = 0, farther = 0;
    for (const SurfacePlacement& place : order_) all += triangles(place);
    auto middle = order_.begin();
    while (middle != order_.end() && 2 * farther < all) farther += triangles(*middle++);
    if (half == SliceSelection::nearer_slices) {
        order_.erase(order_.begin(), middle);
    } else {
        order_.erase(middle, order_.end());
    }
}

// Adds the triangles of one level of a slice. points_ and normals_ must have the points and normals of the slice.
void SurfaceBatch::addLevel(const scene::Scene& scene, std::size_t slice, const scene::SurfaceLook::LevelLook& level) {
    const slicing::SliceSurface& surface = scene.slices->surfaces[slice];
    const auto alpha = static_cast<float>(level.opacity);
    const bool opaque = level.opacity == 1;
    // A closed surface hides its own triangles that face away from the eye. Only caps close a surface.
    const bool skipsBack = opaque && level.caps;
    std::vector<std::uint32_t>& out = opaque ? opaqueIndices_ : translucentIndices_;
    facing_.clear();
    front_.clear();
    if (skipsBack) touchesBack_.assign(surface.points.size(), 0);
    number_.assign(surface.points.size(), kNone);
    const auto vertex = [&](std::uint32_t point) {
        if (number_[point] == kNone) {
            number_[point] = static_cast<std::uint32_t>(vertices_.size());
            const glm::vec3& n = normals_[point];
            vertices_.push_back({projection_.clipXyw(points_[point]), glm::dot(n, points_[point]) > 0 ? -n : n,
                                 colorOf(scene, slice, level, false, point, alpha)});
        }
        return number_[point];
    };
    // Triangles of a cap that lie in the same wall of the domain share vertices. The normals of these triangles differ
    // only by rounding errors, which change a lit color by less than one step of 255. Where walls meet, each wall gets
    // vertices of its own.
    if (level.caps) capNumber_.assign(surface.points.size(), kNone);
    const auto capVertex = [&](std::uint32_t point, const glm::vec3& flat) {
        constexpr float kSame = 5e-4F;
        std::uint32_t& number = capNumber_[point];
        const bool isKnown = number != kNone && glm::length(vertices_[number].normal - flat) < kSame;
        if (!isKnown) {
            number = static_cast<std::uint32_t>(vertices_.size());
            vertices_.push_back(
                {projection_.clipXyw(points_[point]), flat, colorOf(scene, slice, level, true, point, alpha)});
        }
        return number;
    };
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        if (surface.levelIndex(t) != level.index || (surface.isCap(t) && !level.caps)) continue;
        const auto& [a, b, c] = surface.triangles[t];
        const glm::vec3 normal = glm::cross(points_[b] - points_[a], points_[c] - points_[a]);
        const bool isBack = glm::dot(normal, points_[a]) > 0;
        if (isBack && skipsBack) {
            for (const std::uint32_t point : {a, b, c}) touchesBack_[point] = 1;
            continue;
        }
        if (skipsBack) front_.push_back(static_cast<std::uint32_t>(t));
        std::vector<std::uint32_t>& indices = isBack ? out : facing_;
        if (surface.isCap(t)) {
            const glm::vec3 flat = glm::normalize(isBack ? -normal : normal);
            for (const std::uint32_t point : {a, b, c}) indices.push_back(capVertex(point, flat));
        } else {
            for (const std::uint32_t point : {a, b, c}) indices.push_back(vertex(point));
        }
    }
    out.insert(out.end(), facing_.begin(), facing_.end());
    if (skipsBack) addAntialiasingFringes(scene, slice, level);
}

std::uint32_t SurfaceBatch::colorOf(const scene::Scene& scene, std::size_t slice,
                                    const scene::SurfaceLook::LevelLook& level, bool ofCap, std::uint32_t point,
                                    float alpha) const {
    const scene::SurfaceLook& look = scene.surfaces;
    const slicing::SliceSurface& surface = scene.slices->surfaces[slice];
    if (ofCap)
        return rgba(look.colorsCapPoints() ? look.capPointColor(surface, point) : look.color(level, slice), alpha);
    return rgba(look.colorsPoints() ? look.pointColor(surface, point) : look.color(level, slice), alpha);
}

// Adds fringes to the level that addLevel() has just added: strips, one pixel wide, outside the silhouette of its
// surface in this slice. Their opacity falls outward to 0, which makes the silhouette look smooth.
void SurfaceBatch::addAntialiasingFringes(const scene::Scene& scene, std::size_t slice,
                                          const scene::SurfaceLook::LevelLook& level) {
    const slicing::SliceSurface& surface = scene.slices->surfaces[slice];
    findSilhouette(surface);
    outward_.resize(surface.points.size());
    for (const auto& [from, to, triangle] : silhouette_) outward_[from] = outward_[to] = glm::vec2(0);
    for (const auto& [from, to, triangle] : silhouette_) {
        const glm::vec2 way = projection_.pixel(points_[to]) - projection_.pixel(points_[from]);
        const float length = glm::length(way);
        if (!(length > 0)) continue;
        const glm::vec2 right = glm::vec2(way.y, -way.x) / length;
        outward_[from] += right;
        outward_[to] += right;
    }
    const glm::vec2 pixel(2 / projection_.width, 2 / projection_.height);
    for (const auto& [from, to, triangle] : silhouette_) {
        const bool isCap = surface.isCap(triangle);
        const auto& [a, b, c] = surface.triangles[triangle];
        const glm::vec3 flat = glm::normalize(glm::cross(points_[b] - points_[a], points_[c] - points_[a]));
        const auto first = static_cast<std::uint32_t>(vertices_.size());
        for (const std::uint32_t point : {from, to}) {
            const float length = glm::length(outward_[point]);
            const glm::vec2 out = length > 0 ? outward_[point] / length * pixel : glm::vec2(0);
            const glm::vec3 clip = projection_.clipXyw(points_[point]);
            const glm::vec3& n = normals_[point];
            const glm::vec3 normal = isCap ? flat : glm::dot(n, points_[point]) > 0 ? -n : n;
            vertices_.push_back({clip, normal, colorOf(scene, slice, level, isCap, point, 1)});
            vertices_.push_back(
                {clip + glm::vec3(out * clip.z, 0), normal, colorOf(scene, slice, level, isCap, point, 0)});
        }
        for (const std::uint32_t corner : {0U, 1U, 2U, 2U, 1U, 3U}) fringes_.push_back(first + corner);
    }
}

// Finds the silhouette: the edges between a triangle that faces the eye and a triangle that faces away from the eye.
void SurfaceBatch::findSilhouette(const slicing::SliceSurface& surface) {
    silhouette_.clear();
    for (const std::uint32_t t : front_) {
        const auto& corners = surface.triangles[t];
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t from = corners[i], to = corners[(i + 1) % 3];
            if (touchesBack_[from] != 0 && touchesBack_[to] != 0) silhouette_.push_back({from, to, t});
        }
    }
    // An edge between two triangles that face the eye is in the list twice, once in each direction. Such edges do not
    // belong to the silhouette, and are removed.
    const auto ends = [](const SilhouetteEdge& edge) {
        return std::pair(std::min(edge.from, edge.to), std::max(edge.from, edge.to));
    };
    std::ranges::sort(silhouette_, {}, ends);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < silhouette_.size();) {
        const bool isPaired = i + 1 < silhouette_.size() && ends(silhouette_[i]) == ends(silhouette_[i + 1]);
        if (!isPaired) silhouette_[kept++] = silhouette_[i];
        i += isPaired ? 2 : 1;
    }
    silhouette_.resize(kept);
}

namespace {

std::string vertexShaderSource(const scene::PictureStyle& style) {
    const glm::dvec3 half = glm::normalize(style.light + glm::dvec3(0, 0, 1));
    const auto vector = [](const glm::dvec3& v) {
        return "vec3(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) + ")";
    };
    return R"(
layout(location = 0) in vec3 clip;
layout(location = 1) in vec3 normalIn;
layout(location = 2) in vec4 colorIn;
uniform vec2 toDepth;
out vec4 color;
void main() {
    vec3 n = normalize(normalIn);
    float diffuse = )" +
           std::to_string(style.diffuse) + " * max(dot(n, " + vector(style.light) + R"(), 0.0);
    float specular = )" +
           std::to_string(style.specular) + " * pow(max(dot(n, " + vector(half) + "), 0.0), " +
           std::to_string(style.shininess) + R"();
    vec3 lit = colorIn.rgb * ()" +
           std::to_string(style.ambient) + R"( + diffuse) + specular;
    color = vec4(min(lit, 1.0) * colorIn.a, colorIn.a);
    gl_Position = vec4(clip.xy, toDepth.x * clip.z + toDepth.y, clip.z);
}
)";
}

constexpr std::string_view kFragmentSource = R"(
in vec4 color;
out vec4 pixel;
void main() { pixel = color; }
)";

constexpr VertexAttribute kAttributes[] = {{3, GL_FLOAT, offsetof(SurfaceVertex, clip)},
                                           {3, GL_FLOAT, offsetof(SurfaceVertex, normal)},
                                           {4, GL_UNSIGNED_BYTE, offsetof(SurfaceVertex, color)}};

}  // namespace

SurfaceProgram::SurfaceProgram(const scene::PictureStyle& style)
    : program_(vertexShaderSource(style), kFragmentSource, sizeof(SurfaceVertex), kAttributes),
      toDepth_(program_.uniformLocation("toDepth")) {}

void SurfaceProgram::draw(DepthRange range, const SurfaceBatch& surfaces, const std::vector<std::uint32_t>& indices) {
    uploadTriangles(range, surfaces, indices);
    drawIndexRange(0, indices.size());
}

void SurfaceProgram::uploadTriangles(DepthRange range, const SurfaceBatch& surfaces,
                                     const std::vector<std::uint32_t>& indices) {
    const glm::vec2 toDepth = range.toDepth();
    program_.use();
    glUniform2f(toDepth_, toDepth.x, toDepth.y);
    program_.uploadTriangles(surfaces.vertices().data(), surfaces.vertices().size(), indices);
}

}  // namespace oval4d::render
