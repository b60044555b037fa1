#include "net/pause.hpp"

#include <functional>
#include <utility>
#include <variant>

#include "net/coroutine_helpers.hpp"

namespace oval4d::net {

namespace {

/// Returns a function whose argument is a callback. The function starts `timer`, which calls the callback at the time
/// `when`.
std::function<void(std::function<void(std::monostate)>)> timerStarter(Timer& timer, Timer::Clock::time_point when) {
    return [&timer, when](const std::function<void(std::monostate)>& done) {
        timer.start(when, [done] { done(std::monostate{}); });
    };
}

}  // namespace

boost::asio::awaitable<void> pauseFor(const TimerClock& clock, boost::asio::any_io_executor executor,
                                      std::chrono::duration<double> duration) {
    if (duration.count() <= 0) co_return;
    const auto timer = clock.makeTimer(executor);
    auto start = timerStarter(*timer, clock.now() + toSteadyDuration(duration));
    co_await awaitCallback<std::monostate>(std::move(start));
}

}  // namespace oval4d::net
