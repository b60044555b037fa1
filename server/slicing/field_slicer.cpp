#include "slicing/field_slicer.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <tuple>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "slicing/surfaces/section_values.hpp"

namespace oval4d::slicing {

namespace {

/// Sets the walls of `section`: one half-space for each facet of the box that is not parallel to the slice's
/// hyperplane.
void findBoxWalls(const fields::Box& box, FieldSection& section) {
    constexpr double kParallel = 1e-12;
    section.walls.clear();
    for (int axis = 0; axis < 4; ++axis) {
        const glm::dvec3 row(section.axes[0][axis], section.axes[1][axis], section.axes[2][axis]);
        const double length = glm::length(row);
        if (length <= kParallel * std::abs(section.normal[axis])) continue;
        section.walls.push_back({row / length, (box.max[axis] - section.origin[axis]) / length});
        section.walls.push_back({-row / length, (section.origin[axis] - box.min[axis]) / length});
    }
}

/// Returns the vectors from a lattice point to the next points along x, y and z, in the function's coordinates. `step`
/// is the distance between these points in the slice.
std::array<glm::dvec4, 3> latticeSteps(const FieldSection& section, double step) {
    return {step * section.axes[0], step * section.axes[1], step * section.axes[2]};
}

/// Returns a number proportional to the number of points that a surface has on a lattice with the step `step`. A step
/// of 0 stands for no surface, and gives 0.
double relativePointCount(double step) { return step > 0 ? 1 / (step * step) : 0; }

/// Returns the axis-parallel bounding box of slice number `slice` of the domain. The slice must have vertices.
std::pair<glm::dvec3, glm::dvec3> boundsOf(const SliceSet& slices, int slice) {
    const glm::dvec3* const vertices = slices.vertices.data() + slices.vertexBegin[static_cast<std::size_t>(slice)];
    glm::dvec3 min = vertices[0], max = vertices[0];
    for (std::size_t v = 1; v < slices.vertexCount(slice); ++v) {
        min = glm::min(min, vertices[v]);
        max = glm::max(max, vertices[v]);
    }
    return {min, max};
}

/// Returns whether the surfaces, apart from caps, are so smooth that a finer lattice would look the same. If the
/// normals at the ends of an edge of the length l differ by the angle a, the surface between them is about l · a / 8
/// away from the edge. On few edges, a may exceed 0.5 radians. Where a body is thinner than a lattice step, edges lead
/// from one of its sides to the other, so that a is large on many edges. Returns false if there are no surfaces,
/// because a finer lattice may find a small body.
bool isSmooth(const SliceSurface& surface) {
    constexpr float kCosineOfSharp = 0.8776F;  // cos 0.5: at this angle, l · a / 8 is a sixteenth of l
    constexpr double kMostSharpEdges = 0.05;   // of all edges
    if (surface.triangles.empty()) return false;
    std::size_t sharp = 0, all = 0;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        if (surface.isCap(t)) continue;
        const auto& [a, b, c] = surface.triangles[t];
        const glm::vec3 &atA = surface.normals[a], &atB = surface.normals[b], &atC = surface.normals[c];
        for (const float cosine : {glm::dot(atA, atB), glm::dot(atB, atC), glm::dot(atC, atA)})
            sharp += cosine < kCosineOfSharp ? 1 : 0;
        all += 3;
    }
    return static_cast<double>(sharp) <= kMostSharpEdges * static_cast<double>(all);
}

}  // namespace

void FieldSlicer::slice(const fields::Field& field, const geometry::Rotation& orientation,
                        const geometry::Hyperplanes& planes, const FieldSettings& settings, const SurfaceDetail& detail,
                        SliceSet& out) {
    domains_.slice(*field.domain, orientation, planes, out);
    const auto count = static_cast<std::size_t>(planes.count);
    const bool hasFog = !settings.fog.empty() && !detail.fogSteps.empty();
    out.surfaces.resize(count);
    out.fogs.resize(hasFog ? count : 0);
    // Each slice gets a share of the limits on time and points. The share is proportional to the estimated number of
    // the points of the slice's surfaces.
    double sum = 0;
    for (const double step : detail.steps) sum += relativePointCount(step);
    if (sum == 0) {
        for (SliceSurface& surface : out.surfaces) surface.clear();
        if (!hasFog) return;
    }
    const double coarsening = hasFog ? fogCoarsening(field, detail, out) : 1;
    const glm::dmat4 toFunction = field.toFunction * orientation.inverse().matrix();
    std::atomic<int> next = 0;
    const auto work = [&](std::size_t worker) {
        for (int i = next++; i < planes.count; i = next++) {
            const auto n = static_cast<std::size_t>(i);
            SliceTask task;
            if (sum > 0) task = {detail.steps[n], relativePointCount(detail.steps[n]) / sum, 0};
            if (hasFog) task.fogStep = coarsening * detail.fogSteps[n];
            extractSurfacesAndFog(field, toFunction, settings, detail, task, i, out, worker);
        }
    };
    parallel::invoke(forkJoin_, [&] { work(0); }, [&] { work(1); });
    field.requireReadable();
}

// Returns the factor, at least 1, by which the lattice steps of fog must be enlarged, so that there are at most
// maxFogSamples() samples in all slices together, and sampling takes at most surfaceLimits().time.
double FieldSlicer::fogCoarsening(const fields::Field& field, const SurfaceDetail& detail, const SliceSet& slices) {
    constexpr double kEnlarge = 1.05, kMost = 1e3, kPerPoint = 3;
    const double perPoint = field.function->cost().value + kPerPoint;
    const double most =
        std::min(static_cast<double>(maxFogSamples(detail.quality)), surfaceLimits(detail.quality).time / perPoint);
    const auto points = [&](double factor) {
        double total = 0;
        for (int i = 0; i < slices.planes.count; ++i) {
            const double step = factor * detail.fogSteps[static_cast<std::size_t>(i)];
            if (step == 0 || slices.vertexCount(i) == 0) continue;
            const auto [min, max] = boundsOf(slices, i);
            const glm::dvec3 size = (max - min) / step + 2.0;
            total += size.x * size.y * size.z;
        }
        return total;
    };
    const double all = points(1);
    double factor = std::max(1.0, std::cbrt(all / most));
    while (factor < kMost && points(factor) > most) factor *= kEnlarge;
    return factor;
}

void FieldSlicer::extractSurfacesAndFog(const fields::Field& field, const glm::dmat4& toFunction,
                                        const FieldSettings& settings, const SurfaceDetail& detail,
                                        const SliceTask& task, int slice, SliceSet& out, std::size_t worker) {
    const auto n = static_cast<std::size_t>(slice);
    const bool empty = out.vertexCount(slice) == 0, extracts = task.share > 0 && !empty;
    const bool samples = task.fogStep > 0 && !empty;
    if (!extracts) out.surfaces[n].clear();
    if (!samples && !out.fogs.empty()) out.fogs[n].clear();
    if (!extracts && !samples) return;
    FieldSection& section = sections_[worker];
    placeSection(field, toFunction, out.planes.w(slice), section);
    findBoxWalls(field.box, section);
    std::tie(section.min, section.max) = boundsOf(out, slice);
    if (extracts) {
        const SurfaceLimits limits = surfaceLimits(detail.quality);
        const auto maxPoints = static_cast<std::size_t>(task.share * static_cast<double>(limits.points));
        const auto inQuality = [&](const fields::ScalarFunction& function) -> const fields::ScalarFunction& {
            return detail.quality != Quality::draft ? function
                                                    : function.downsampledForSteps(latticeSteps(section, task.step));
        };
        const fields::ScalarFunction* const second =
            detail.secondValues && field.second != nullptr ? &inQuality(*field.second->function) : nullptr;
        SurfaceExtractor::ExtractionOptions options{.levels = settings.levels,
                                                    .inside = settings.inside,
                                                    .step = task.step,
                                                    .maxTime = task.share * limits.time,
                                                    .maxPoints = maxPoints,
                                                    .topologyOnly = detail.topologyOnly,
                                                    .pointTime = second != nullptr ? second->cost().value : 0};
        const fields::ScalarFunction& function = inQuality(*field.function);
        const auto extract = [&](double step) {
            options.step = step;
            extractors_[worker].extract(function, section, options, out.surfaces[n]);
        };
        if (detail.largerStepsWhereSmooth) extract(kSmoothStepFactor * task.step);
        if (!detail.largerStepsWhereSmooth || !isSmooth(out.surfaces[n])) extract(task.step);
        if (second != nullptr) {
            evaluateInSection(*second, section, out.surfaces[n].points, out.surfaces[n].secondValues);
            second->releasePages();
        }
    }
    if (samples) {
        sampleFog(field.function->downsampledForSteps(latticeSteps(section, task.fogStep)), section,
                  settings.fog.front().value, settings.fog.back().value, task.fogStep, out.fogs[n]);
    }
    field.function->releasePages();
}

}  // namespace oval4d::slicing
