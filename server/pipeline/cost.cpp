#include "pipeline/cost.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fields/array/array_function.hpp"
#include "fields/field.hpp"
#include "scene/pick_level.hpp"
#include "scene/surface_look.hpp"
#include "slicing/closed_surfaces/closed_surface_slicer.hpp"
#include "slicing/planar_contours.hpp"

namespace oval4d::pipeline {

namespace {

double totalElementCount(const slicing::Object& object) {
    const auto counts = slicing::elementCounts(object);
    return static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::size_t{0}));
}

/// Returns approximately how many elements a hyperplane cuts in a polytope that has n elements (vertices, edges, faces
/// and cells). The elements form a three-dimensional boundary, and the hyperplane cuts this boundary in a
/// two-dimensional surface. Hence the exponent 2/3.
double estimateElementsCut(double n) { return std::pow(n, 2.0 / 3); }

/// Returns the estimated time, in seconds, to extract the surfaces of a field and to draw or write them. Returns 0 for
/// other objects, and if faces are hidden. `slices` is the number of slices, and `cubes` the number of lattice cubes
/// across the diameter of the field.
double surfaceSeconds(const scene::PictureRequest& picture, double slices, double cubes, slicing::Quality quality) {
    const fields::Field* field = slicing::fieldIn(picture.object);
    if (field == nullptr || !picture.look.parts.faces) return 0;
    const slicing::SurfaceLimits limits = slicing::surfaceLimits(quality);
    const fields::EvaluationCost cost = field->function->cost();
    // A surface is assumed to cross 1.5 times as many lattice cubes as a plane through the field, and to have one point
    // in each of these cubes. About three lattice points are sampled for each point of the surface.
    const double points = 1.5 * slices * cubes * cubes * static_cast<double>(picture.look.field.levels.size());
    const bool isColored = field->second != nullptr && scene::colorsByValue(picture.look);
    const double coloring = isColored ? field->second->function->cost().value : 0;
    const double extraction = points * (3 * cost.value + 2 * cost.gradient + 60 + cost.bounds / 16 + coloring);
    return 1e-9 * std::min(limits.time, extraction) + 1.5e-7 * std::min(points, static_cast<double>(limits.points));
}

/// Returns the estimated time, in seconds, to make exact surfaces of a field and to write them. Returns 0 for other
/// objects.
double exactSurfaceSeconds(const scene::PictureRequest& picture, double slices) {
    const fields::Field* field = slicing::fieldIn(picture.object);
    if (field == nullptr) return 0;
    double cells = slicing::ClosedSurfaceSlicer::kFormulaCells;  // the number of lattice cells along an axis
    if (field->array != nullptr) {
        const double samples = static_cast<double>(fields::sampleCount(field->array->shape()));
        cells = std::pow(samples, 0.25);
    }
    constexpr double kSecondsPerCell = 5e-5;  // the time for each lattice cell that the surface crosses
    return kSecondsPerCell * cells * cells * slices * static_cast<double>(picture.look.field.levels.size());
}

/// Returns the estimated time, in seconds, to sample the fog of a field and to draw it in `pixels` pixels or to write
/// it. Returns 0 if the field shows no fog. `slices` is the number of slices, and `cubes` the number of lattice cubes
/// across the diameter of the field.
double fogSeconds(const scene::PictureRequest& picture, double slices, double cubes, double pixels,
                  slicing::Quality quality) {
    const fields::Field* field = slicing::fieldIn(picture.object);
    if (field == nullptr || picture.look.field.fog.empty()) return 0;
    // The fog lattice in a slice is assumed to fill a third of the cube around the circumscribed sphere of the field.
    const double points = std::min(slices * std::pow(cubes, 3) / 3, static_cast<double>(maxFogSamples(quality)));
    const double sampling = std::min(points * (field->function->cost().value + 3), surfaceLimits(quality).time);
    return 1e-9 * sampling + 5e-9 * points + 5e-9 * pixels * std::min(cubes, std::cbrt(points / slices));
}

/// Returns the estimated time, in seconds, to slice an object, without the surfaces of a field, and to compose the
/// scene of the slices.
double sliceAndComposeSeconds(const scene::PictureRequest& picture) {
    const double n = totalElementCount(picture.object);
    return 1e-4 + 1e-7 * n + 1e-7 * picture.planes.count * estimateElementsCut(n);
}

/// Returns the estimated time, in seconds, to find the surface of a field at a pixel and, in the matrix, the contours
/// of the field. Returns 0 for other objects, and if faces are hidden.
double rayCastingSeconds(const scene::PictureRequest& picture) {
    const fields::Field* field = slicing::fieldIn(picture.object);
    if (field == nullptr || !picture.look.parts.faces) return 0;
    constexpr double kSlices = 3;  // the number of slices that the ray through a pixel meets
    const double cost = field->function->cost().value;
    const double contours = std::min(slicing::maxContourTime(slicing::Quality::full),
                                     6 * slicing::kMaxContourSquares * slicing::kMaxContourSquares * (cost + 3));
    return 1e-9 * (kSlices * scene::kRaySamples * cost + (picture.look.view == scene::View::matrix ? contours : 0));
}

}  // namespace

EstimatedSeconds frameCost(const scene::PictureRequest& picture) {
    const scene::Viewport& viewport = picture.viewport;
    const slicing::Quality quality = picture.quality;
    const double n = totalElementCount(picture.object);
    const double pixels = static_cast<double>(viewport.width) * viewport.height;
    const double bodies = picture.planes.count * (2e-5 + 1.2e-6 * estimateElementsCut(n));
    const double layers = 1 + 0.4 * std::log2(1 + n / 25);  // the estimated number of faces blended at a pixel
    // The focus slice (the middle one) takes up to half the height of the picture. The other slices of the oval are
    // smaller. Together, they have a few times as many pixels as the focus slice. So all slices count as kSlices slices
    // of the size of the focus slice.
    constexpr double kSlices = 4;
    const double cubes = picture.look.orbit.zoom * viewport.height / 2 / slicing::pixelsPerCube(quality);
    // In full quality, the lattice of each slice has at least cubesAcrossDiameter() cubes across the diameter of the
    // field, even if the slice is drawn small. Therefore the greater of two times counts: the time for the drawn size,
    // and the time for this minimum.
    const double field =
        std::max(surfaceSeconds(picture, kSlices, cubes, quality),
                 surfaceSeconds(picture, picture.planes.count, slicing::cubesAcrossDiameter(quality), quality)) +
        fogSeconds(picture, kSlices, cubes, pixels / kSlices, quality);
    return EstimatedSeconds(5e-4 + bodies + 6e-9 * pixels * layers + field);
}

EstimatedSeconds geometryCost(const scene::PictureRequest& picture) {
    const slicing::Quality quality = picture.quality;
    const double cubes = slicing::cubesAcrossDiameter(quality);
    const double field = surfaceSeconds(picture, picture.planes.count, cubes, quality) +
                         fogSeconds(picture, picture.planes.count, 2 * cubes, 0, quality);
    return EstimatedSeconds(sliceAndComposeSeconds(picture) + field);
}

EstimatedSeconds pointDescriptionCost(const scene::PictureRequest& picture) {
    return EstimatedSeconds(sliceAndComposeSeconds(picture) + rayCastingSeconds(picture));
}

EstimatedSeconds sampleCost(const slicing::Object& object) {
    const fields::Field* field = slicing::fieldIn(object);
    return EstimatedSeconds(1e-5 + (field == nullptr ? 0 : 1e-9 * field->function->cost().value));
}

EstimatedSeconds focusSectionCost(const slicing::Object& object) {
    const double n = totalElementCount(object);
    return EstimatedSeconds(1e-4 + 1e-8 * n + 1e-7 * estimateElementsCut(n));
}

EstimatedSeconds exportCost(const scene::PictureRequest& picture, const exports::ExportRequest& request) {
    constexpr slicing::Quality kQuality = slicing::Quality::file;
    const int chosen = request.fittedSlices.value_or(static_cast<int>(request.chosenW.size()));
    const int slices = request.choosesSlices() ? chosen : picture.planes.count;
    const double field = request.exact
                             ? exactSurfaceSeconds(picture, slices)
                             : surfaceSeconds(picture, slices, slicing::cubesAcrossDiameter(kQuality), kQuality);
    return EstimatedSeconds(0.02 + 5e-6 * slices * estimateElementsCut(totalElementCount(picture.object)) + field);
}

}  // namespace oval4d::pipeline
