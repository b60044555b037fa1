#pragma once
// A virtual clock for tests of connections and sessions, with its timers.

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/post.hpp>
#include <chrono>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "net/clock.hpp"
#include "unit/parallel/virtual_clock.hpp"

namespace oval4d::net {

/// A clock whose time passes only when a test advances it. When one of its timers expires, the timer's function is
/// posted to the timer's executor. Thread-safe, but only one thread at a time may advance the time.
class VirtualTimerClock final : public TimerClock {
  public:
    Clock::time_point now() const override { return time_.now<Clock>()(); }

    std::unique_ptr<Timer> makeTimer(const boost::asio::any_io_executor& executor) const override {
        return std::make_unique<VirtualTimer>(calls_, executor);
    }

    /// Returns the time of the first scheduled call; an empty optional if no call is scheduled.
    std::optional<Clock::time_point> nextCall() const { return calls_->first(); }

    /// Advances the time to `when`, and posts the functions of the timers that expire. Does nothing if the time is
    /// already later.
    void advanceTo(Clock::time_point when) {
        if (when > now()) time_.advance(when - now());
        calls_->postUntil(now());
    }

  private:
    // A scheduled call of a timer.
    struct Call {
        const Timer* timer;
        boost::asio::any_io_executor executor;
        std::function<void()> expired;
    };
    // The scheduled calls of all timers. Their functions may own objects that have timers, so they are destroyed only
    // while the mutex is not locked.
    class Calls {
        using Queue = std::multimap<Clock::time_point, Call>;

      public:
        void schedule(Clock::time_point when, Call call) {
            const std::lock_guard lock(mutex_);
            calls_.emplace(when, std::move(call));
        }
        void cancel(const Timer* timer) {
            std::vector<Queue::node_type> canceled;
            const std::lock_guard lock(mutex_);  // is unlocked before `canceled` is destroyed
            for (auto call = calls_.begin(); call != calls_.end();) {
                const auto next = std::next(call);
                if (call->second.timer == timer) canceled.push_back(calls_.extract(call));
                call = next;
            }
        }
        std::optional<Clock::time_point> first() const {
            const std::lock_guard lock(mutex_);
            return calls_.empty() ? std::nullopt : std::optional(calls_.begin()->first);
        }
        void postUntil(Clock::time_point now) {
            std::vector<Queue::node_type> due;
            {
                const std::lock_guard lock(mutex_);
                while (!calls_.empty() && calls_.begin()->first <= now) due.push_back(calls_.extract(calls_.begin()));
            }
            for (Queue::node_type& each : due)
                boost::asio::post(each.mapped().executor, std::move(each.mapped().expired));
        }

      private:
        mutable std::mutex mutex_;
        Queue calls_;  // guarded by mutex_
    };

    class VirtualTimer final : public Timer {
      public:
        VirtualTimer(std::shared_ptr<Calls> calls, boost::asio::any_io_executor executor)
            : calls_(std::move(calls)), executor_(std::move(executor)) {}
        ~VirtualTimer() override { calls_->cancel(this); }
        void start(Clock::time_point when, std::function<void()> expired) override {
            calls_->cancel(this);
            calls_->schedule(when, {this, executor_, std::move(expired)});
        }
        void cancel() override { calls_->cancel(this); }

      private:
        const std::shared_ptr<Calls> calls_;
        const boost::asio::any_io_executor executor_;
    };

    support::VirtualClock time_;
    const std::shared_ptr<Calls> calls_ = std::make_shared<Calls>();
};

}  // namespace oval4d::net
