#pragma once
// Projects an object and its slices from four to three dimensions.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "geometry/rotation.hpp"
#include "slicing/object.hpp"
#include "slicing/occlusion.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

/// A projection from R⁴ onto the hyperplane w = 0. It is either a perspective projection from an eye on the positive w
/// axis, or the orthogonal projection along the w axis. See A. M. Noll, "A computer technique for displaying
/// n-dimensional hyperobjects", 1967.
struct ProjectionToHyperplane {
    double inverseDistance = 0;  ///< 1 / (the w coordinate of the eye); 0 for the orthogonal projection

    /// Returns the factor by which the projection magnifies what lies in the hyperplane with this w. The hyperplane
    /// must be below the eye.
    double magnification(double w) const { return 1 / (1 - w * inverseDistance); }
    /// Returns the projection of the point p.
    glm::dvec3 operator()(const glm::dvec4& p) const { return glm::dvec3(p) * magnification(p.w); }
    /// Returns the projection of the point p as x, y and z. The fourth coordinate is a height that increases toward the
    /// eye along each line of sight (see ProjectedCells).
    glm::dvec4 projectWithHeight(const glm::dvec4& p) const { return p * magnification(p.w); }
    bool operator==(const ProjectionToHyperplane&) const = default;
};

/// Projects an object together with some of its slices. Caches the hyperplanes of the cells of the last object, and
/// which of its elements are hidden. Reuses its memory. Only one thread at a time may use a projector.
class Projector {
  public:
    /// Says what to project, and how.
    struct ProjectionOptions {
        ProjectionToHyperplane projection;
        /// Whether to write the 2-faces of the object: those that bound the projected cells or, for a surface, all
        /// 2-faces. The loop of a 2-face that is not convex may cross itself, and that of a surface need not be flat;
        /// FaceFiller fills such loops.
        bool cells = false;
        /// Whether to leave out what the 4-D eye cannot see. This depends on the object:
        /// - Of a convex object, the elements are left out that belong only to cells whose outer sides are turned away
        ///   from the eye.
        /// - Of another object, what lies behind other cells is left out, too: whole 2-faces, and parts of edges (see
        ///   OcclusionFinder::findDrawnElements()).
        /// - If cells are hidden, the eye sees the inner sides of other cells through the gaps. What belongs only to
        ///   hidden cells is left out, and what lies behind the cells that are not hidden.
        /// - Of an object without cells, nothing is left out.
        bool culled = false;
        /// The types of cells that are hidden, and therefore hide nothing: sorted indices into ObjectInfo::cellTypes.
        std::span<const std::uint32_t> hiddenTypes = {};
        /// The maximum number of steps to find what lies behind other cells. If they are too few, only what belongs to
        /// cells turned away is left out.
        std::size_t occlusionSteps = OcclusionFinder::kDefaultSteps;
        int firstSlice = 0, endSlice = 0;  ///< the slices with the indices firstSlice … endSlice − 1 are projected
    };

    /// Writes the projection of `object` to part 0 of `out`, and the projections of the slices to the parts that
    /// follow. Part i is stored like slice i of a SliceSet; `out.planes` and `out.rotatedVertices` are not used.
    /// `slices` must have been cut from `object` rotated by `orientation`. In part 0, the source number of a vertex,
    /// edge or 2-face is the one that it would have in a slice whose hyperplane contains it (see SliceSet). If an edge
    /// is hidden in part, each part that is seen is an edge of `out` with the source number of the edge. Where such a
    /// part ends within the edge, it has a vertex without a ball. The source number of this vertex is that of a vertex
    /// cut from the edge. Hidden corners of 2-faces that are seen have no balls, either (see SliceSet::hasBall()), and
    /// the entries of SliceSet::cornerEdges for hidden sides are kNone.
    ///
    /// Writes one entry to `faceCells` for each face in `out`. For a 2-face in part 0, the entry is the cell that
    /// determines the color of the 2-face. If one of its two cells is hidden, this is the other one. Otherwise, it is
    /// the first one, unless only the second one is turned toward the eye. If the object has no cells, the entry is the
    /// index of the 2-face. For a face of a slice, it is the source number of the face. Overwrites `out` and
    /// `faceCells`.
    void project(const Object& object, const geometry::Rotation& orientation, const SliceSet& slices,
                 const ProjectionOptions& options, SliceSet& out, std::vector<std::uint32_t>& faceCells);

    /// Returns whether ProjectionOptions::occlusionSteps were too few in the last call of project(). If so, project()
    /// left out only elements that belong only to cells turned away from the eye.
    bool exceededOcclusionSteps() const { return lacksSteps_; }

  private:
    // All data that determine which elements are hidden.
    struct OcclusionInput {
        std::uint64_t object = 0;  // the serial number of the object
        geometry::Rotation orientation;
        ProjectionToHyperplane projection;
        bool withFaces = false;
        std::vector<std::uint32_t> hiddenTypes;
        std::size_t steps = 0;
        bool operator==(const OcclusionInput&) const = default;
    };

    void findFacingCells(const Object& object, const geometry::Rotation& orientation,
                         const ProjectionToHyperplane& projection);
    bool findHidingCells(const geometry::CellComplex& complex, std::span<const std::uint32_t> hiddenTypes);
    const DrawnElements* findUnhiddenElements(const geometry::CellComplex& complex,
                                              const geometry::Rotation& orientation, const SliceSet& slices,
                                              const ProjectionOptions& options);
    void addSlice(const SliceSet& slices, int slice, const ProjectionToHyperplane& projection, SliceSet& out,
                  std::vector<std::uint32_t>& faceCells);

    std::uint64_t object_ = 0;               // the serial number of the object to which normals_ and offsets_ belong
    std::vector<glm::dvec4> normals_;        // per cell: its outward normal, before the rotation, not normalized
    std::vector<double> offsets_;            // per cell: the dot product of its normal and any point of the cell
    std::vector<bool> cellIsFacing_;         // per cell: whether its outer side is turned toward the eye
    std::vector<std::uint32_t> number_;      // per vertex of the object: its index in part 0, or kNone
    std::vector<std::uint32_t> edgeNumber_;  // per edge of the object: its index in part 0, or kNone

    bool lacksSteps_ = false;  // see exceededOcclusionSteps()
    // The roles of the cells of the last object. `drawn` is valid only during findUnhiddenElements().
    DrawnAndHidingCells roles_;
    OcclusionFinder occlusion_;
    // The data for which unhidden_ and occlusionFound_ were computed; empty if these are not valid.
    std::optional<OcclusionInput> occlusionInput_;
    bool occlusionFound_ = false;  // whether the steps were enough to find unhidden_
    DrawnElements unhidden_;       // valid only if occlusionFound_ is true
    std::vector<glm::dvec4> images_;
};

}  // namespace oval4d::slicing
