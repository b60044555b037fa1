#pragma once
// A pause of a coroutine, by the clock of connections.

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <chrono>

#include "net/clock.hpp"

namespace oval4d::net {

/// Waits for this long, by `clock`, which must outlive the wait. Does not wait if `duration` is not positive. The
/// coroutine that awaits the result must run on `executor`.
boost::asio::awaitable<void> pauseFor(const TimerClock& clock, boost::asio::any_io_executor executor,
                                      std::chrono::duration<double> duration);

}  // namespace oval4d::net
