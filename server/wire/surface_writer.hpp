#pragma once
// Writes the surfaces of a field's slices (isosurfaces of the levels). In JSON, each slice is an object with its own
// surfaces. In binary encodings, each property is an array with the values of all slices.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/scene.hpp"
#include "wire/arrays.hpp"

namespace oval4d::wire {

class BinaryWriter;
class JsonWriter;

/// A writer of the surfaces of slices. Keeps the memory of its arrays from one call to the next.
class SurfaceWriter {
  public:
    /// Writes the member `surface` of slice i. Writes nothing if the slice has no surface.
    void write(JsonWriter& w, const scene::Scene& scene, std::size_t i);
    /// Writes the member `surface` with the surfaces of all slices. Writes nothing if the object has no surfaces.
    void write(BinaryWriter& w, const scene::Scene& scene);
    /// Writes the member `surfaces` of the object `scene` in the message: how each level is drawn. Writes nothing if
    /// there are no levels.
    template <typename W>
    static void writeLook(W& w, const scene::SurfaceLook& look) {
        if (look.empty()) return;
        w.key("surfaces");
        w.beginArray();
        for (const scene::SurfaceLook::LevelLook& level : look.levels) {
            w.beginObject();
            w.member("level", static_cast<std::uint64_t>(level.index));
            w.member("color", level.color);
            w.member("opacity", level.opacity);
            w.member("caps", level.caps);
            w.endObject();
        }
        w.endArray();
    }

  private:
    void clear();
    void addSlice(const scene::Scene& scene, std::size_t slice);
    template <typename W>
    void writeArrays(W& w, const scene::Scene& scene) const;

    std::vector<glm::vec3> points_, normals_;
    std::vector<IndexTriple> triangles_;
    // level_ and cap_ have one number for each triangle. cap_ is 1 for triangles of caps, the flat parts that close a
    // body at the boundary of the field's box; otherwise 0. colors_ and capColors_ have one number for each point.
    std::vector<std::uint32_t> level_, cap_, colors_, capColors_;
    // One number for each slice.
    std::vector<std::uint32_t> pointCounts_, triangleCounts_;
};

}  // namespace oval4d::wire
