#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace oval4d::geometry {

/// A type of cells, such as all truncated tetrahedra of a polytope.
struct CellType {
    std::string name;         ///< "truncated tetrahedron"
    std::uint32_t cells = 0;  ///< their number
    bool operator==(const CellType&) const = default;
};

/// What the program needs to know of any 4-D object, whatever its kind.
struct ObjectInfo {
    std::string name;
    std::uint64_t serial = 0;         ///< unique among the objects built in this process: the key of caches
    double circumradius = 0;          ///< the largest distance of a vertex from the origin
    bool convex = true;               ///< the boundary of a convex body: faces of its slices never cross each other
    bool constructed = false;         ///< built from its name alone, so that the name is enough to store it
    std::vector<CellType> cellTypes;  ///< empty for an object without cells
};

/// A serial that no other object of this process has. Thread-safe.
std::uint64_t nextSerial();

}  // namespace oval4d::geometry
