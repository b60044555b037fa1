#pragma once
// A timer that calls a function of its owner once.

#include <boost/asio/any_io_executor.hpp>
#include <concepts>
#include <functional>
#include <memory>
#include <utility>

#include "net/clock.hpp"

namespace oval4d::net {

/// A timer that calls a function of its owner once, at a set time. The owner is the object that has the timer as a
/// member. Not thread-safe: use the timer only on the strand given to the constructor. The call runs on the same
/// strand.
class OneShotTimer {
  public:
    using Clock = TimerClock::Clock;

    /// `clock` measures the time, and must outlive this object.
    OneShotTimer(const TimerClock& clock, const boost::asio::any_io_executor& strand)
        : timer_(clock.makeTimer(strand)) {}

    /// Schedules one call of `expired`, with a reference to the owner, at the time `when`. Does nothing if a call is
    /// already scheduled. Skips the call if the owner has been destroyed by then. `expired` is a member function of the
    /// owner, or a function object.
    template <typename Owner, std::invocable<Owner&> Expired>
    void startUnlessRunning(std::weak_ptr<Owner> owner, Clock::time_point when, Expired expired) {
        if (running_) return;
        running_ = true;
        timer_->start(when, [this, owner = std::move(owner), expired] {
            const auto alive = owner.lock();
            if (!alive) return;  // the owner, and this timer in it, no longer exist
            running_ = false;
            std::invoke(expired, *alive);
        });
    }

  private:
    const std::unique_ptr<Timer> timer_;
    bool running_ = false;
};

}  // namespace oval4d::net
