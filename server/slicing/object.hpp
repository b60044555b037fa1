#pragma once
// The extension point for new kinds of 4-D objects: a variant, and functions that apply to every kind. Only polytopes/,
// slicing/, and one place each in session/, wire/ and store/ depend on the kind of an object; all other code uses these
// functions.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/object_info.hpp"
#include "geometry/rotation.hpp"

namespace oval4d::geometry {
struct PointCloud;
}
namespace oval4d::polytopes {
struct Polytope;
}

namespace oval4d::slicing {

using PolytopePtr = std::shared_ptr<const polytopes::Polytope>;
using CloudPtr = std::shared_ptr<const geometry::PointCloud>;

/// A 4-D object: shared and immutable. The pointer is null only in an uninitialized State. Two objects compare equal
/// only if they are the same object.
using Object = std::variant<PolytopePtr, CloudPtr>;

/// The name, size and cell types of an object. The object must not be null; the reference lives as long as the object.
const geometry::ObjectInfo& infoOf(const Object& object);

/// The numbers of vertices, edges, 2-faces and cells.
std::array<std::size_t, 4> elementCounts(const Object& object);

/// The memory used by an object in bytes, without its name.
std::size_t bytesOf(const Object& object);

/// An address that identifies an object: copies of the object share it.
const void* identityOf(const Object& object);

/// The smallest and the largest w of the vertices when rotated by `orientation`.
std::pair<double, double> rangeOfW(const Object& object, const geometry::Rotation& orientation);

/// The radius of the balls at slice vertices, as a fraction of the circumradius. It grows with the mean edge length, so
/// that balls neither hide the slices of a 120-cell nor look too small in those of a 5-cell. Takes time linear in the
/// number of edges.
double ballRadius(const Object& object);

/// Sets `out` to the center of each cell: the mean of its vertices, each weighted by the number of 2-faces of the cell
/// that meet there.
void findCellCenters(const Object& object, std::vector<glm::dvec4>& out);

/// The cell type of each cell, as an index into ObjectInfo::cellTypes.
std::span<const std::uint32_t> cellTypesOf(const Object& object);

/// The object in 4OFF, with the vertices `rotatedVertices`, in its own units. Reading that of a polytope gives the same
/// polytope; of a cloud, it lists the points.
std::string write4Off(const Object& object, std::span<const glm::dvec4> rotatedVertices);

}  // namespace oval4d::slicing
