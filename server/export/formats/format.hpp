#pragma once
// The description of a file format, and the input of the functions that write files.

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "export/budget.hpp"
#include "export/drawing/drawing.hpp"
#include "export/export_contents.hpp"
#include "export/mesh/mesh.hpp"
#include "geometry/rotation.hpp"
#include "scene/scene.hpp"
#include "slicing/object.hpp"

namespace oval4d::exports {

/// The input of the writers of mesh formats (STL, PLY, …). PlacedMesh::at is the final position of each mesh in the
/// file (see arrangement.hpp).
struct MeshesToWrite {
    std::span<const PlacedMesh> solids;
    std::span<const scene::Color> cellColors;  ///< the color of each cell
    const std::string& title;
    const Budget& budget;
    /// Whether the coordinates are multiples of a step that is too small for 32-bit floats (see
    /// RoundingGrid::forDoubles()). If true, the writer must write 64-bit floats. Always false unless
    /// Format::keepsDoubles is true.
    bool hasDoubles = false;

    /// Returns the color of a triangle of `solid`: the color of its cell, or the color of the solid if it has no cell.
    scene::Color colorOf(const PlacedMesh& solid, std::size_t triangle) const {
        const std::uint32_t cell = solid.mesh.cells[triangle];
        return cell < cellColors.size() ? cellColors[cell] : solid.color;
    }
    /// Returns whether the points of any mesh have colors (Mesh::pointColors).
    bool anyHasPointColors() const {
        return std::ranges::any_of(solids, [](const PlacedMesh& solid) { return !solid.mesh.pointColors.empty(); });
    }
};

/// The input of the writers of data formats. The slices of `scene` were cut from `object` rotated by `orientation`.
struct SceneToWrite {
    const scene::Scene& scene;
    const slicing::Object& object;
    const geometry::Rotation& orientation;
    ExportContentsKind contents;
    const Budget& budget;
    std::vector<std::string>& warnings;  ///< the writer adds what the file lacks (see ExportedFile::warnings)
    bool exact = false;                  ///< ExportRequest::exact
};

/// A file format of protocol/export_formats.json. Exactly one of its three writers is not null: writeBodies for a
/// format with bodies, writeScene for a data format, writeDrawing for a figure format.
struct Format {
    /// How the bodies of several slices are arranged. `none`: the format has no bodies; `plate`: in rows for a 3-D
    /// printer (see arrangeOnPlate()); `oval`: as in the picture (see arrangeInOval()).
    enum class Arrangement { none, plate, oval };
    /// The kinds of objects that files of the format can contain.
    enum class Objects { all, fields, polytopes_and_points };

    std::string name;       ///< the name in messages, which is also the file name extension: "stl"
    std::string mediaType;  ///< the value of the Content-Type header
    Arrangement arrangement = Arrangement::none;
    Objects objects = Objects::all;
    std::vector<ExportContentsKind> contents;  ///< what a file can contain; the first is the default of new requests
    /// Whether writeScene writes the surfaces of a field: those in SliceSet::surfaces, or exact ones.
    bool readsSurfaces = false;
    bool keepsDoubles = false;  ///< whether writeBodies keeps coordinates that only 64-bit floats can represent
    /// Whether writeScene gets the scene that the picture shows, with its view, camera, visible parts, highlight and
    /// background. If false, writeScene gets a scene of the default look with the colors, levels and fog of the
    /// picture.
    bool showsPicture = false;
    std::string (*writeBodies)(const MeshesToWrite&) = nullptr;
    std::string (*writeScene)(const SceneToWrite&) = nullptr;
    std::string (*writeDrawing)(const Drawing&) = nullptr;

    /// Returns whether files of the format can contain `what`.
    bool canContain(ExportContentsKind what) const { return std::ranges::find(contents, what) != contents.end(); }
};

}  // namespace oval4d::exports
