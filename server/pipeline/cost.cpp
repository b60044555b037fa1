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

double elementTotal(const slicing::Object& object) {
    const auto counts = slicing::elementCounts(object);
    return static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::size_t{0}));
}

/// Returns approximately how many elements a hyperplane cuts in a polytope that has n elements (vertices, edges, faces
/// and cells). The elements form a three-dimensional boundary, which the hyperplane cuts in a two-dimensional surface:
/// hence the exponent 2/3.
double elementsCut(double n) { return std::pow(n, 2.0 / 3); }

/// Returns the estimated time, in seconds, to extract the surfaces of a field, and to draw or write them; 0 for other
/// objects, and if faces are hidden. `slices`: number of slices. `cubes`: number of lattice cubes across the field's
/// diameter.
double surfaceSeconds(const session::State& state, double slices, double cubes, slicing::Quality quality) {
    const fields::Field* field = slicing::fieldIn(state.object);
    if (field == nullptr || !state.look.parts.faces) return 0;
    const slicing::SurfaceLimits limits = slicing::surfaceLimits(quality);
    const fields::EvaluationCost cost = field->function->cost();
    // Assumes that a surface crosses 1.5 times as many lattice cubes as a plane through the field, and has one point in
    // each of these cubes. About three lattice points are sampled for each point of the surface.
    const double points = 1.5 * slices * cubes * cubes * static_cast<double>(state.look.field.levels.size());
    const bool isColored = field->second != nullptr && scene::colorsByValue(state.look);
    const double coloring = isColored ? field->second->function->cost().value : 0;
    const double extraction = points * (3 * cost.value + 2 * cost.gradient + 60 + cost.bounds / 16 + coloring);
    return 1e-9 * std::min(limits.time, extraction) + 1.5e-7 * std::min(points, static_cast<double>(limits.points));
}

/// Returns the estimated time, in seconds, to make exact surfaces of a field and to write them; 0 for other objects.
double exactSurfaceSeconds(const session::State& state, double slices) {
    const fields::Field* field = slicing::fieldIn(state.object);
    if (field == nullptr) return 0;
    double cells = slicing::ClosedSurfaceSlicer::kFormulaCells;  // along an axis
    if (field->array != nullptr) {
        const double samples = static_cast<double>(fields::sampleCount(field->array->shape()));
        cells = std::pow(samples, 0.25);
    }
    constexpr double kSecondsPerCell = 5e-5;  // of a lattice cell that the surface crosses
    return kSecondsPerCell * cells * cells * slices * static_cast<double>(state.look.field.levels.size());
}

/// Returns the estimated time, in seconds, to sample the fog of a field, and to draw it in this many pixels or to write
/// it; 0 if the field shows no fog. `slices`: number of slices. `cubes`: number of lattice cubes across the field's
/// diameter.
double fogSeconds(const session::State& state, double slices, double cubes, double pixels, slicing::Quality quality) {
    const fields::Field* field = slicing::fieldIn(state.object);
    if (field == nullptr || state.look.field.fog.empty()) return 0;
    // The lattice in a slice is assumed to fill a third of the cube around the circumscribed sphere of the field.
    const double points = std::min(slices * std::pow(cubes, 3) / 3, static_cast<double>(maxFogSamples(quality)));
    const double sampling = std::min(points * (field->function->cost().value + 3), surfaceLimits(quality).time);
    return 1e-9 * sampling + 5e-9 * points + 5e-9 * pixels * std::min(cubes, std::cbrt(points / slices));
}

/// Returns the estimated time, in seconds, to slice an object, without the surfaces of a field, and to compose its
/// scene.
double boxSeconds(const session::State& state) {
    const double n = elementTotal(state.object);
    return 1e-4 + 1e-7 * n + 1e-7 * state.slices.count * elementsCut(n);
}

/// Returns the estimated time, in seconds, to find the surface of a field at a pixel, or the contours of the matrix; 0
/// for other objects, and if faces are hidden.
double raySeconds(const session::State& state) {
    const fields::Field* field = slicing::fieldIn(state.object);
    if (field == nullptr || !state.look.parts.faces) return 0;
    constexpr double kSlices = 3;  // that the ray through a pixel meets
    const double cost = field->function->cost().value;
    const double contours = std::min(slicing::maxContourTime(slicing::Quality::full),
                                     6 * slicing::kMaxContourSquares * slicing::kMaxContourSquares * (cost + 3));
    return 1e-9 * (kSlices * scene::kRaySamples * cost + (state.look.view == scene::View::matrix ? contours : 0));
}

}  // namespace

EstimatedSeconds frameCost(const session::State& state, scene::Viewport viewport, slicing::Quality quality) {
    const double n = elementTotal(state.object);
    const double pixels = static_cast<double>(viewport.width) * viewport.height;
    const double bodies = state.slices.count * (2e-5 + 1.2e-6 * elementsCut(n));
    const double layers = 1 + 0.4 * std::log2(1 + n / 25);  // estimated number of faces blended at a pixel
    // The focus slice takes up to half the picture's height. The other slices of the oval are smaller, and together
    // have a few times as many pixels as the focus slice. So all slices count as kSlices slices of the size of the
    // focus slice.
    constexpr double kSlices = 4;
    const double cubes = state.look.orbit.zoom * viewport.height / 2 / slicing::pixelsPerCube(quality);
    // In full quality, the lattice of each slice has at least cubesAcross() cubes across the diameter of the field,
    // even if the slice is drawn small. Hence the greater of the two times.
    const double field = std::max(surfaceSeconds(state, kSlices, cubes, quality),
                                  surfaceSeconds(state, state.slices.count, slicing::cubesAcross(quality), quality)) +
                         fogSeconds(state, kSlices, cubes, pixels / kSlices, quality);
    return EstimatedSeconds(5e-4 + bodies + 6e-9 * pixels * layers + field);
}

EstimatedSeconds geometryCost(const session::State& state, slicing::Quality quality) {
    const double cubes = slicing::cubesAcross(quality);
    const double field = surfaceSeconds(state, state.slices.count, cubes, quality) +
                         fogSeconds(state, state.slices.count, 2 * cubes, 0, quality);
    return EstimatedSeconds(boxSeconds(state) + field);
}

EstimatedSeconds pointCost(const session::State& state) {
    return EstimatedSeconds(boxSeconds(state) + raySeconds(state));
}

EstimatedSeconds sampleCost(const session::State& state) {
    const fields::Field* field = slicing::fieldIn(state.object);
    return EstimatedSeconds(1e-5 + (field == nullptr ? 0 : 1e-9 * field->function->cost().value));
}

EstimatedSeconds focusSectionCost(const session::State& state) {
    const double n = elementTotal(state.object);
    return EstimatedSeconds(1e-4 + 1e-8 * n + 1e-7 * elementsCut(n));
}

EstimatedSeconds exportCost(const session::State& state, const exports::ExportRequest& request) {
    constexpr slicing::Quality kQuality = slicing::Quality::file;
    const int chosen = request.fittedSlices.value_or(static_cast<int>(request.chosenW.size()));
    const int slices = request.choosesSlices() ? chosen : state.slices.count;
    const double field = request.exact ? exactSurfaceSeconds(state, slices)
                                       : surfaceSeconds(state, slices, slicing::cubesAcross(kQuality), kQuality);
    return EstimatedSeconds(0.02 + 5e-6 * slices * elementsCut(elementTotal(state.object)) + field);
}

}  // namespace oval4d::pipeline
