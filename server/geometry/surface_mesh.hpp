#pragma once
// Surfaces in R⁴, as meshes of polygons.

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/cell_complex.hpp"
#include "geometry/jagged_array.hpp"
#include "geometry/reference_frame.hpp"
#include "serialization/stored_members.hpp"

namespace oval4d::geometry {

/// A surface in R⁴: a cell complex without cells, whose 2-faces are triangles, quads or other polygons.
/// makeSurfaceMesh() and transformedTo() make surfaces, which do not change afterward.
///
/// A 2-face need not be flat: its slice consists of straight segments between the points where the hyperplane cuts the
/// edges of the 2-face. An edge may lie in any number of 2-faces, so the surface may have a boundary, and need be
/// neither connected nor orientable nor a manifold. A surface may intersect itself.
struct SurfaceMesh : CellComplex {};
static_assert(serialization::HasOwnMembers<SurfaceMesh, CellComplex, 0>, "visitStoredMembers() considers each member");
void visitStoredMembers(serialization::ReadOrWritten<SurfaceMesh> auto& surface, auto& visit) {
    visit.member(0, serialization::asBase<CellComplex>(surface));
}

/// Thrown by makeSurfaceMesh() for vertices and 2-faces that do not form a valid surface.
class InvalidSurface : public std::invalid_argument {
  public:
    /// `number` is the index of the invalid 2-face, or kNone if no single 2-face is the cause. `fault` says what is
    /// wrong; what() returns it.
    InvalidSurface(std::uint32_t number, const std::string& fault) : std::invalid_argument(fault), face(number) {}

    std::uint32_t face;  ///< the index of the invalid 2-face, or kNone
};

/// Makes a surface from its vertices and the vertex loops of its 2-faces; computes its edges. Throws InvalidSurface if
/// there are no 2-faces, if a 2-face has fewer than three vertices or lists a vertex twice, if an index is out of
/// range, if a coordinate is not finite, or if all vertices are at the origin.
SurfaceMesh makeSurfaceMesh(std::string name, std::vector<glm::dvec4> vertices, JaggedArray faces);

/// Returns the surface in the coordinates of the frame of reference `frame`, with the serial number `serial`.
SurfaceMesh transformedTo(const SurfaceMesh& surface, const ReferenceFrame& frame, std::uint64_t serial);

/// Returns the memory that the surface occupies, in bytes. The text of its name does not count.
std::size_t memoryOf(const SurfaceMesh& surface);

}  // namespace oval4d::geometry
