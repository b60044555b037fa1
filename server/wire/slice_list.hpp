#pragma once
// Writes the slices of a `slices` message. The JSON encoding has one object per slice. The CBOR encoding has one array
// per property with the values of all slices, because otherwise a small message would consist mostly of property names.

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"
#include "wire/cached_text.hpp"
#include "wire/fog_writer.hpp"
#include "wire/surface_writer.hpp"

namespace oval4d::wire {

class CborWriter;
class JsonWriter;

/// Writes lists of slices. Caches the texts of placements, which often stay the same from one list to the next.
class SliceListWriter {
  public:
    void write(JsonWriter& w, const scene::Scene& scene);
    void write(CborWriter& w, const scene::Scene& scene);
    /// Writes the projection of the whole object: each ProjectionPart with its vertices, edges and faces. In CBOR, as
    /// with slices, one array per property has the vertices, edges and faces of all parts.
    void writeProjection(JsonWriter& w, const scene::Scene& scene);
    void writeProjection(CborWriter& w, const scene::Scene& scene);

  private:
    // Writes the elements of all slices, or of all parts of a projection.
    void writeElements(CborWriter& w, const slicing::SliceSet& slices, const std::vector<std::uint32_t>& faceCells,
                       const slicing::Visibilities& visibilities);
    // Writes the lengths of consecutive ranges. `begin` has the beginning of each range and the end of the last one.
    void writeSizes(CborWriter& w, std::string_view name, std::span<const std::uint32_t> begin);

    std::vector<CachedText<scene::SlicePlacement>> placements_;  // the texts in JSON, one per slice
    CachedText<std::vector<scene::SlicePlacement>> columns_;     // the text in CBOR, for all slices
    std::vector<std::uint32_t> sizes_;
    SurfaceWriter surfaces_;
    FogWriter fogs_;
};

}  // namespace oval4d::wire
