#pragma once

#include <cstddef>

namespace oval4d::bench {

/// Returns the number of calls of operator new since the program started, including calls by libraries.
std::size_t allocations();

}  // namespace oval4d::bench
