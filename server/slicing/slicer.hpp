#pragma once

#include "geometry/hyperplanes.hpp"
#include "geometry/rotation.hpp"
#include "parallel/fork_join.hpp"
#include "parallel/ownership.hpp"
#include "slicing/cloud_slicer.hpp"
#include "slicing/object.hpp"
#include "slicing/polytope_slicer.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

/// Slices objects of any kind by parallel hyperplanes w = const, with one slicer for each kind. Reuses its scratch
/// memory, so that repeated calls of similar size allocate nothing. A slicer may be used by one thread at a time.
class Slicer {
  public:
    /// Slices large convex polytopes on two cores if `forkJoin` is not null. `forkJoin` must outlive this object.
    explicit Slicer(parallel::ForkJoin* forkJoin = nullptr) : polytopes_(forkJoin) {}

    /// Slices `object` rotated by `orientation`. Overwrites `out` and reuses its memory.
    void slice(const Object& object, const geometry::Rotation& orientation, const geometry::Hyperplanes& planes,
               SliceSet& out);

  private:
    PolytopeSlicer polytopes_;
    CloudSlicer clouds_;
    parallel::OneAtATime inUse_;
};

}  // namespace oval4d::slicing
