#pragma once
// Cuts an object by six planes through a given point, one parallel to each pair of coordinate axes. The sections are
// the panels of a HyperSlice matrix (J. J. van Wijk and R. van Liere, "HyperSlice: visualization of scalar functions of
// many variables", 1993). The sections are exact: each is computed by cutting a slice by a second hyperplane.

#include <array>
#include <cstdint>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "geometry/rotation.hpp"
#include "slicing/object.hpp"
#include "slicing/slice_set.hpp"
#include "slicing/slicer.hpp"

namespace oval4d::slicing {

/// The section of an object by a plane: points, and edges between them.
///
/// The source number of a point or an edge says from which element of the object it was cut, as in SliceSet. Let the
/// polytope have E edges, F 2-faces and C cells. `pointSource` is the index of the 2-face that was cut, or F + e if
/// edge e of the polytope was cut, or F + E + v if vertex v lies in the plane. `edgeSource` is the index of the cell
/// that was cut, or C + f if the plane cuts 2-face f in a segment. For a point cloud, `pointSource` is the index of the
/// point; there are no edges.
struct PlanarSection {
    /// The coordinate axes to which the plane is parallel, as indices into x, y, z, w: axes[0] < axes[1].
    std::array<int, 2> axes{};
    /// The coordinates of each point along axes[0] and axes[1], in the units of the object.
    std::vector<glm::dvec2> points;
    std::vector<std::uint32_t> pointSource;
    /// Per point: the relative radius and the opacity of its ball, as in SliceSet.
    std::vector<float> ballScale, ballOpacity;
    std::vector<std::array<std::uint32_t, 2>> edges;  ///< per edge: the indices of its two points
    std::vector<std::uint32_t> edgeSource;
    /// If the edges form one closed polygon: the indices of its points in their order around the polygon. Otherwise
    /// empty.
    std::vector<std::uint32_t> boundary;
};

/// The axes of the planes xy, xz, yz, xw, yw and zw, in this order, as indices into x, y, z, w.
inline constexpr std::array<std::array<int, 2>, 6> kPlaneAxes{{{0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}}};

/// The sections of an object by the six planes of kPlaneAxes.
using PlanarSections = std::array<PlanarSection, kPlaneAxes.size()>;

/// Cuts objects by planes. Reuses its memory. Only one thread at a time may use a slicer.
class PlanarSlicer {
  public:
    /// Cuts `object`, rotated by `orientation`, by the six planes through `point`, and writes the sections to `out`.
    /// The coordinates of `point` are those after the rotation. `slices` must have been cut from the rotated object,
    /// and the hyperplane of slice number `slice` must contain `point`. Each plane is the intersection of two
    /// hyperplanes: the first cuts the object, and the second cuts the resulting slice. The section of a point cloud
    /// contains the points whose distance from each of the two hyperplanes is at most half the spacing of `slices`.
    /// Overwrites `out` and reuses its memory.
    void slice(const Object& object, const geometry::Rotation& orientation, const SliceSet& slices, int slice,
               const glm::dvec4& point, PlanarSections& out);

  private:
    // A point where the loop of a slice face crosses the second hyperplane (which cuts the slice).
    struct LoopCrossing {
        double along = 0;         // the position of the point along the line in which the plane meets the face
        int winding = 0;          // the change of the winding number at the crossing
        std::uint32_t point = 0;  // the index of the point in the section
    };

    void cut(const Object& object, const SliceSet& slices, int slice, const glm::dmat4& toObject, int axis,
             const glm::dvec4& point, PlanarSection& out);
    void cutEdges(const SliceSet& slices, int slice, std::uint32_t polytopeFaces, int axis, double at,
                  PlanarSection& out);
    void cutFaces(const SliceSet& slices, int slice, PlanarSection& out);
    void copyCloudPoints(const SliceSet& slices, int slice, int axis, double at, PlanarSection& out);
    static void findBoundary(PlanarSection& section);

    Slicer slicer_;
    SliceSet slice_;                    // the slice by a hyperplane z = const or y = const
    std::vector<glm::dvec4> vertices_;  // the vertices of the slice that is being cut
    // Per vertex of the slice: its signed distance from the second hyperplane (which cuts the slice). Distances of at
    // most kOnPlaneTolerance circumradii are stored as 0, except for a point cloud.
    std::vector<double> distance_;
    // Per vertex and per edge of the slice: the index of the section's point that was cut from it; kNone if there is
    // none.
    std::vector<std::uint32_t> pointOfVertex_;
    std::vector<std::uint32_t> pointOfEdge_;
    std::vector<LoopCrossing> crossings_;  // the crossings of the loops of one face
    bool zeroIsAbove_ = true;  // whether vertices in the second hyperplane (which cuts the slice) count as above it
};

}  // namespace oval4d::slicing
