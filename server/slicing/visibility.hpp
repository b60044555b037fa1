#pragma once
// The visibility of the elements of a slice.

#include <cstdint>
#include <span>
#include <vector>

#include "slicing/object.hpp"

namespace oval4d::slicing {

enum class Visibility : std::uint8_t { hidden, faded, full };

/// The factor by which a visibility multiplies the opacity of a shape.
constexpr double opacityOf(Visibility visibility) {
    return visibility == Visibility::full ? 1 : visibility == Visibility::faded ? 0.25 : 0;
}

/// The visibility of the polytope's elements, indexed by the source numbers of slice elements (see SliceSet). A cell
/// has the visibility of its type; any other element has the greatest visibility of the cells that contain it. The
/// lists are empty if everything is fully visible.
struct Visibilities {
    std::vector<Visibility> vertices, edges, faces;

    bool all() const { return faces.empty(); }
    Visibility vertex(std::uint32_t source) const { return vertices.empty() ? Visibility::full : vertices[source]; }
    Visibility edge(std::uint32_t source) const { return edges.empty() ? Visibility::full : edges[source]; }
    Visibility face(std::uint32_t source) const { return faces.empty() ? Visibility::full : faces[source]; }
};

/// Derives the visibility of all elements from that of each cell type. Overwrites `out`.
void findVisibilities(const Object& object, std::span<const Visibility> ofType, Visibilities& out);

/// The cell whose color a slice face with this source number has: the cell that was cut or, for a 2-face in the
/// hyperplane, the first of its two cells that is not hidden.
std::uint32_t coloringCell(const Object& object, const Visibilities& visibilities, std::uint32_t source);

}  // namespace oval4d::slicing
