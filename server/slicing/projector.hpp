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
        /// Whether the 2-faces are wanted, which bound the projected cells. They are left out if any is not convex.
        bool cells = false;
        /// Whether elements are left out that the 4-D eye cannot see: those that belong only to cells whose outer side
        /// is turned away from it.
        bool culled = false;
        int firstSlice = 0, endSlice = 0;  ///< the slices to project are firstSlice … endSlice − 1 of the set
    };

    /// Writes the projection of `object` as part 0 of `out`, and those of the slices as the next parts. A part is
    /// stored as a slice, and SliceSet::planes is not used. `slices` must have been cut from `object` rotated by
    /// `orientation`. The source numbers of elements are those of slices that lie in a hyperplane (see SliceSet); so a
    /// vertex, edge or 2-face of the object has the same number in part 0 and in a slice. For each 2-face in part 0,
    /// writes to `faceCells` the cell whose color it has: the one that is turned toward the eye, or the first of the
    /// two; for faces of slices their source.
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
