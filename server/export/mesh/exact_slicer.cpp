#include "export/mesh/exact_slicer.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "fields/array/array_function.hpp"

namespace oval4d::exports {

namespace {

// Returns the size, in bytes, of the tables of a slicing::ClosedSurfaceSlicer for an array: two numbers for each index
// along each axis. Returns 0 for a formula, whose tables are small.
std::size_t slicerTableBytes(const fields::Field& field) {
    std::size_t indices = 0;
    if (field.array)
        for (const std::size_t samples : field.array->shape()) indices += samples;
    return 2 * sizeof(double) * indices;
}

const fields::Field& checkTableMemory(const fields::Field& field, const ExportBudget& budget) {
    budget.checkFileSize(slicerTableBytes(field));
    return field;
}

}  // namespace

ExactFieldSlicer::ExactFieldSlicer(const fields::Field& field, const geometry::Rotation& orientation,
                                   SurfaceOptions options, const ExportBudget& budget)
    : field_(field),
      budget_(budget),
      options_(std::move(options)),
      slicer_(checkTableMemory(field, budget), orientation) {}

void ExactFieldSlicer::slice(double w, double level, std::size_t others, slicing::ClosedSurface& out) {
    const std::size_t limit = budget_.triangleLimit();
    const auto done = slicer_.slice(w,
                                    {.level = level,
                                     .inside = options_.inside,
                                     .maxTriangles = limit - std::min(limit, others),
                                     .pointData = options_.pointData,
                                     .mustStop =
                                         [&] {
                                             const std::size_t triangles = others + out.triangles.size();
                                             budget_.checkTrianglesAndMemory(std::min(limit, triangles));
                                             return budget_.mustStop();
                                         }},
                                    out);
    field_.function->releasePages();
    budget_.checkTimeAndStop();
    if (!done) {
        throw ExportRefused{{ExportRefusal::Cause::too_large, "the exact surfaces have more than the allowed " +
                                                                  std::to_string(limit) + " triangles" +
                                                                  options_.advice}};
    }
    budget_.checkTrianglesAndMemory(others + out.triangles.size());
}

}  // namespace oval4d::exports
