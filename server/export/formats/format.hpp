#pragma once
// The description of a file format, and the input of the functions that write files.

#include <span>
#include <string>
#include <string_view>

#include "export/budget.hpp"
#include "export/mesh/mesh.hpp"
#include "scene/scene.hpp"
#include "slicing/object.hpp"

namespace oval4d::exports {

/// The input of formats with bodies: the bodies, already arranged.
struct BodiesInput {
    std::span<const NamedMesh> solids;
    std::span<const scene::Color> cellColors;  ///< one per cell
    const std::string& title;
    const Budget& budget;

    /// Returns the color of a triangle of `solid`: that of its cell, or that of the solid if it has no cell.
    scene::Color colorOf(const NamedMesh& solid, std::size_t triangle) const {
        const std::uint32_t cell = solid.mesh.cells[triangle];
        return cell < cellColors.size() ? cellColors[cell] : solid.color;
    }
};

/// The input of formats without bodies: a scene, and the object whose slices it contains.
struct SceneInput {
    const scene::Scene& scene;
    const slicing::Object& object;
};

/// A file format of protocol/export_formats.json. Exactly one of the two writers is set.
struct Format {
    /// How the bodies are arranged: the format has no bodies, in rows for a 3-D printer, or as in the oval view.
    enum class Arrangement { none, plate, oval };

    std::string name;       ///< the name in messages, which is also the file name extension: "stl"
    std::string mediaType;  ///< the value of the Content-Type header
    Arrangement arrangement = Arrangement::none;
    std::string (*writeBodies)(const BodiesInput&) = nullptr;
    std::string (*writeScene)(const SceneInput&) = nullptr;
};

}  // namespace oval4d::exports
