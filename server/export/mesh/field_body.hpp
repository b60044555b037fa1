#pragma once
// Bodies enclosed by the surfaces of fields.

#include <cstddef>

#include "export/budget.hpp"
#include "export/mesh/field_surfaces.hpp"
#include "export/mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

/// Returns the body that the surface of one level and its caps enclose in slice i of a field (see
/// slicing::SliceSurface). `slice` is the surface in this slice, and `level` an index into scene.surfaces.levels.
/// `scale` is in millimeters per unit of the object. The mesh has Mesh::pointColors, as in the picture, and
/// Mesh::pointValues. Returns an empty mesh if the rounded body has no volume (see isThickEnough()). Throws the
/// exceptions of snapSurface().
Mesh fieldBodyOf(const scene::Scene& scene, const FieldSliceSurface& slice, int i, std::size_t level, double scale,
                 const RoundingGrid& grid, const ExportBudget& budget);

}  // namespace oval4d::exports
