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

/// The two names of the section of an object by a hyperplane. The names may differ: the slice also has vertices at the
/// points where edges of the object cross the hyperplane, and only `slice` takes these points into account.
struct SliceAndHullNames {
    std::string_view slice;  ///< the name of the slice: the result of SectionNamer::nameOfSlice()
    /// The name of the convex hull of the object's vertices in the hyperplane: the result of
    /// SectionNamer::nameOfHullOfObjectVertices().
    std::string_view vertices;
    bool operator==(const SliceAndHullNames&) const = default;
};

/// The names of a section, with the object, orientation and hyperplane that determine them.
struct NamedSection {
    std::uint64_t object = 0;  ///< the serial number of the object
    geometry::Rotation orientation;
    double w = 0;  ///< the w coordinate of the hyperplane
    SliceAndHullNames names;

    /// Returns whether this is the section of `shown`, rotated by `rotation`, by the hyperplane w = `focusW`.
    bool isSectionOf(const Object& shown, const geometry::Rotation& rotation, double focusW) const;
};

/// Names slices, and the convex hulls of the vertices of an object that lie in a hyperplane. Names only shapes that are
/// geometrically similar to one of the following, with errors of at most 1e-6 of the circumradius of the shape:
/// - the point, the segment, and the regular polygons with up to 20 sides;
/// - the Platonic, Archimedean, Catalan and Kepler–Poinsot solids;
/// - the cuboids;
/// - the right prisms, antiprisms, pyramids and bipyramids of any height over regular polygons with up to 20 sides;
/// - the duals of the uniform antiprisms over these polygons;
/// - the right prisms of any height over regular star polygons with up to 20 sides.
///
/// All other shapes have no name, such as other nonconvex shapes and shapes with several components.
///
/// If no named shape has the same numbers of vertices, edges and faces as a slice, a call of nameOfSlice() takes less
/// than 1 µs, regardless of the size of the slice. Otherwise the time is proportional to V² log V for V vertices: 0.2
/// µs for an octahedron, 0.7 µs for an icosahedron, 20 µs for a rhombicosidodecahedron, 300 µs for a truncated
/// icosidodecahedron. The first call in the process takes some milliseconds longer. Repeated calls allocate memory only
/// if a slice may be a cuboid, prism, antiprism, pyramid or bipyramid. Only one thread at a time may use a namer.
class SectionNamer {
  public:
    /// Tests quickly, without cutting the object, whether a section may have a name. Returns false if the section of
    /// `object`, rotated by `orientation`, by the hyperplane w = `w` certainly has neither of the names in
    /// SliceAndHullNames. The result depends on two numbers: n, the number of the object's vertices in the hyperplane,
    /// and m, the number of edges that cross it. The slice has n + m vertices, and the second name depends only on the
    /// n vertices. So the result is true if n or n + m is between 1 and the vertex count of the largest named shape.
    /// For objects whose sections have no names (see ObjectKindProperties), such as fields, the result is always false.
    /// Takes time linear in the numbers of vertices and edges.
    static bool mayHaveName(const Object& object, const geometry::Rotation& orientation, double w);

    /// Returns the name of slice number `slice`, such as "truncated tetrahedron", or an empty string if the slice has
    /// no name. The string is valid until the process ends.
    std::string_view nameOfSlice(const SliceSet& slices, int slice);

    /// Returns the name of the convex hull of those vertices of slice number `slice` that are vertices of the polytope,
    /// or an empty string if the hull has no name. These hulls are the sections in Coxeter's tables (Regular Polytopes,
    /// §13.1 and table V). The slice has more vertices than the hull if edges of the polytope cross the hyperplane. For
    /// example, the second section of the vertex-first 600-cell after the point is a dodecahedron, but the slice there
    /// has 32 vertices. `edges` is the number of edges of the polytope. The string is valid until the process ends.
    /// Takes time linear in the number of the slice's vertices, plus the time to compare the polytope's vertices with
    /// the named shapes.
    std::string_view nameOfHullOfObjectVertices(const SliceSet& slices, int slice, std::size_t edges);

    /// Returns whether `name`, a result of the functions above, is the name of a polyhedron. Returns false for the
    /// names of the point, the segment and the polygons, and for an empty string.
    static bool isSolidName(std::string_view name);

  private:
    struct NamedShape;
    struct PolyhedronFamily;
    static const std::vector<NamedShape>& knownShapes();
    static const std::vector<PolyhedronFamily>& families();
    std::string_view nameOfFamily(const SliceSet& slices, int slice, bool withStars);
    bool haveEdgeLengthsOf(const NamedShape& shape, std::span<const std::array<std::uint32_t, 2>> edges) const;
    bool verticesAreThoseOf(const NamedShape& shape);

    // The vertices of the shape to be named, moved and scaled so that their center is 0 and their circumradius is 1.
    std::vector<glm::dvec3> vertices_;
    std::vector<double> distances_;  // the distances of one vertex from all vertices, in ascending order
    std::vector<double> lengths_;    // the lengths of the slice's edges, in ascending order
};

}  // namespace oval4d::slicing
