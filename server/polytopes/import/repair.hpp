#pragma once

#include <string>
#include <vector>

#include "polytopes/import/polygon_soup.hpp"

namespace oval4d::polytopes {

/// Repairs, in place, faults of a file that have only one sensible correction (see importPolytope). Appends one warning
/// to `warnings` for each kind of fault that was repaired. Merges vertices within `mergeDistance` of each other; a
/// negative distance merges none.
void repair(PolygonSoup& soup, double mergeDistance, std::vector<std::string>& warnings);

}  // namespace oval4d::polytopes
