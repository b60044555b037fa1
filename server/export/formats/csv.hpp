#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// Returns a CSV file. Lengths, areas and volumes are in the units of the object.
///
/// For a field, the file has one row per slice and level, in the order of the levels: n (the index of the hyperplane),
/// w, the level if there are several, volume, area of the level set without caps, centroid (empty if there is no
/// volume), number of connected components, Euler characteristic of the surface (see slicing::SurfaceMeasurements), and
/// the mean of the second function on the surface if there is such a function. Computes the surfaces anew by
/// slicing::ExactSlicer, and ignores those of the scene. Throws ExportRefused if a limit is exceeded or a stop is
/// requested, and for ExportContents::critical.
///
/// For other objects, the file has one row per slice: n, w, the numbers of vertices, edges and faces, volume, area, and
/// centroid (empty if the slice is empty). For ExportContents::critical, it has instead one row per critical value of
/// w, at which the combinatorial type of the slices changes: w, and the number of the object's vertices there.
std::string measurementsCsv(const SceneInput& source);

}  // namespace oval4d::exports
