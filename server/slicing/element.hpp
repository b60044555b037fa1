#pragma once
// The elements of an object: its vertices, edges, 2-faces and cells.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/rotation.hpp"
#include "slicing/object.hpp"
#include "text/choice.hpp"

namespace oval4d::slicing {

/// The kinds of elements, by dimension: 0 to 3. The points of a point cloud are vertices.
enum class ElementKind : std::uint8_t { vertex, edge, face, cell };
inline constexpr auto kElementKinds = std::to_array<text::Choice<ElementKind>>({{"vertex", ElementKind::vertex},
                                                                                {"edge", ElementKind::edge},
                                                                                {"face", ElementKind::face},
                                                                                {"cell", ElementKind::cell}});

/// One element of an object: its kind, and its index from 0 among the object's elements of this kind.
struct Element {
    ElementKind kind = ElementKind::vertex;
    std::size_t index = 0;
    bool operator==(const Element&) const = default;
};

/// Returns the number of elements of this kind.
std::size_t elementCount(const Object& object, ElementKind kind);

/// Returns the direction, in the object's own coordinates, that points from the origin to the element: to the point of
/// its affine span that is closest to the origin. If this direction turns to +w, the whole element lies in one
/// hyperplane w = const. If the span contains the origin, returns the direction perpendicular to the element that is
/// closest to `preferred`. The result is never 0; its length is arbitrary. Requires element.index <
/// elementCount(object, element.kind).
glm::dvec4 directionOf(const Object& object, const Element& element, const glm::dvec4& preferred);

/// Returns the element of this kind whose direction is closest to +w after rotation by `orientation`. If that element
/// already points to +w, returns the one with the next index, so that repeated calls visit all elements. Returns an
/// empty optional if there are no elements of this kind. Takes time linear in the size of the object.
std::optional<Element> elementToTurnTo(const Object& object, ElementKind kind, const geometry::Rotation& orientation);

/// The parts of a picture that show one element of the object: slice vertices and slice edges, given by their source
/// numbers (see SliceSet), and vertices of the object. The lists are sorted and have no duplicates.
struct ElementSources {
    std::vector<std::uint32_t> vertices, edges;
    std::vector<std::uint32_t> ownVertices;  ///< the element's vertices, as indices into the object's

    bool hasVertex(std::uint32_t source) const { return std::ranges::binary_search(vertices, source); }
    bool hasEdge(std::uint32_t source) const { return std::ranges::binary_search(edges, source); }
    bool empty() const { return ownVertices.empty(); }
    void clear();
    bool operator==(const ElementSources&) const = default;
};

/// Finds the parts of a picture that show an element. A vertex is shown by itself and by the slice vertices that are
/// cut from its edges; an edge by itself and by the slice vertices that are cut from it; a 2-face by the slice edges
/// that are cut from it, and by its edges; a cell by all that shows its 2-faces; a point by itself. Overwrites `out`.
/// Takes time linear in the number of edges. Requires element.index < elementCount(object, element.kind).
void findSourcesShowing(const Object& object, const Element& element, ElementSources& out);

/// Returns the w coordinate, after rotation by `orientation`, of the next vertex above `w` or, if `upward` is false,
/// below `w`. Between two successive vertices, the section w = const does not change its combinatorial type (Coxeter,
/// Regular Polytopes, §13.1). Heights that differ by at most kOnPlane circumradii count as equal. Returns an empty
/// optional if there is no such vertex.
std::optional<double> nextVertexHeight(const Object& object, const geometry::Rotation& orientation, double w,
                                       bool upward);

}  // namespace oval4d::slicing
