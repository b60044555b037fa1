#pragma once
// The input and the description of file formats.

#include <span>
#include <string>
#include <string_view>

#include "export/budget.hpp"
#include "export/mesh/mesh.hpp"
#include "scene/scene.hpp"
#include "slicing/object.hpp"

namespace oval4d::exports {

/// The bodies of a file, already arranged.
struct Bodies {
    std::span<const Solid> solids;
    std::span<const scene::Color> cellColors;
    const std::string& title;
    const Budget& budget;

    /// The color of a triangle of `solid`: that of its cell, or that of the solid if it has no cell.
    scene::Color colorOf(const Solid& solid, std::size_t triangle) const {
        const std::uint32_t cell = solid.mesh.cells[triangle];
        return cell < cellColors.size() ? cellColors[cell] : solid.color;
    }
};

/// The input of formats without bodies.
struct Source {
    const scene::Scene& scene;
    const slicing::Object& object;
};

/// A file format of protocol/export_formats.json. Exactly one of the two writers is set.
struct Format {
    enum class Arrangement { none, plate, oval };  ///< of the bodies

    std::string name;       ///< in messages, and as the file name extension: "stl"
    std::string mediaType;  ///< for the Content-Type header
    Arrangement arrangement = Arrangement::none;
    std::string (*writeBodies)(const Bodies&) = nullptr;
    std::string (*writeSource)(const Source&) = nullptr;
};

}  // namespace oval4d::exports
