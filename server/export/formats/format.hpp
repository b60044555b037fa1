#pragma once
// The description of a file format, and the input of the functions that write files.

#include <span>
#include <string>
#include <string_view>

#include "export/budget.hpp"
#include "export/drawing/drawing.hpp"
#include "export/mesh/mesh.hpp"
#include "scene/scene.hpp"
#include "slicing/object.hpp"

namespace oval4d::exports {

/// The input of formats with bodies: the bodies, already arranged.
struct BodiesToWrite {
    std::span<const NamedMesh> solids;
    std::span<const scene::Color> cellColors;  ///< the color of each cell
    const std::string& title;
    const Budget& budget;

    /// Returns the color of a triangle of `solid`: the color of its cell, or the color of the solid if it has no cell.
    scene::Color colorOf(const NamedMesh& solid, std::size_t triangle) const {
        const std::uint32_t cell = solid.mesh.cells[triangle];
        return cell < cellColors.size() ? cellColors[cell] : solid.color;
    }
};

/// The input of data formats: a scene, and the object whose slices it contains.
struct SceneInput {
    const scene::Scene& scene;
    const slicing::Object& object;
};

/// A file format of protocol/export_formats.json. Exactly one of its writers is not null: the first of a format with
/// bodies, the second of a format for data, the third of a format for figures.
struct Format {
    /// How the bodies are arranged. `none`: the format has no bodies; `plate`: in rows for a 3-D printer; `oval`: as in
    /// the oval view.
    enum class Arrangement { none, plate, oval };

    std::string name;       ///< the name in messages, which is also the file name extension: "stl"
    std::string mediaType;  ///< the value of the Content-Type header
    Arrangement arrangement = Arrangement::none;
    std::string (*writeBodies)(const BodiesToWrite&) = nullptr;
    std::string (*writeScene)(const SceneInput&) = nullptr;
    std::string (*writeDrawing)(const Drawing&) = nullptr;
};

}  // namespace oval4d::exports
