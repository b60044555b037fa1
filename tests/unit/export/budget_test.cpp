#include "export/budget.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "unit/parallel/virtual_clock.hpp"

namespace oval4d::exports {
namespace {

using namespace std::chrono_literals;

TEST(ExportBudget, EndsWhenMoreTimeHasPassedThanIsAllowed) {
    support::VirtualClock clock;
    const ExportBudget budget({.time = 20s, .now = clock.now<std::chrono::steady_clock>()}, {});
    clock.advance(20s);
    EXPECT_FALSE(budget.mustStop());
    EXPECT_NO_THROW(budget.checkTimeAndStop());
    clock.advance(1ms);
    EXPECT_TRUE(budget.mustStop());
    try {
        budget.checkTimeAndStop();
        FAIL() << "it does not end";
    } catch (const ExportRefused& refused) {
        EXPECT_EQ(refused.error.cause, ExportRefusal::Cause::too_long);
        EXPECT_NE(refused.error.message.find("20 s"), std::string::npos);
    }
}

}  // namespace
}  // namespace oval4d::exports
