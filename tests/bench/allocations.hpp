#pragma once

#include <cstddef>

namespace oval4d::bench {

/// How often this program has called operator new so far, libraries included.
std::size_t allocations();

}  // namespace oval4d::bench
