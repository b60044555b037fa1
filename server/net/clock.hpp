#pragma once
// The clock by which connections and sessions measure time, and the timers that expire by it.

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/system/error_code.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <utility>

namespace oval4d::net {

/// A timer that calls a function. Not thread-safe: use the timer only on the executor for which it was made. The timer
/// calls the function on this executor.
class Timer {
  public:
    using Clock = std::chrono::steady_clock;

    Timer() = default;
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;
    /// Cancels the scheduled call, like cancel().
    virtual ~Timer() = default;

    /// Schedules one call of `expired`: at the time `when`, or soon if this time has passed. First cancels an earlier
    /// scheduled call, like cancel().
    virtual void start(Clock::time_point when, std::function<void()> expired) = 0;
    /// Cancels the scheduled call, if there is one. A call that is already due may still come.
    virtual void cancel() = 0;
};

/// A clock that can make timers. Tests pass a clock whose time changes only when the test advances it. Thread-safe.
class TimerClock {
  public:
    using Clock = Timer::Clock;

    virtual ~TimerClock() = default;

    virtual Clock::time_point now() const = 0;
    /// Returns a timer that calls functions on `executor`. The clock must outlive the timer.
    virtual std::unique_ptr<Timer> makeTimer(const boost::asio::any_io_executor& executor) const = 0;
};

/// The steady clock of the system.
class SystemTimerClock final : public TimerClock {
  public:
    Clock::time_point now() const override { return Clock::now(); }
    std::unique_ptr<Timer> makeTimer(const boost::asio::any_io_executor& executor) const override {
        return std::make_unique<SystemTimer>(executor);
    }

  private:
    class SystemTimer final : public Timer {
      public:
        explicit SystemTimer(const boost::asio::any_io_executor& executor) : timer_(executor) {}
        void start(Clock::time_point when, std::function<void()> expired) override {
            timer_.expires_at(when);
            timer_.async_wait([expired = std::move(expired)](boost::system::error_code canceled) {
                if (!canceled) expired();
            });
        }
        void cancel() override { timer_.cancel(); }

      private:
        boost::asio::steady_timer timer_;
    };
};

}  // namespace oval4d::net
