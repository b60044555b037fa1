#pragma once
// Writes the fog of a field's slices. The JSON encoding has one object per slice; binary encodings have one array per
// property with the values of all slices.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scene/scene.hpp"

namespace oval4d::wire {

class BinaryWriter;
class JsonWriter;

/// Writes the fog of slices. Keeps the memory of its arrays from one call to the next.
class FogWriter {
  public:
    /// Writes the member `fog` of slice i, or nothing if the slice has no fog.
    void write(JsonWriter& w, const scene::Scene& scene, std::size_t i);
    /// Writes the member `fog` with the fog of all slices, or nothing if there is no fog.
    void write(BinaryWriter& w, const scene::Scene& scene);

  private:
    void clear();
    void addWalls(const slicing::SliceFog& fog);

    std::vector<glm::dvec4> walls_;
    std::vector<std::uint32_t> wallCounts_, sizes_;  // of each slice: the number of walls; x, y and z of SliceFog::size
    std::vector<glm::dvec3> mins_;
    std::vector<double> steps_;
    std::vector<std::uint8_t> values_;
};

/// Writes the member `fog` of the object `scene` in the message: the transfer function. Writes nothing if there is no
/// fog.
template <typename W>
void writeFogTable(W& w, const scene::FogTable& table) {
    if (table.empty()) return;
    w.key("fog");
    w.beginObject();
    w.key("table");
    w.numbers(table);
    w.endObject();
}

}  // namespace oval4d::wire
