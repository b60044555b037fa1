#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// A CSV table with one row per slice: n, w, the numbers of vertices, edges and faces, volume, area, and centroid.
/// After an empty line follow the critical values of w, at which the combinatorial type of the slices changes, each
/// with the number of the polytope's vertices there.
std::string csv(const Source& source);

}  // namespace oval4d::exports
