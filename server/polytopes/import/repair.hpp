#pragma once

#include <string>
#include <vector>

#include "polytopes/import/polygon_soup.hpp"

namespace oval4d::polytopes {

/// Repairs in `soup` the faults that have only one sensible correction; importPolytope() lists them. Appends one
/// warning to `warnings` for each kind of fault that it repairs. Merges vertices whose distance is at most
/// `mergeDistance`; if `mergeDistance` is negative, merges none.
void repair(PolygonSoup& soup, double mergeDistance, std::vector<std::string>& warnings);

}  // namespace oval4d::polytopes
