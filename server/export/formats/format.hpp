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

/// The input of the writers of mesh formats (STL, PLY, …). PlacedMesh::at is the position in the file to which each
/// mesh must be moved (see arrangement.hpp).
struct MeshesToWrite {
    std::span<const PlacedMesh> solids;
    std::span<const scene::Color> cellColors;  ///< the color of each cell of the object
    const std::string& title;
    const ExportBudget& budget;
    /// Whether the writer must write 64-bit floats, because the coordinates are too fine for 32-bit floats (see
    /// RoundingGrid::forDoublePrecision()). True only if Format::keepsDoubles is true.
    bool hasDoubles = false;

    /// Returns the color of a triangle of `solid`: the color of its cell or, if it has no cell, the color of the solid.
    scene::Color colorOf(const PlacedMesh& solid, std::size_t triangle) const {
        const std::uint32_t cell = solid.mesh.cells[triangle];
        return cell < cellColors.size() ? cellColors[cell] : solid.color;
    }
    /// Returns whether at least one mesh has a color for each point (Mesh::pointColors).
    bool anyHasPointColors() const {
        return std::ranges::any_of(solids, [](const PlacedMesh& solid) { return !solid.mesh.pointColors.empty(); });
    }
};

/// The input of the writers of data formats. The slices of `scene` must have been cut from `object` rotated by
/// `orientation`.
struct SceneToWrite {
    const scene::Scene& scene;
    const slicing::Object& object;
    const geometry::Rotation& orientation;
    ExportContentsKind contents;
    const ExportBudget& budget;
    /// Warnings for the user. The writer appends what the file lacks (see ExportedFile::warnings).
    std::vector<std::string>& warnings;
    /// Whether surfaces of a field are exact (see ExportRequest::exact).
    bool exact = false;
};

/// A file format of protocol/export_formats.json. Exactly one of its three writers is not null: writeBodies for a mesh
/// format, writeScene for a data format, and writeDrawing for a figure format.
struct Format {
    /// The arrangement of the bodies of several slices: in rows for a 3-D printer (`plate`, see arrangeOnPlate()), or
    /// as in the picture (`oval`, see arrangeInOval()). `none` if the format has no bodies.
    enum class BodyArrangement { none, plate, oval };
    /// The kinds of objects that files of the format can contain.
    enum class ObjectKinds { all, fields, polytopes_and_points };

    std::string name;       ///< the name in messages and the file name extension, such as "stl"
    std::string mediaType;  ///< the media type of the file, for the header Content-Type
    BodyArrangement arrangement = BodyArrangement::none;
    ObjectKinds objects = ObjectKinds::all;
    std::vector<ExportContentsKind> contents;  ///< the contents that a file can have; the first is the default
    /// Whether writeScene writes surfaces of a field: those in SliceSet::surfaces, or exact surfaces.
    bool readsSurfaces = false;
    /// Whether writeBodies can write coordinates without rounding them to 32-bit floats.
    bool keepsDoubles = false;
    /// Whether writeScene gets the scene of the picture, with its view, camera, visible parts, highlight and
    /// background. If false, writeScene gets a scene with the default look, and with the colors, levels and fog of the
    /// picture.
    bool showsPicture = false;
    std::string (*writeBodies)(const MeshesToWrite&) = nullptr;
    std::string (*writeScene)(const SceneToWrite&) = nullptr;
    std::string (*writeDrawing)(const Drawing&) = nullptr;

    /// Returns whether files of this format can contain `what`.
    bool canContain(ExportContentsKind what) const { return std::ranges::find(contents, what) != contents.end(); }
};

}  // namespace oval4d::exports
