#include "wire/surface_writer.hpp"

#include "wire/binary_writer.hpp"
#include "wire/json_writer.hpp"

namespace oval4d::wire {

void SurfaceWriter::clear() {
    points_.clear();
    normals_.clear();
    triangles_.clear();
    level_.clear();
    cap_.clear();
    colors_.clear();
    capColors_.clear();
}

void SurfaceWriter::addSlice(const scene::Scene& scene, std::size_t slice) {
    const slicing::SliceSurface& surface = scene.slices->surfaces[slice];
    points_.insert(points_.end(), surface.points.begin(), surface.points.end());
    normals_.insert(normals_.end(), surface.normals.begin(), surface.normals.end());
    triangles_.insert(triangles_.end(), surface.triangles.begin(), surface.triangles.end());
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        level_.push_back(static_cast<std::uint32_t>(surface.levelIndex(t)));
        cap_.push_back(surface.isCap(t) ? 1 : 0);
    }
    const scene::SurfaceLook& look = scene.surfaces;
    for (std::size_t p = 0; look.colorsPoints() && p < surface.points.size(); ++p)
        colors_.push_back(look.pointColor(surface, p));
    for (std::size_t p = 0; look.colorsCapPoints() && p < surface.points.size(); ++p)
        capColors_.push_back(look.capPointColor(surface, p));
}

template <typename W>
void SurfaceWriter::writeArrays(W& w, const scene::Scene& scene) const {
    w.key("points");
    w.vectors(std::span<const glm::vec3>(points_));
    w.key("normals");
    w.vectors(std::span<const glm::vec3>(normals_));
    w.key("triangles");
    w.triples(triangles_);
    w.key("level");
    w.numbers(level_);
    w.key("cap");
    w.numbers(cap_);
    if (scene.surfaces.colorsPoints()) {
        w.key("colors");
        w.numbers(colors_);
    }
    if (scene.surfaces.colorsCapPoints()) {
        w.key("cap_colors");
        w.numbers(capColors_);
    }
}

void SurfaceWriter::write(JsonWriter& w, const scene::Scene& scene, std::size_t i) {
    if (scene.surfaces.empty() || scene.slices->surfaces[i].triangles.empty()) return;
    clear();
    addSlice(scene, i);
    w.key("surface");
    w.beginObject();
    if (!scene.surfaces.sliceColors.empty()) w.member("color", scene.surfaces.sliceColors[i]);
    writeArrays(w, scene);
    w.endObject();
}

void SurfaceWriter::write(BinaryWriter& w, const scene::Scene& scene) {
    if (scene.surfaces.empty()) return;
    clear();
    pointCounts_.clear();
    triangleCounts_.clear();
    for (std::size_t i = 0; i < scene.slices->surfaces.size(); ++i) {
        addSlice(scene, i);
        pointCounts_.push_back(static_cast<std::uint32_t>(scene.slices->surfaces[i].points.size()));
        triangleCounts_.push_back(static_cast<std::uint32_t>(scene.slices->surfaces[i].triangles.size()));
    }
    w.key("surface");
    w.beginObject();
    w.key("counts");
    w.beginObject();
    w.key("points");
    w.numbers(pointCounts_);
    w.key("triangles");
    w.numbers(triangleCounts_);
    w.endObject();
    if (!scene.surfaces.sliceColors.empty()) {
        w.key("color");
        w.numbers(scene.surfaces.sliceColors);
    }
    writeArrays(w, scene);
    w.endObject();
}

}  // namespace oval4d::wire
