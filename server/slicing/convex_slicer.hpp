#pragma once
// Slices convex polytopes, faster than the general method of CellComplexSlicer.

#include <cstdint>
#include <span>
#include <vector>

#include "parallel/fork_join.hpp"
#include "polytopes/polytope.hpp"
#include "slicing/degeneracy_collapse.hpp"
#include "slicing/planes_below_vertices.hpp"
#include "slicing/slice_set.hpp"
#include "slicing/sweep.hpp"

namespace oval4d::slicing {

/// Slices convex polytopes with a sweep of a hyperplane (see HyperplaneSweep). If a polytope is large and none of its
/// vertices lies in a hyperplane, sweeps through the lower and the upper half of the hyperplanes in parallel, on two
/// cores. Reuses its memory.
class ConvexSlicer {
  public:
    /// If `forkJoin` is not null, the slicer may use it to work on two cores; `forkJoin` must outlive this object. If
    /// it is null, all work is done on the calling thread.
    explicit ConvexSlicer(parallel::ForkJoin* forkJoin) : forkJoin_(forkJoin) {}

    /// Slices `polytope` and writes the slices to `out`, whose `planes` and `rotatedVertices` must be set.
    /// `planesBelow` says how many of these hyperplanes lie below each rotated vertex. If the polytope touches
    /// hyperplanes from one side, `touching` must contain the slices in these hyperplanes (see HyperplaneSweep::cut());
    /// otherwise it may be empty.
    ///
    /// Returns false, and leaves `out` unusable, if rounding errors in the vertices make a hyperplane cut a 2-face in
    /// several segments or a cell in several polygons. The caller must then use a method for nonconvex polytopes.
    bool cut(const polytopes::Polytope& polytope, PlanesBelowVertices planesBelow, std::span<SliceSet* const> touching,
             SliceSet& out);

  private:
    // The sweep through the lower or upper half of the hyperplanes, and its results.
    struct HalfSweep {
        HyperplaneSweep sweep;
        std::vector<std::int32_t> below;  // per vertex: the number of hyperplanes of this half below it
        // Where the slices of this half end in the output; before sweep.cut(), where they begin.
        SliceElementCounts end;
        bool sound = false;  // what the last call of sweep.begin() or sweep.cut() returned
    };
    bool cutInTwoSweeps(const polytopes::Polytope& polytope, PlanesBelowVertices planesBelow, SliceSet& out);

    parallel::ForkJoin* forkJoin_;
    HalfSweep lower_, upper_;
};

}  // namespace oval4d::slicing
