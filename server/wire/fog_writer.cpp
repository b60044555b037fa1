#include "wire/fog_writer.hpp"

#include "wire/binary_writer.hpp"
#include "wire/json_writer.hpp"

namespace oval4d::wire {

using slicing::SliceFog;

void FogWriter::clear() {
    walls_.clear();
    wallCounts_.clear();
    sizes_.clear();
    mins_.clear();
    steps_.clear();
    values_.clear();
}

void FogWriter::addWalls(const SliceFog& fog) {
    for (const auto& [normal, offset] : fog.walls) walls_.emplace_back(normal, offset);
}

void FogWriter::write(JsonWriter& w, const scene::Scene& scene, std::size_t i) {
    if (scene.fog.empty() || scene.slices->fogs[i].empty()) return;
    const SliceFog& fog = scene.slices->fogs[i];
    clear();
    addWalls(fog);
    w.key("fog");
    w.beginObject();
    w.key("size");
    w.beginArray();
    for (int axis = 0; axis < 3; ++axis) w.value(fog.size[axis]);
    w.endArray();
    w.key("min");
    w.vector(fog.min);
    w.member("step", fog.step);
    w.key("walls");
    w.vectors(walls_);
    w.key("values");
    w.image(fog.values, static_cast<std::size_t>(fog.size.x));
    w.endObject();
}

void FogWriter::write(BinaryWriter& w, const scene::Scene& scene) {
    if (scene.fog.empty()) return;
    clear();
    for (const SliceFog& fog : scene.slices->fogs) {
        wallCounts_.push_back(static_cast<std::uint32_t>(fog.walls.size()));
        for (int axis = 0; axis < 3; ++axis) sizes_.push_back(static_cast<std::uint32_t>(fog.size[axis]));
        mins_.push_back(fog.min);
        steps_.push_back(fog.step);
        addWalls(fog);
        values_.insert(values_.end(), fog.values.begin(), fog.values.end());
    }
    w.key("fog");
    w.beginObject();
    w.key("counts");
    w.beginObject();
    w.key("walls");
    w.numbers(wallCounts_);
    w.endObject();
    w.key("size");
    w.numbers(sizes_);
    w.key("min");
    w.vectors(std::span<const glm::dvec3>(mins_));
    w.key("step");
    w.doubles(steps_);
    w.key("walls");
    w.vectors(walls_);
    w.key("values");
    w.image(values_, 1);
    w.endObject();
}

}  // namespace oval4d::wire
