#pragma once
// Names of the polyhedra that appear as slices, such as "icosahedron".

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "geometry/rotation.hpp"
#include "slicing/object.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

/// The names of a section.
struct SectionNames {
    std::string_view slice;     ///< as SectionNamer::nameOfSlice returns it
    std::string_view vertices;  ///< as SectionNamer::nameOfVertices returns it
    bool operator==(const SectionNames&) const = default;
};

/// Names slices, and the vertices of a polytope that lie in a hyperplane. Names only what is similar to one of the
/// following shapes, with errors of at most 1e-6 of the circumradius: the point, the segment, the regular polygons, the
/// Platonic and Archimedean solids, the uniform prisms and antiprisms (like the polygons, of up to 20 sides), and the
/// rhombic dodecahedron, which is the middle section of the 24-cell beginning with a vertex. Everything else has no
/// name, including every slice that is not convex or has several components.
///
/// A slice whose numbers of vertices, edges and faces no named shape has takes 0.1 µs, however large it is. A named
/// slice of V vertices takes time proportional to V² log V: an octahedron 0.2 µs, an icosahedron 0.7 µs, a
/// rhombicosidodecahedron 20 µs, a truncated icosidodecahedron 300 µs. The first call in the process takes 5 ms longer.
/// Repeated calls allocate no memory. A namer may be used by one thread at a time.
class SectionNamer {
  public:
    /// Returns false if the section of `object`, rotated by `orientation`, at this w certainly has no name. This is so
    /// for a point cloud, and if both the number of vertices in the hyperplane, and this number plus the number of
    /// edges that cross the hyperplane, are 0 or greater than the number of vertices of any named shape. Takes time
    /// linear in the number of edges, much less than cutting the slice.
    static bool mayHaveName(const Object& object, const geometry::Rotation& orientation, double w);

    /// Returns the name of slice number `slice`, such as "truncated tetrahedron", or an empty string if it has none.
    /// The name is valid until the process ends.
    std::string_view nameOfSlice(const SliceSet& slices, int slice);

    /// Returns the name of the convex hull of those vertices of the polytope that lie in the hyperplane of slice number
    /// `slice`, or an empty string if it has none. These are the sections of Coxeter's tables (Regular Polytopes, §13.1
    /// and table V). The slice has more vertices if edges of the polytope cross the hyperplane: the 600-cell beginning
    /// with a vertex has a dodecahedron as the second section after the point, but the slice there has 32 vertices.
    /// `edges` is the number of edges of the polytope; 0 for a point cloud. The name is valid until the process ends.
    /// Takes time linear in the number of the slice's vertices, and the time to compare those in the hyperplane.
    std::string_view nameOfVertices(const SliceSet& slices, int slice, std::size_t edges);

    /// Returns whether a name that these functions have returned is that of a polyhedron, not a point, segment or
    /// polygon.
    static bool isSolid(std::string_view name);

  private:
    struct Shape;
    static const std::vector<Shape>& shapes();
    bool edgesHaveLength(std::span<const std::array<std::uint32_t, 2>> edges, double length) const;
    bool verticesAreThoseOf(const Shape& shape);

    std::vector<glm::dvec3> vertices_;  // the vertices to be named; their center is 0 and their circumradius is 1
    std::vector<double> distances_;     // of one vertex from all vertices
};

}  // namespace oval4d::slicing
