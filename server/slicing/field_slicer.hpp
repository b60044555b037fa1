#pragma once
// Slices 4-D scalar fields, with the surfaces and the fog in each slice.

#include <array>

#include "fields/field.hpp"
#include "geometry/hyperplanes.hpp"
#include "geometry/rotation.hpp"
#include "parallel/fork_join.hpp"
#include "slicing/cell_complex_slicer.hpp"
#include "slicing/field_settings.hpp"
#include "slicing/slice_set.hpp"
#include "slicing/surface_detail.hpp"
#include "slicing/surfaces/surface_extractor.hpp"

namespace oval4d::slicing {

/// Slices fields. Cuts the domain, the box on which the field is defined, like a polytope. Then extracts the surfaces
/// and samples the fog in each slice of the domain. Reuses its memory. Only one thread at a time may use a slicer.
class FieldSlicer {
  public:
    /// If `forkJoin` is not null, the slicer uses it to process slices on two cores. `forkJoin` must outlive this
    /// object.
    explicit FieldSlicer(parallel::ForkJoin* forkJoin = nullptr) : forkJoin_(forkJoin), domains_(forkJoin) {}

    /// Slices `field`, rotated by `orientation`. Writes to `out` the vertices, edges and faces of the slices of
    /// field.domain and, for each slice, its surfaces and fog. `detail.steps` and `detail.fogSteps` must each have one
    /// entry per slice, or be empty. If `detail.steps` is empty, no surfaces are extracted; if `detail.fogSteps` or
    /// `settings.fog` is empty, no fog is sampled. Overwrites `out` and reuses its memory. Throws std::runtime_error if
    /// the samples are in a file that can no longer be read.
    void slice(const fields::Field& field, const geometry::Rotation& orientation, const geometry::Hyperplanes& planes,
               const FieldSettings& settings, const SurfaceDetail& detail, SliceSet& out);

  private:
    // The work that extractSurfacesAndFog() does for one slice.
    struct SliceTask {
        // `step` is the lattice step of the surfaces. `share` is the fraction of the SurfaceLimits that this slice may
        // use; if it is 0, no surfaces are extracted.
        double step = 0, share = 0;
        double fogStep = 0;  // the lattice step of the fog; if 0, no fog is sampled
    };
    // Extracts the surfaces and samples the fog of slice number `slice`. `worker` is the index of the members of
    // extractors_ and sections_ to use: 0 or 1, different for two threads that run at the same time.
    void extractSurfacesAndFog(const fields::Field& field, const glm::dmat4& toFunction, const FieldSettings& settings,
                               const SurfaceDetail& detail, const SliceTask& task, int slice, SliceSet& out,
                               std::size_t worker);
    static double fogCoarsening(const fields::Field& field, const SurfaceDetail& detail, const SliceSet& slices);

    parallel::ForkJoin* forkJoin_;
    CellComplexSlicer domains_;
    // One extractor for each of two threads; sections_ has one section for each of them.
    std::array<SurfaceExtractor, 2> extractors_;
    std::array<FieldSection, 2> sections_;
};

}  // namespace oval4d::slicing
