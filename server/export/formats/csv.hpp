#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// Returns a CSV file with two tables, separated by an empty line. The first has one row per slice: n, w, the numbers
/// of vertices, edges and faces, volume, area, and centroid. The second lists the critical values of w, at which the
/// combinatorial type of the slices changes, and the number of the polytope's vertices at each of them.
std::string measurementsCsv(const SceneInput& source);

}  // namespace oval4d::exports
