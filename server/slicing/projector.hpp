#pragma once
// Projections of whole objects, and of their slices, from four to three dimensions.

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "geometry/rotation.hpp"
#include "slicing/object.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

/// A projection from R⁴ onto the hyperplane w = 0: from an eye on the positive w axis (perspective), or parallel to the
/// w axis (orthogonal). See A. M. Noll, "A computer technique for displaying n-dimensional hyperobjects", 1967.
struct HyperplaneProjection {
    double inverseDistance = 0;  ///< 1 / (the w coordinate of the eye), for the orthogonal projection 0

    /// Returns the factor by which the projection magnifies the hyperplane with this w. Requires that the eye lies
    /// above the hyperplane.
    double magnification(double w) const { return 1 / (1 - w * inverseDistance); }
    /// Returns the projection of a point.
    glm::dvec3 operator()(const glm::dvec4& p) const { return glm::dvec3(p) * magnification(p.w); }
};

/// Projects an object together with some of its slices. Keeps the hyperplanes of the object's cells, and reuses its
/// memory. A projector may be used by one thread at a time.
class Projector {
  public:
    struct Options {
        HyperplaneProjection projection;
        /// Whether to write the 2-faces of the object, which bound the projected cells. If any of them is not convex,
        /// none is written.
        bool cells = false;
        /// Whether the elements that the 4-D eye cannot see are left out. The eye sees an element if it sees the outer
        /// side of at least one cell that contains the element.
        bool culled = false;
        int firstSlice = 0, endSlice = 0;  ///< the slices to project are firstSlice … endSlice − 1 of the set
    };

    /// Writes the projection of `object` to part 0 of `out`, and the projections of the slices to the following parts.
    /// Part i is stored like slice i of a SliceSet; SliceSet::planes is not used. `slices` must have been cut from
    /// `object` rotated by `orientation`. In part 0, the source number of a vertex, edge or 2-face of the object is the
    /// one that it has in a slice whose hyperplane contains it (see SliceSet). Writes one entry to `faceCells` for each
    /// face in `out`. For a 2-face in part 0, the entry is the cell that determines its color: the second of its two
    /// cells if only that one is turned toward the eye, else the first. For a face of a slice, the entry is its source
    /// number. Overwrites `out` and `faceCells`.
    void project(const Object& object, const geometry::Rotation& orientation, const SliceSet& slices,
                 const Options& options, SliceSet& out, std::vector<std::uint32_t>& faceCells);

  private:
    void findFacingCells(const Object& object, const geometry::Rotation& orientation,
                         const HyperplaneProjection& projection);
    void addSlice(const SliceSet& slices, int slice, const HyperplaneProjection& projection, SliceSet& out,
                  std::vector<std::uint32_t>& faceCells);

    std::uint64_t object_ = 0;           // the serial number of the object of hyperplanes_
    std::vector<glm::dvec4> normals_;    // per cell, unrotated, not normalized
    std::vector<double> offsets_;        // per cell: the product of its normal and any of its points
    std::vector<bool> cellFaces_;        // per cell: whether its outer side is turned toward the eye
    std::vector<std::uint32_t> number_;  // per vertex of the object: its index in part 0, or kNone
    std::vector<std::uint32_t> edgeNumber_;
};

}  // namespace oval4d::slicing
