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

/// A 4-D object: a shared pointer to immutable data. The pointer is null only in an uninitialized session::State. Two
/// objects compare equal only if they share the same data.
using Object = std::variant<PolytopePtr, CloudPtr>;

/// Returns the properties that objects of every kind have. The object must not be null, here and below. The reference
/// is valid as long as the object exists.
const geometry::ObjectInfo& infoOf(const Object& object);

/// Returns the numbers of vertices (or points), edges, 2-faces and cells.
std::array<std::size_t, 4> elementCounts(const Object& object);

/// Returns the memory used by an object in bytes, without its name.
std::size_t memoryOf(const Object& object);

/// Returns the address of the shared data. It identifies the object: all copies of an Object return the same address.
const void* identityOf(const Object& object);

/// Returns the smallest and the largest w coordinate of the vertices after rotation by `orientation`.
std::pair<double, double> rangeOfW(const Object& object, const geometry::Rotation& orientation);

/// Returns the radius of the balls drawn at slice vertices, as a fraction of the circumradius. For a polytope, it grows
/// with the mean edge length, so that balls neither hide the slices of a 120-cell nor look too small in those of a
/// 5-cell; for a point cloud, it falls with the number of points. Takes time linear in the number of edges.
double ballRadius(const Object& object);

/// Sets `out` to the center of each cell: the mean of its vertices, each weighted by the number of 2-faces of the cell
/// that contain it. A point cloud has no cells.
void findCellCenters(const Object& object, std::vector<glm::dvec4>& out);

/// Returns the type of each cell, as an index into ObjectInfo::cellTypes; empty for a point cloud.
std::span<const std::uint32_t> typeOfCells(const Object& object);

/// Returns the text of a 4OFF file with the object, in its own units, with `rotatedVertices` in place of its vertices.
/// For a polytope, reading the file gives the same polytope, rotated; for a point cloud, the file has vertices only.
std::string write4Off(const Object& object, std::span<const glm::dvec4> rotatedVertices);

}  // namespace oval4d::slicing
