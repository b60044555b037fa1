#pragma once
// A pause for coroutines, measured by the clock of connections.

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <chrono>

#include "net/clock.hpp"

namespace oval4d::net {

/// Suspends the coroutine for `duration`, measured by `clock`, which must outlive the pause. Does not wait if
/// `duration` is not positive. The coroutine must run on `executor`.
boost::asio::awaitable<void> pauseFor(const TimerClock& clock, boost::asio::any_io_executor executor,
                                      std::chrono::duration<double> duration);

}  // namespace oval4d::net
