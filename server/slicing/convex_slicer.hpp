#pragma once
// Fast slicing of convex polytopes.

#include <cstdint>
#include <span>
#include <vector>

#include "parallel/fork_join.hpp"
#include "polytopes/polytope.hpp"
#include "slicing/degeneracy_collapse.hpp"
#include "slicing/slice_set.hpp"
#include "slicing/sweep.hpp"
#include "slicing/vertex_ranks.hpp"

namespace oval4d::slicing {

/// Slices convex polytopes with a sweep. Splits the hyperplanes of a large polytope into a lower and an upper half and
/// sweeps both halves at the same time, on two cores. Reuses its scratch memory between calls.
class ConvexSlicer {
  public:
    /// `forkJoin` must outlive this object. If it is null, everything runs on the calling thread.
    explicit ConvexSlicer(parallel::ForkJoin* forkJoin) : forkJoin_(forkJoin) {}

    /// Slices `polytope` and writes the slices to `out`, whose `planes` and `rotatedVertices` must be set. `ranks`
    /// locates the rotated vertices relative to these hyperplanes. For `touching`, see Sweep::cut. Returns false, and
    /// leaves `out` unusable, if rounding errors in the vertices make a hyperplane cut a 2-face or a cell twice; the
    /// caller must then use a method for nonconvex polytopes.
    bool cut(const polytopes::Polytope& polytope, VertexRanks ranks, std::span<SliceSet* const> touching,
             SliceSet& out);

  private:
    // The lower or upper half of the hyperplanes.
    struct Half {
        Sweep sweep;
        std::vector<std::int32_t> below;  // like VertexRanks::below, but for the hyperplanes of this half only
        SliceCounts end;                  // the position in `out` at which its next slice begins
        bool sound = false;               // whether the last call of a function of `sweep` succeeded
    };
    bool cutHalves(const polytopes::Polytope& polytope, VertexRanks ranks, SliceSet& out);

    parallel::ForkJoin* forkJoin_;
    Half lower_, upper_;
};

}  // namespace oval4d::slicing
