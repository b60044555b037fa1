#pragma once
// The extension point for new kinds of 4-D objects: a variant, and functions that apply to every kind. Only the kinds
// themselves (polytopes/, geometry/point_cloud), slicing/, session/load.cpp, store/object_codec.cpp and the formats of
// protocol/schema/load.schema.json depend on the kind of an object; all other code uses these functions.

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

/// Returns the properties that objects of every kind have. The reference is valid as long as the object exists. Here
/// and in all functions below, the object must not be null.
const geometry::ObjectInfo& infoOf(const Object& object);

/// Returns the numbers of vertices (or points), edges, 2-faces and cells.
std::array<std::size_t, 4> elementCounts(const Object& object);

/// Returns the memory used by an object in bytes, without its name.
std::size_t memoryOf(const Object& object);

/// Returns the address of the shared data. It identifies the object: all copies of an Object return the same address.
const void* identityOf(const Object& object);

/// Returns the smallest and the largest w coordinate of the vertices after rotation by `orientation`.
std::pair<double, double> rangeOfW(const Object& object, const geometry::Rotation& orientation);

/// Returns the radius of the balls drawn at slice vertices, as a fraction of the circumradius. For a polytope, the
/// radius grows with the mean edge length, so that balls neither hide the slices of a 120-cell nor look too small in
/// slices of a 5-cell. For a point cloud, the radius decreases as the number of points grows. Takes time linear in the
/// number of edges.
double ballRadius(const Object& object);

/// Sets `out` to the center of each cell: the mean of its vertices, each weighted by the number of 2-faces of the cell
/// that contain it. Leaves `out` empty for a point cloud.
void findCellCenters(const Object& object, std::vector<glm::dvec4>& out);

/// Finds the hyperplane of each cell: sets `normals` to its outward normals, whose length is six times the volume of
/// the cell, and `offsets` to the products of the normal and any point of the cell. If a cell encloses no volume, as
/// some cells that cross themselves do, both are 0. A point cloud has no cells.
void findCellHyperplanes(const Object& object, std::vector<glm::dvec4>& normals, std::vector<double>& offsets);

/// Returns the type of each cell, as an index into ObjectInfo::cellTypes; empty for a point cloud.
std::span<const std::uint32_t> typeOfCells(const Object& object);

/// Returns the object as the text of a 4OFF file, in the object's units. The file contains `rotatedVertices` instead of
/// the object's own vertices. Importing the file of a polytope gives the rotated polytope; the file of a point cloud
/// has vertices only.
std::string write4Off(const Object& object, std::span<const glm::dvec4> rotatedVertices);

}  // namespace oval4d::slicing
