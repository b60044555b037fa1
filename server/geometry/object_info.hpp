#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/range.hpp"
#include "serialization/stored_members.hpp"

namespace oval4d::geometry {

/// A type of cells of a polytope, for example its truncated tetrahedra. The user shows, fades or hides all cells of a
/// type together.
struct CellType {
    std::string name;         ///< the name of the cells' shape, such as "truncated tetrahedron"
    std::uint32_t cells = 0;  ///< the number of cells of this type
    bool operator==(const CellType&) const = default;
};

/// The properties that 4-D objects of all kinds (see slicing::Object) have.
struct ObjectInfo {
    /// The allowed range of the coordinates of vertices, points and `originInFile` in stored objects.
    static constexpr NumberRange kStoredCoordinates = NumberRange::ofAbsoluteValuesUpTo(1e15);

    std::string name;
    std::uint64_t serial = 0;    ///< a number that no other object of any process has (see nextSerial()); the key of
                                 ///< the object in caches
    double circumradius = 0;     ///< the largest distance of a vertex or point from the origin; makePointCloud() says
                                 ///< what the circumradius is if all points of a cloud are at the origin
    glm::dvec4 originInFile{0};  ///< the point of the loaded file that became the origin of the object, in the
                                 ///< coordinates of the file; transformedTo() maps this point like a vertex. 0 unless
                                 ///< loading moved the object (see Centering)
    bool convex = true;          ///< false only for a polytope that is not the boundary of a convex body; in a slice of
                                 ///< such a polytope, faces may cross each other
    bool rebuildableFromName = false;  ///< whether the name alone is enough to build the object again
    std::vector<CellType> cellTypes;   ///< the types of the cells; empty for an object without cells
};
void visitStoredMembers(serialization::ReadOrWritten<ObjectInfo> auto& info, auto& visit) {
    auto& [name, serial, circumradius, originInFile, convex, rebuildableFromName, cellTypes] = info;
    visit.member(0, name);
    visit.member(1, originInFile, ObjectInfo::kStoredCoordinates);
    visit.recomputableMember(serial);
    visit.recomputableMember(circumradius);
    visit.recomputableMember(convex);
    // This member is not stored. It is false if the other members are stored: an object that is rebuildable from its
    // name is stored as its name alone.
    visit.recomputableMember(rebuildableFromName);
    visit.recomputableMember(cellTypes);
}

/// Returns a new value for ObjectInfo::serial, from 1 to 2^53 − 1. A process starts at a random integer and counts
/// up from there, so two processes almost certainly never return the same value. Thread-safe.
std::uint64_t nextSerial();

}  // namespace oval4d::geometry
