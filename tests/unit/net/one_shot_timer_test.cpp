// Timers of the system's clock and of the virtual clock.

#include "net/one_shot_timer.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/strand.hpp>
#include <memory>

#include <gtest/gtest.h>

#include "net/clock.hpp"
#include "unit/net/virtual_timer_clock.hpp"

namespace oval4d::net {
namespace {

namespace asio = boost::asio;
using namespace std::chrono_literals;

struct Owner : std::enable_shared_from_this<Owner> {
    Owner(const TimerClock& clock, asio::io_context& io) : timer(clock, asio::make_strand(io)) {}
    void start(TimerClock::Clock::time_point when) { timer.startUnlessRunning(weak_from_this(), when, &Owner::count); }
    void count() { ++calls; }

    OneShotTimer timer;
    int calls = 0;
};

class OneShotTimers : public testing::Test {
  protected:
    void runUntil(TimerClock::Clock::time_point when) {
        clock.advanceTo(when);
        io.restart();
        io.poll();
    }

    VirtualTimerClock clock;
    const TimerClock::Clock::time_point begin = clock.now();
    asio::io_context io;
    std::shared_ptr<Owner> owner = std::make_shared<Owner>(clock, io);
};

TEST_F(OneShotTimers, CallTheirOwnerOnceAtTheirTime) {
    owner->start(begin + 1h);
    runUntil(begin + 1h - 1ns);
    EXPECT_EQ(owner->calls, 0);
    runUntil(begin + 1h);
    EXPECT_EQ(owner->calls, 1);
    runUntil(begin + 10h);
    EXPECT_EQ(owner->calls, 1);
}

TEST_F(OneShotTimers, KeepTheirTimeWhileTheyRun) {
    owner->start(begin + 2h);
    owner->start(begin + 1h);
    runUntil(begin + 1h);
    EXPECT_EQ(owner->calls, 0);
    owner->start(begin + 3h);
    runUntil(begin + 2h);
    EXPECT_EQ(owner->calls, 1);
    owner->start(begin + 3h);
    runUntil(begin + 3h);
    EXPECT_EQ(owner->calls, 2);
}

TEST_F(OneShotTimers, DoNotCallADestroyedOwner) {
    owner->start(begin + 1h);
    const std::weak_ptr<Owner> weak = owner;
    owner.reset();
    EXPECT_TRUE(weak.expired());
    EXPECT_FALSE(clock.nextCall());
    runUntil(begin + 1h);
}

TEST(SystemTimerClock, ItsTimersCallAtTheTimeOfTheLastStart) {
    const SystemTimerClock clock;
    asio::io_context io;
    const auto timer = clock.makeTimer(io.get_executor());
    int first = 0, second = 0;
    timer->start(clock.now() + 10'000h, [&] { ++first; });
    const auto due = clock.now() + 1ms;
    timer->start(due, [&] { ++second; });
    io.run();  // returns when no call is scheduled
    EXPECT_EQ(first, 0);
    EXPECT_EQ(second, 1);
    EXPECT_GE(clock.now(), due);
}

TEST(SystemTimerClock, ItsTimersDoNotCallAfterTheyAreCanceledOrDestroyed) {
    const SystemTimerClock clock;
    asio::io_context io;
    int calls = 0;
    auto timer = clock.makeTimer(io.get_executor());
    timer->start(clock.now() + 10'000h, [&] { ++calls; });
    timer->cancel();
    io.run();
    timer->start(clock.now() + 10'000h, [&] { ++calls; });
    timer.reset();
    io.restart();
    io.run();
    EXPECT_EQ(calls, 0);
}

}  // namespace
}  // namespace oval4d::net
