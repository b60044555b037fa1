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

namespace oval4d::slicing {

/// Slices convex polytopes with a sweep. Large ones are swept on two cores at once, one for the lower hyperplanes and
/// one for the upper ones. Reuses its scratch memory between calls.
class ConvexSlicer {
  public:
    explicit ConvexSlicer(parallel::ForkJoin* forkJoin) : forkJoin_(forkJoin) {}

    /// Fills `out`, whose hyperplanes and rotated vertices must be set. For `touching`, see Sweep::cut. Returns false,
    /// and leaves `out` unusable, if rounding errors in the vertices make a hyperplane cut a 2-face or a cell twice.
    bool cut(const polytopes::Polytope& polytope, Levels levels, std::span<SliceSet* const> touching, SliceSet& out);

  private:
    struct Half {
        Sweep sweep;
        std::vector<std::int32_t> below;  // as Levels::below, for the hyperplanes of this half
        ElementCounts end;
        bool sound = false;
    };
    bool cutHalves(const polytopes::Polytope& polytope, Levels levels, SliceSet& out);

    parallel::ForkJoin* forkJoin_;
    Half lower_, upper_;
};

}  // namespace oval4d::slicing
