#pragma once
// A 4-D object of any kind: a variant, and functions for objects of every kind. To add a kind, add an alternative to
// the variant. A new kind needs its own folder or file (like polytopes/, fields/, geometry/point_cloud), and changes in
// slicing/, session/load.cpp, store/object_codec.cpp and protocol/schema/load.schema.json. If the new kind is derived
// from geometry::CellComplex, only propertiesOf() and code that stores and reads objects distinguish it from other cell
// complexes. All other code uses the functions below, among them propertiesOf(), with the properties that every kind
// states. Code for levels and fog also asks whether an object is a field (fieldIn()), because only fields have levels
// and fog.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/object_info.hpp"
#include "geometry/reference_frame.hpp"
#include "geometry/rotation.hpp"
#include "geometry/surface_mesh.hpp"

namespace oval4d::fields {
struct Field;
}
namespace oval4d::geometry {
struct PointCloud;
}
namespace oval4d::polytopes {
struct Polytope;
}

namespace oval4d::slicing {

using PolytopePtr = std::shared_ptr<const polytopes::Polytope>;
using SurfacePtr = std::shared_ptr<const geometry::SurfaceMesh>;
using CloudPtr = std::shared_ptr<const geometry::PointCloud>;
using FieldPtr = std::shared_ptr<const fields::Field>;

/// A 4-D object: a shared pointer to immutable data. The pointer is null only in an uninitialized session::State. Two
/// objects are equal if they share the same data. The vertices, edges, 2-faces and cells of a field are those of its
/// domain, the box on which it is defined.
using Object = std::variant<PolytopePtr, CloudPtr, FieldPtr, SurfacePtr>;

/// What the slices of an object are made of.
enum class SliceContent : std::uint8_t {
    solids,         ///< the sections of cells: a slice has vertices, edges and faces
    curves,         ///< the sections of the 2-faces of an object without cells: a slice has vertices and edges
    points,         ///< points of the object (of a point cloud)
    level_surfaces  ///< the surfaces and the fog of a field, in the section of its domain
};

/// The properties by which other code distinguishes the kinds of objects. Every kind states each of these properties.
struct ObjectKindProperties {
    std::string_view noun;  ///< what messages call the object, such as "polytope"
    bool isPlural;          ///< whether `noun` is a plural
    SliceContent slices;    ///< what the slices are made of
    /// Whether slices are thick: a slice then contains all points from half a spacing below its hyperplane (included)
    /// to half a spacing above it (not included). If false, a slice is the section by its hyperplane.
    bool slicesAreThick;
    bool sectionsHaveNames;  ///< whether SectionNamer names sections of the object
};

/// Returns the properties of the kind of `object`. The pointer in `object` may be null.
ObjectKindProperties propertiesOf(const Object& object);

/// Returns the field, or null if `object` is of another kind. The pointer is valid as long as the field exists.
const fields::Field* fieldIn(const Object& object);

/// Returns the properties that objects of every kind have, such as the name and the circumradius. The reference is
/// valid as long as the object's data exist. This function and those below require that the pointer in `object` is not
/// null.
const geometry::ObjectInfo& infoOf(const Object& object);

/// Returns the numbers of the object's vertices (or points), edges, 2-faces and cells, in this order.
std::array<std::size_t, 4> elementCounts(const Object& object);

/// Returns whether every 2-face is a convex polygon. Returns true for a point cloud.
bool hasConvexFaces(const Object& object);

/// Returns the object transformed to the coordinates of the frame of reference `frame`. If `frame` is the default
/// frame, returns the object itself. Otherwise, returns a new object; its serial number is `serial` or, in the overload
/// without this parameter, a new number. A transformed field shares the functions of the original field. Takes time and
/// memory linear in the number of elements.
Object transformedTo(const Object& object, const geometry::ReferenceFrame& frame);
Object transformedTo(const Object& object, const geometry::ReferenceFrame& frame, std::uint64_t serial);

/// Returns the largest |w| of the slices when `object` is first shown, in the object's units. For a field, this is 95 %
/// of the largest |w| of the unrotated domain, so that no slice of the domain is empty. For any other object, it is the
/// circumradius.
double initialSliceExtent(const Object& object);

/// Returns the memory used by an object, in bytes, without its name. For a field that transformedTo() made, does not
/// count the functions, because they belong to the original field.
std::size_t memoryOf(const Object& object);

/// Returns the address of the shared data of `object`. The address identifies the object: all copies of an Object
/// return the same address.
const void* identityOf(const Object& object);

/// Returns the coordinates of the vertex (or point) with this index in the object's file, before any rotation. For a
/// field, returns its coordinates as the field's function takes them.
glm::dvec4 vertexInFile(const Object& object, std::size_t index);

/// Returns the smallest and the largest w coordinate of the object's vertices after rotation by `orientation`.
std::pair<double, double> rangeOfW(const Object& object, const geometry::Rotation& orientation);

/// Returns the radius of the balls drawn at slice vertices, as a fraction of the circumradius. For a cell complex, the
/// radius grows with the mean edge length. So balls do not hide the slices of a 120-cell, and do not look too small in
/// slices of a 5-cell. For a surface, the radius is at least 0.016, however fine its mesh. For a point cloud, the
/// radius is smaller if there are more points. For a field, the radius is constant. Takes time linear in the number of
/// edges.
double relativeBallRadius(const Object& object);

/// Sets `out` to the center of each cell: the mean of the cell's vertices, each weighted by the number of the cell's
/// 2-faces that contain the vertex. Clears `out` for a point cloud or a surface.
void findCellCenters(const Object& object, std::vector<glm::dvec4>& out);

/// Sets `out` to the center of each 2-face: the mean of its vertices. Clears `out` for a point cloud.
void findFaceCenters(const Object& object, std::vector<glm::dvec4>& out);

/// Finds the hyperplane of each cell, before any rotation: sets normals[c] to the outward normal of cell c, and
/// offsets[c] to the dot product of this normal and any point of the cell. The length of a normal is six times the
/// volume of the cell. If the signed volume of a cell is 0, as for some self-intersecting cells, the normal and the
/// offset are 0. Clears both lists for a point cloud or a surface.
void findCellHyperplanes(const Object& object, std::vector<glm::dvec4>& normals, std::vector<double>& offsets);

/// Returns the type of each cell, as an index into ObjectInfo::cellTypes. The span is valid as long as the object's
/// data exist. It is empty for a point cloud or a surface.
std::span<const std::uint32_t> typesOfCells(const Object& object);

/// Returns the object as the text of a 4OFF file, in the object's units, with `rotatedVertices` in place of the
/// object's own vertices. ObjectInfo::originInFile (the point of the object's file that is the origin of the object) is
/// added to each of them. Therefore, importing the new file gives the object at its place in the original file, turned
/// about this point. The file of a surface lists no cells, and that of a point cloud has only vertices. The file of a
/// field contains the domain.
std::string write4Off(const Object& object, std::span<const glm::dvec4> rotatedVertices);

}  // namespace oval4d::slicing
