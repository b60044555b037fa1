#pragma once

#include <cstddef>

namespace oval4d::bench {

/// Returns the number of calls of operator new in this program so far, including those of libraries.
std::size_t allocations();

}  // namespace oval4d::bench
