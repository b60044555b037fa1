#pragma once

namespace oval4d::parallel {

/// Thrown by a job that ends early because a stop was requested (see WorkerPool::stop()). Not derived from
/// std::exception, so that handlers that report errors do not catch it.
struct Canceled {};

}  // namespace oval4d::parallel
