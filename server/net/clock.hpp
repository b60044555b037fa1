#pragma once
// The clock with which connections and sessions measure time, and the timers of this clock.

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/system/error_code.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <utility>

namespace oval4d::net {

/// A timer that calls a function at a given time. The call runs on the executor for which the timer was made. Not
/// thread-safe: use the timer only on this executor.
class Timer {
  public:
    using Clock = std::chrono::steady_clock;

    Timer() = default;
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;
    /// Cancels a scheduled call, like cancel().
    virtual ~Timer() = default;

    /// Schedules one call of `expired` for the time `when`; soon if this time has passed. Replaces an earlier scheduled
    /// call, as if cancel() had been called.
    virtual void start(Clock::time_point when, std::function<void()> expired) = 0;
    /// Cancels a scheduled call, if there is one. A call that is already due may still happen.
    virtual void cancel() = 0;
};

/// A clock that makes timers. Tests use a clock whose time changes only when the test advances it. Thread-safe.
class TimerClock {
  public:
    using Clock = Timer::Clock;

    virtual ~TimerClock() = default;

    virtual Clock::time_point now() const = 0;
    /// Returns a timer whose functions run on `executor`. The clock must outlive the timer.
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
