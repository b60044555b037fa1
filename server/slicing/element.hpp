#pragma once
// The elements of an object (its vertices, edges, 2-faces and cells): their directions, measurements and names, and
// which of them a hyperplane cuts.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/hyperplanes.hpp"
#include "geometry/rotation.hpp"
#include "serialization/stored_members.hpp"
#include "slicing/object.hpp"
#include "text/choice.hpp"

namespace oval4d::slicing {

/// The kinds of elements, ordered by dimension from 0 to 3. The points of a point cloud count as vertices. Stored
/// sessions contain the numbers of the enumerators, so these numbers must not change.
enum class ElementKind : std::uint8_t { vertex = 0, edge = 1, face = 2, cell = 3 };
inline constexpr auto kElementKinds =
    text::completeTable<text::NamedValue<ElementKind>>({{"vertex", ElementKind::vertex},
                                                        {"edge", ElementKind::edge},
                                                        {"face", ElementKind::face},
                                                        {"cell", ElementKind::cell}});
constexpr const auto& choicesOf(ElementKind /*type*/) { return kElementKinds; }

/// One element of an object: its kind, and its index from 0 among the object's elements of this kind.
struct Element {
    ElementKind kind = ElementKind::vertex;
    std::size_t index = 0;
    bool operator==(const Element&) const = default;
};
void visitStoredMembers(serialization::ReadOrWritten<Element> auto& element, auto& visit) {
    auto& [kind, index] = element;
    visit.member(0, kind);
    visit.member(1, index);
}

/// Returns the number of elements of the kind `kind` that `object` has.
std::size_t elementCount(const Object& object, ElementKind kind);

/// Returns a vector in the direction of the element: from the origin to the nearest point of the element's affine span.
/// The vector and `preferred` are in the object's own coordinates, before any rotation. A rotation that turns this
/// direction to +w moves the whole element into one hyperplane w = const. If the span contains the origin, returns a
/// vector perpendicular to the span: the one closest in direction to `preferred`, or any one if `preferred` lies in the
/// span. The length of the result is arbitrary, but not 0. Requires that `preferred` is not 0, and that element.index <
/// elementCount(object, element.kind).
glm::dvec4 elementDirectionOf(const Object& object, const Element& element, const glm::dvec4& preferred);

/// Returns the rotation by the smallest angle that turns the direction of the element to +w if it is applied after
/// `orientation`. The direction of the element is the result of elementDirectionOf(), where `preferred` is the
/// direction that `orientation` turns to +w. Requires element.index < elementCount(object, element.kind).
geometry::Rotation rotationToW(const Object& object, const Element& element, const geometry::Rotation& orientation);

/// Returns the element of kind `kind` whose direction (see elementDirectionOf()) is closest to +w after rotation by
/// `orientation`. If `incident` is given, considers only elements that contain `incident` or are contained in it; among
/// elements of the kind of `incident`, considers only `incident` itself. If the closest element already points to +w,
/// returns instead the considered element with the next greater index or, after the last one, the first. Therefore a
/// caller that turns each result to +w visits one element after another. Returns an empty optional if there is no
/// element to consider. Takes time linear in the size of the object.
std::optional<Element> elementToTurnTo(const Object& object, ElementKind kind, const geometry::Rotation& orientation,
                                       const std::optional<Element>& incident = {});

/// Returns, for each element of kind `kind` in the order of indices, whether a hyperplane cuts it after rotation by
/// `orientation`. A hyperplane cuts an element that has vertices on both sides of the hyperplane, or that lies in the
/// hyperplane. It does not cut an element that only touches it. Vertices within kOnPlaneTolerance circumradii (see
/// slice_set.hpp) of the hyperplane count as lying in it. A point of a point cloud is cut if it is within half of
/// plane.spacing of the hyperplane, as in CloudSlicer. Requires plane.count == 1, and that plane.listed is empty. Takes
/// time linear in the size of the object.
std::vector<bool> elementsCutBy(const Object& object, ElementKind kind, const geometry::Rotation& orientation,
                                const geometry::Hyperplanes& plane);

/// The parts of a picture that show one element of the object: slice vertices, slice edges, and vertices of the object.
/// A slice vertex or edge is given by its source number, which says from which element of the object it was cut (see
/// SliceSet). The lists are sorted and have no duplicates.
struct PartsShowingElement {
    /// The source numbers (from which element they were cut) of slice vertices and of slice edges.
    std::vector<std::uint32_t> vertices, edges;
    std::vector<std::uint32_t> ownVertices;  ///< the element's vertices, as indices into the object's vertices

    bool hasVertex(std::uint32_t source) const { return contains(vertices, source); }
    bool hasEdge(std::uint32_t source) const { return contains(edges, source); }
    bool empty() const { return ownVertices.empty(); }
    void clear();
    bool operator==(const PartsShowingElement&) const = default;

  private:
    // Returns whether the sorted list contains `source`, by a binary search without branches. The search is done for
    // each vertex and edge of all slices, and the processor could not predict the branches.
    static bool contains(const std::vector<std::uint32_t>& sorted, std::uint32_t source) {
        if (sorted.empty()) return false;
        const std::uint32_t* first = sorted.data();
        for (std::size_t count = sorted.size(); count > 1;) {
            const std::size_t half = count / 2;
            first += half * static_cast<std::size_t>(first[half] <= source);
            count -= half;
        }
        return *first == source;
    }
};

/// Finds the parts of a picture that show `element`, and writes them to `out`:
/// - for a vertex: the vertex itself, and the slice vertices cut from its edges;
/// - for an edge: the edge itself, and the slice vertices cut from it;
/// - for a 2-face: its edges, and the slice edges cut from the 2-face;
/// - for a cell: everything that shows its 2-faces;
/// - for a point of a point cloud: the point itself.
///
/// Overwrites `out`. Takes time linear in the number of edges. Requires element.index < elementCount(object,
/// element.kind).
void findPartsShowing(const Object& object, const Element& element, PartsShowingElement& out);

/// The center and the size of an element.
struct ElementMeasurements {
    std::optional<double> length;  ///< the length of an edge; empty for other elements
    /// The area of a 2-face, and the volume of a cell; empty for other elements. A region that a star polygon or star
    /// polyhedron encloses n times counts n times.
    std::optional<double> area, volume;
    glm::dvec4 center{0};  ///< the mean of the element's vertices
    /// The unit of the length, area or volume, if the element belongs to the box of a field: the product of the units
    /// of the axes along which the element extends. Empty if one of these units is unknown, and for all other objects.
    std::string unit;
};

/// Measures an element in the coordinates of vertexInFile(), before any rotation: those of the object's file or, for a
/// field, those of its function. Takes time linear in the size of the element, apart from sorting its vertices.
/// Requires element.index < elementCount(object, element.kind).
ElementMeasurements measureElement(const Object& object, const Element& element);

/// Returns the smallest and the largest w coordinate of the element's vertices after rotation by `orientation`. Takes
/// time linear in the size of the element. Requires element.index < elementCount(object, element.kind).
std::pair<double, double> rangeOfW(const Object& object, const geometry::Rotation& orientation, const Element& element);

/// Returns the name of the polygon that a 2-face forms (see polytopes::nameOfPolygon()), in the coordinates of
/// vertexInFile(). Requires face < elementCount(object, ElementKind::face).
std::string nameOfFace(const Object& object, std::size_t face);

/// Returns the w coordinate of the next vertex above `w` or, if `upward` is false, below `w`, after rotation by
/// `orientation`. Between the w of two successive vertices, all sections w = const of a polytope have the same
/// combinatorial type (Coxeter, Regular Polytopes, §13.1). Coordinates that differ by at most kOnPlaneTolerance
/// circumradii (see slice_set.hpp) count as equal. Returns an empty optional if there is no such vertex.
std::optional<double> nextVertexHeight(const Object& object, const geometry::Rotation& orientation, double w,
                                       bool upward);

/// A group of vertices whose w coordinates are equal, apart from rounding errors: the mean of these coordinates, and
/// the number of vertices.
struct VertexGroupAtW {
    double w = 0;
    std::size_t vertexCount = 0;
};

/// Returns the w coordinates of the vertices of the object, rotated by `orientation`, in ascending order. Successive
/// coordinates that differ by at most kOnPlaneTolerance circumradii form one group (see groupHeights()).
std::vector<VertexGroupAtW> vertexHeights(const Object& object, const geometry::Rotation& orientation);

/// Sorts w coordinates, and groups successive coordinates that differ by at most `same`. The w of a group is the mean
/// of its coordinates.
std::vector<VertexGroupAtW> groupHeights(std::vector<double> heights, double same);

}  // namespace oval4d::slicing
