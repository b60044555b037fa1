#pragma once

namespace oval4d::parallel {

/// Thrown by work that ends early because a stop was requested. Not a std::exception, because it is not an error to
/// report.
struct Canceled {};

}  // namespace oval4d::parallel
