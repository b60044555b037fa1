#pragma once
// Finds which elements of slices are visible, if the user has hidden or faded some types of cells.

#include <cstdint>
#include <span>
#include <vector>

#include "slicing/element.hpp"
#include "slicing/object.hpp"

namespace oval4d::slicing {

/// How a slice element is drawn: not at all, partly transparent, or normally.
enum class Visibility : std::uint8_t { hidden, faded, full };

/// Returns the factor by which `visibility` multiplies the opacity of a shape.
constexpr double opacityOf(Visibility visibility) {
    return visibility == Visibility::full ? 1 : visibility == Visibility::faded ? 0.25 : 0;
}

/// The visibilities of slice vertices, edges and faces. The index of an entry is the source number of the slice
/// element: it says from which polytope element the slice element was cut (see SliceSet). The slice element has the
/// visibility of this polytope element. A cell has the visibility of its type. Any other polytope element has the
/// greatest visibility of the cells that contain it. All lists are empty if everything is fully visible.
struct VisibilityBySource {
    std::vector<Visibility> vertices, edges, faces;

    /// Returns whether everything is fully visible.
    bool allVisible() const { return faces.empty(); }
    Visibility vertex(std::uint32_t source) const { return vertices.empty() ? Visibility::full : vertices[source]; }
    Visibility edge(std::uint32_t source) const { return edges.empty() ? Visibility::full : edges[source]; }
    Visibility face(std::uint32_t source) const { return faces.empty() ? Visibility::full : faces[source]; }
};

/// Finds the visibilities of all elements of `object`. `ofType` has the visibility of each cell type, in the order of
/// ObjectInfo::cellTypes. Overwrites `out`.
void findVisibilities(const Object& object, std::span<const Visibility> ofType, VisibilityBySource& out);

/// Finds the visibilities of all elements of `object` if the cell types in `hidden` are hidden, those in `faded` are
/// faded, and all others are fully visible. Both lists have indices into ObjectInfo::cellTypes. An index that is too
/// large is ignored, and a cell type that is in both lists is hidden. Overwrites `out`.
void findVisibilities(const Object& object, std::span<const std::uint32_t> hidden, std::span<const std::uint32_t> faded,
                      VisibilityBySource& out);

/// Returns the visibility of `element`, an element of `object`. `visibilities` must be what findVisibilities() has
/// found for `object`. Requires element.index < elementCount(object, element.kind).
Visibility visibilityOf(const Object& object, const VisibilityBySource& visibilities, const Element& element);

/// Returns the cell that determines the color of a slice face. `source` is the entry of SliceSet::faceSource for this
/// face. If the face was cut from a cell, the result is that cell. If the slice face is a 2-face that lies in the
/// hyperplane, the result is the first cell of this 2-face or, if the first one is hidden, the second.
std::uint32_t coloringCell(const Object& object, const VisibilityBySource& visibilities, std::uint32_t source);

}  // namespace oval4d::slicing
