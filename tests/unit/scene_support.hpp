#pragma once
// What the tests of scenes share.

#include <string_view>

#include "geometry/catalogue.hpp"

namespace oval4d::scene::support {

inline const geometry::Polytope& named(std::string_view name) {
    return *geometry::polytopeOf(*geometry::findEntry(name));
}

}  // namespace oval4d::scene::support
