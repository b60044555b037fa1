#pragma once

#include <string>
#include <vector>

#include "polytopes/import/polygon_soup.hpp"

namespace oval4d::polytopes {

/// Repairs faults of a file that have only one sensible correction (see importPolytope). Appends a warning to
/// `warnings` for each type of repair. Merges vertices within `mergeDistance` of each other; a negative distance merges
/// none.
void repair(PolygonSoup& soup, double mergeDistance, std::vector<std::string>& warnings);

}  // namespace oval4d::polytopes
