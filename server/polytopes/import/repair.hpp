#pragma once

#include <string>
#include <vector>

#include "polytopes/import/polygon_soup.hpp"

namespace oval4d::polytopes {

/// Repairs in `soup` the faults that have only one sensible correction; the comment of importPolytope() lists them.
/// Appends one warning to `warnings` for each kind of fault that was repaired. Merges vertices whose distance is at
/// most `mergeDistance`. A negative `mergeDistance` merges no vertices.
void repair(PolygonSoup& soup, double mergeDistance, std::vector<std::string>& warnings);

}  // namespace oval4d::polytopes
