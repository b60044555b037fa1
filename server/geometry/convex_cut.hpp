#pragma once
// The usual case of a cut, made fast: a convex polytope.

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/polytope.hpp"
#include "geometry/settling.hpp"
#include "geometry/slice_set.hpp"
#include "geometry/sweep.hpp"

namespace oval4d::geometry {

/// Sweeps through a polytope; where that is much to do on two cores at once, the lower and the upper hyperplanes. Keeps
/// its scratch memory between calls.
class ConvexCut {
  public:
    /// Fills `out`, whose hyperplanes and turned vertices are there. `touching` as of Sweep::cut. False, and `out` is
    /// of no use, where rounding errors in the vertices make it so that a hyperplane cuts a 2-face or a cell twice.
    bool cut(const Polytope& polytope, Levels levels, std::span<SliceSet* const> touching, SliceSet& out);

  private:
    struct Half {
        Sweep sweep;
        std::vector<std::int32_t> below;  // of its hyperplanes alone
        SliceSize end;
        bool sound = false;
    };
    bool cutHalves(const Polytope& polytope, Levels levels, SliceSet& out);

    Half lower_, upper_;
};

}  // namespace oval4d::geometry
