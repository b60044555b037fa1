#pragma once

#include <string>
#include <vector>

#include "polytopes/import/polygon_soup.hpp"

namespace oval4d::polytopes {

/// Repairs faults that have only one sensible correction (see importPolytope) and appends a warning for each type of
/// repair. Vertices within `mergeDistance` of each other are merged; a negative distance merges none.
void repair(PolygonSoup& soup, double mergeDistance, std::vector<std::string>& warnings);

}  // namespace oval4d::polytopes
