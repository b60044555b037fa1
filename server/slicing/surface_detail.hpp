#pragma once
// Settings and limits of the lattices on which the surfaces and the fog of a field are sampled.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/hyperplanes.hpp"

namespace oval4d::slicing {

/// The quality of a picture or a file that shows a field. The quality does not affect pictures and files of other
/// objects.
enum class Quality : std::uint8_t {
    draft,  ///< coarser surfaces, for a picture that a better one soon replaces
    full,   ///< the quality of any picture that is not a draft
    file,   ///< finer surfaces, for exported files
};

/// The lattices on which the surfaces and the fog of a field are sampled.
struct SurfaceDetail {
    /// Per slice: the distance between neighboring lattice points of the surfaces, in the units of the object; 0 if the
    /// surfaces of this slice are not needed. Empty if no surfaces are needed.
    std::vector<double> steps;
    /// The quality determines the limits on time and on the number of points. In drafts, surfaces may lack details of
    /// the function that are smaller than the lattice steps (see ScalarFunction::downsampledForSteps()).
    Quality quality = Quality::full;
    /// Per slice: the distance between neighboring lattice points of the fog, in the units of the object; 0 if the fog
    /// of this slice is not needed. Empty if no fog is needed.
    std::vector<double> fogSteps = {};
    /// Whether only the topology of the surfaces is needed. If true, the points of the surfaces lie only roughly on the
    /// levels, and have no normals, growth or values.
    bool topologyOnly = false;
    bool secondValues = false;  ///< whether the points need the values of the field's second function
    /// Whether slices with smooth surfaces are sampled with kSmoothStepFactor times their step.
    bool largerStepsWhereSmooth = false;
};

/// The factor by which SurfaceDetail::largerStepsWhereSmooth enlarges the lattice step of slices with smooth surfaces.
/// The eye sees no difference: see isSmooth().
inline constexpr double kSmoothStepFactor = 1.5;

/// Limits on the surfaces of all slices of a picture or file together. If the surfaces would exceed a limit, the
/// lattices are made coarser. `time` limits the estimated time to extract the surfaces on one core, in nanoseconds.
/// `points` limits the number of their points.
struct SurfaceLimits {
    double time;
    std::size_t points;
};

constexpr SurfaceLimits surfaceLimits(Quality quality) {
    if (quality == Quality::file) return {1.5e9, 400'000};
    return quality == Quality::full ? SurfaceLimits{1.5e8, 600'000} : SurfaceLimits{3e7, 80'000};
}

/// Returns the maximum number of points of the fog lattices of all slices of a picture together. The lattices are made
/// coarser to meet this limit, and so that sampling them takes no longer than surfaceLimits(quality).time. A point
/// takes one byte in a message, and two bytes of texture memory in a rendered picture.
constexpr std::size_t maxFogSamples(Quality quality) { return quality == Quality::draft ? 250'000 : 2'000'000; }

/// Returns the intended width, in pixels, of a lattice cube of the surfaces (see SurfaceDetail::steps) in a rendered
/// picture, and of a lattice square of the contours. A draft has wider cubes, so that it takes less time. Messages and
/// files use cubesAcrossDiameter() instead.
constexpr double pixelsPerCube(Quality quality) { return quality == Quality::full ? 3 : 4.5; }

/// Returns the number of lattice cubes across the diameter of a field's circumscribed sphere, for messages and files.
/// Rendered pictures use pixelsPerCube() instead; in full quality, they have at least as many cubes as messages.
constexpr int cubesAcrossDiameter(Quality quality) {
    return quality == Quality::file ? 160 : quality == Quality::full ? 48 : 32;
}

/// Returns the lattice step of surfaces in messages and files, in the units of an object with this circumradius.
constexpr double uniformStep(double circumradius, Quality quality) {
    return 2 * circumradius / cubesAcrossDiameter(quality);
}

/// Sets `out` for messages and files. Sets the lattice step of the surfaces in all slices to uniformStep(), and sets
/// the quality. Clears the steps of the fog, so that no fog is sampled.
inline void setUniformDetail(double circumradius, const geometry::Hyperplanes& planes, Quality quality,
                             SurfaceDetail& out) {
    out.steps.assign(static_cast<std::size_t>(planes.count), uniformStep(circumradius, quality));
    out.fogSteps.clear();
    out.quality = quality;
    out.largerStepsWhereSmooth = false;
}

/// Sets the lattice step of the fog in all slices, for messages, to half the step that setUniformDetail() sets for
/// surfaces of the quality `out.quality`. Surfaces are accurate even with the larger step, because their points are
/// moved onto the level after sampling.
inline void setUniformFogSteps(double circumradius, const geometry::Hyperplanes& planes, SurfaceDetail& out) {
    out.fogSteps.assign(static_cast<std::size_t>(planes.count), circumradius / cubesAcrossDiameter(out.quality));
}

}  // namespace oval4d::slicing
