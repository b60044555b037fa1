#pragma once

#include "geometry/hyperplanes.hpp"
#include "geometry/rotation.hpp"
#include "parallel/fork_join.hpp"
#include "parallel/ownership.hpp"
#include "slicing/cell_complex_slicer.hpp"
#include "slicing/cloud_slicer.hpp"
#include "slicing/field_settings.hpp"
#include "slicing/field_slicer.hpp"
#include "slicing/object.hpp"
#include "slicing/slice_set.hpp"
#include "slicing/surface_detail.hpp"

namespace oval4d::slicing {

/// Slices objects of any kind by parallel hyperplanes w = const. Reuses its memory, so that repeated calls of similar
/// size allocate nothing. Only one thread at a time may use a slicer.
class Slicer {
  public:
    /// If `forkJoin` is not null, the slicer uses it to slice large convex polytopes and fields on two cores.
    /// `forkJoin` must outlive this object.
    explicit Slicer(parallel::ForkJoin* forkJoin = nullptr) : complexes_(forkJoin), fields_(forkJoin) {}

    /// Slices `object`, rotated by `orientation`, by all hyperplanes of `planes`, and writes the slices to `out`. For a
    /// field, extracts the surfaces and samples the fog as `settings` and `detail` specify; other objects do not use
    /// these arguments. Overwrites `out` and reuses its memory. Throws std::runtime_error if the samples of a field are
    /// in a file that can no longer be read.
    void slice(const Object& object, const geometry::Rotation& orientation, const geometry::Hyperplanes& planes,
               const FieldSettings& settings, const SurfaceDetail& detail, SliceSet& out);

    /// Slices `object` like slice(), but without the surfaces and the fog of a field.
    void sliceWithoutSurfaces(const Object& object, const geometry::Rotation& orientation,
                              const geometry::Hyperplanes& planes, SliceSet& out);

  private:
    CellComplexSlicer complexes_;
    CloudSlicer clouds_;
    FieldSlicer fields_;
    parallel::ExclusiveUseAssertion inUse_;
};

}  // namespace oval4d::slicing
