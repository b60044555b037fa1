#include "net/transfer_deadline.hpp"

#include <gtest/gtest.h>

#include "unit/net/virtual_timer_clock.hpp"

namespace oval4d::net {
namespace {

using namespace std::chrono_literals;

class TransferDeadlines : public testing::Test {
  protected:
    TransferDeadlines() { options.writeTimeout = 10s; }
    void pass(TimerClock::Clock::duration time) { clock.advanceTo(clock.now() + time); }

    ServerOptions options;
    VirtualTimerClock clock;
};

TEST_F(TransferDeadlines, AFragmentHasTheWriteTimeoutIfTheClientIsFastEnough) {
    options.minReadRate = 1000;
    TransferDeadline deadline(options, clock);
    for (int i = 0; i < 100; ++i) {
        EXPECT_EQ(deadline.nextFragmentTimeout(), 10s);
        pass(9s);
        deadline.countBytes(9000);
    }
}

TEST_F(TransferDeadlines, AClientBelowTheMinimumRateHasLessAndLessTime) {
    options.minReadRate = 1000;
    TransferDeadline deadline(options, clock);
    pass(15s);
    EXPECT_EQ(deadline.nextFragmentTimeout(), 5s);
    deadline.countBytes(2000);
    EXPECT_EQ(deadline.nextFragmentTimeout(), 7s);
    deadline.countBytes(98'000);
    EXPECT_EQ(deadline.nextFragmentTimeout(), 10s);
    pass(1h);
    EXPECT_EQ(deadline.nextFragmentTimeout(), 1ms);
}

TEST_F(TransferDeadlines, WithoutAMinimumRateEachFragmentHasTheWriteTimeout) {
    options.minReadRate = 0;
    const TransferDeadline deadline(options, clock);
    pass(1000h);
    EXPECT_EQ(deadline.nextFragmentTimeout(), 10s);
}

}  // namespace
}  // namespace oval4d::net
