#pragma once
// Where the bodies of a file stand.

#include <vector>

#include "export/mesh.hpp"
#include "geometry/slice_set.hpp"

namespace oval4d::exports {

/// The bodies that stand together: a slice's, and its label's.
struct Group {
    int slice = 0;  ///< number in the slice set
    std::vector<Solid> solids;
};

/// For a printer: in rows on the plane z = 0, from the lowest w on, in the positive octant, the boxes around them
/// apart by a twelfth of `size` and 2 mm at least.
void standOnPlate(std::vector<Group>& groups, double size, const Grid& grid);

/// For the eye: on the oval of the pictures, grown where it must be so that no two slices meet.
void standInOval(std::vector<Group>& groups, const geometry::Polytope& polytope, const geometry::Hyperplanes& planes,
                 int focus, double size, const Grid& grid);

/// How far from the origin either of them can reach, for so many slices.
double reachOf(int slices, double size);

}  // namespace oval4d::exports
