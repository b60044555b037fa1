#pragma once
// Writes the slices in a `slices` message. In JSON, each slice is an object. In binary encodings, each property is an
// array with the values of all slices. Otherwise, a small message would consist mostly of the names of properties.

#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"
#include "wire/binary_writer.hpp"
#include "wire/cached_text.hpp"
#include "wire/fog_writer.hpp"
#include "wire/surface_writer.hpp"

namespace oval4d::wire {

class JsonWriter;

/// The cached texts of slice placements (positions and sizes of slices in the picture), in one encoding. Placements
/// often stay the same from one message to the next. Each text is one encoded object.
struct PlacementTexts {
    std::vector<CachedText<scene::SlicePlacement>> perSlice;     ///< for JSON: one text per slice
    CachedText<std::vector<scene::SlicePlacement>> ofAllSlices;  ///< for a binary encoding: one text for all slices
};

/// A writer of the slices and the projection of a scene. `texts` must have the encoding of the writer `w`.
class SliceListWriter {
  public:
    void write(JsonWriter& w, const scene::Scene& scene, PlacementTexts& texts);
    template <std::derived_from<BinaryWriter> W>
    void write(W& w, const scene::Scene& scene, PlacementTexts& texts) {
        const auto placements = texts.ofAllSlices.textFor(scene.placements, [&](std::string& out) {
            W placementWriter(out);
            writePlacements(placementWriter, scene.placements);
        });
        writeAllSlices(w, placements, scene);
    }
    /// Writes the parts of the projection of the whole object: for each part, its ProjectionPartLook, vertices, edges
    /// and faces. In binary encodings, each property is an array with the values of all parts.
    void writeProjection(JsonWriter& w, const scene::Scene& scene);
    void writeProjection(BinaryWriter& w, const scene::Scene& scene);

  private:
    static void writePlacements(BinaryWriter& w, const std::vector<scene::SlicePlacement>& placements);
    // Writes all slices as one object. `placements` is the encoded object from writePlacements(), whose members become
    // members of this object.
    void writeAllSlices(BinaryWriter& w, std::string_view placements, const scene::Scene& scene);
    // Writes the elements of all slices, or of all parts of a projection. `faceCells` has, for each face, the cell that
    // determines its color.
    void writeElements(BinaryWriter& w, const slicing::SliceSet& slices, const std::vector<std::uint32_t>& faceCells,
                       const slicing::VisibilityBySource& visibilities);
    // Writes the triangles of the faces of all slices, or of all parts of a projection. `colorCells` has, for each
    // face, the cell that determines its color.
    void writeFills(BinaryWriter& w, const slicing::FilledFaces& faces, const std::vector<std::uint32_t>& colorCells,
                    const slicing::VisibilityBySource& visibilities);
    // Writes the lengths of consecutive ranges as an array called `name`. `begin` contains the start of each range, and
    // finally the end of the last range.
    void writeRangeLengths(BinaryWriter& w, std::string_view name, std::span<const std::uint32_t> begin);

    std::vector<std::uint32_t> sizes_;
    SurfaceWriter surfaces_;
    FogWriter fogs_;
};

}  // namespace oval4d::wire
