#pragma once

namespace oval4d::parallel {

/// An exception that a job throws to end early, because a stop was requested (see WorkerPool::stop()). It is not
/// derived from std::exception, so that handlers that report errors do not catch it.
struct Canceled {};

}  // namespace oval4d::parallel
