#pragma once
// Arranges the bodies of a file.

#include <vector>

#include "export/mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

/// The bodies that are arranged as a unit: those of a slice and of its label.
struct Group {
    int slice = 0;  ///< index in the slice set
    std::vector<Solid> solids;
};

/// Arranges groups for a 3-D printer: in rows on the plane z = 0 in the positive octant, by increasing w, with gaps of
/// size / 12, but at least 2 mm, between their bounding boxes.
void arrangeOnPlate(std::vector<Group>& groups, double size, const Grid& grid);

/// Arranges groups for viewing: on the oval of the picture, enlarged if necessary so that no two slices touch.
void arrangeInOval(std::vector<Group>& groups, const scene::Scene& scene, double size, const Grid& grid);

/// An upper bound on the coordinates that either arrangement gives this number of slices.
double maxExtentOf(int slices, double size);

}  // namespace oval4d::exports
