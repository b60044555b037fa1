#pragma once

#include <cstddef>

namespace oval4d::bench {

/// Returns how often operator new has been called since the program started, including calls by libraries.
std::size_t allocations();

}  // namespace oval4d::bench
