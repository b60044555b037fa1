#pragma once
// Writes the fog of a field's slices (a volume rendering of values). In JSON, each slice is an object with its own fog.
// In binary encodings, each property of the fog is an array with the values of all slices.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scene/scene.hpp"

namespace oval4d::wire {

class BinaryWriter;
class JsonWriter;

/// A writer of the fog of slices. Keeps the memory of its arrays from one call to the next.
class FogWriter {
  public:
    /// Writes the member `fog` of slice i. Writes nothing if the slice has no fog.
    void write(JsonWriter& w, const scene::Scene& scene, std::size_t i);
    /// Writes the member `fog` with the fog of all slices. Writes nothing if no slice has fog.
    void write(BinaryWriter& w, const scene::Scene& scene);

  private:
    void clear();
    void addWalls(const slicing::SliceFog& fog);

    std::vector<glm::dvec4> walls_;
    // wallCounts_ has, for each slice, the number of SliceFog::walls, the half-spaces that bound the fog. sizes_ has
    // three numbers for each slice: the components of SliceFog::size.
    std::vector<std::uint32_t> wallCounts_, sizes_;
    std::vector<glm::dvec3> mins_;
    std::vector<double> steps_;
    std::vector<std::uint8_t> values_;
};

/// Writes the member `fog` of the object `scene` in the message: the transfer function, which gives each value its
/// color and opacity. Writes nothing if there is no fog.
template <typename W>
void writeFogTable(W& w, const scene::FogTransferTable& table) {
    if (table.empty()) return;
    w.key("fog");
    w.beginObject();
    w.key("table");
    w.numbers(table);
    w.endObject();
}

}  // namespace oval4d::wire
