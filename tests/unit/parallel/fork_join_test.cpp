// Tests of ForkJoin, which runs two jobs at the same time.

#include <array>
#include <atomic>
#include <functional>
#include <list>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "parallel/fork_join.hpp"

namespace {

using oval4d::parallel::ForkJoin;

/// Returns the threads that ran the first and the second job.
std::array<std::thread::id, 2> threadsOf(ForkJoin& forkJoin) {
    std::array<std::thread::id, 2> threads;
    forkJoin.invoke([&] { threads[0] = std::this_thread::get_id(); }, [&] { threads[1] = std::this_thread::get_id(); });
    return threads;
}

TEST(ForkJoin, doesTheSecond) {
    if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "there is only one processor";
    ForkJoin forkJoin;
    const auto [first, second] = threadsOf(forkJoin);
    EXPECT_EQ(first, std::this_thread::get_id());
    EXPECT_NE(second, std::thread::id());
    EXPECT_NE(second, first);
}

TEST(ForkJoin, restsWhereEveryProcessorHasWork) {
    ForkJoin forkJoin;
    const auto own = std::this_thread::get_id();
    {
        std::list<ForkJoin::BusyProcessorGuard> all;
        for (unsigned i = 0; i < std::thread::hardware_concurrency(); ++i) all.emplace_back(forkJoin);
        EXPECT_EQ(threadsOf(forkJoin), (std::array{own, own}));
    }
    if (std::thread::hardware_concurrency() > 1) {
        EXPECT_NE(threadsOf(forkJoin)[1], own);
    }
}

TEST(ForkJoin, worksForOneAtATime) {
    ForkJoin forkJoin;
    forkJoin.invoke(
        [&] {
            const auto own = std::this_thread::get_id();
            EXPECT_EQ(threadsOf(forkJoin), (std::array{own, own}));
        },
        [] {});
    std::atomic<int> done = 0;
    {
        std::vector<std::jthread> threads;
        for (int i = 0; i < 4; ++i) {
            threads.emplace_back([&] {
                for (int j = 0; j < 200; ++j) forkJoin.invoke([&] { ++done; }, [&] { done += 1000; });
            });
        }
    }
    EXPECT_EQ(done, 4 * 200 * 1001);
}

TEST(ForkJoin, throwsWhatOneOfThemThrows) {
    ForkJoin forkJoin;
    const auto failing = [](const char* what) { throw std::runtime_error(what); };
    std::atomic<bool> done = false;
    const auto thrown = [&](const ForkJoin::Job& first, const ForkJoin::Job& second) -> std::string {
        done = false;
        try {
            forkJoin.invoke(first, second);
        } catch (const std::runtime_error& error) {
            return error.what();
        }
        return "nothing";
    };
    const ForkJoin::Job good = [&] { done = true; };
    EXPECT_EQ(thrown([&] { failing("first"); }, good), "first");
    EXPECT_EQ(thrown(good, [&] { failing("second"); }), "second");
    EXPECT_TRUE(done);
    EXPECT_EQ(thrown(good, good), "nothing");
}

TEST(ForkJoin, isOptional) {
    std::string done;
    oval4d::parallel::invoke(nullptr, [&] { done += "first "; }, [&] { done += "second"; });
    EXPECT_EQ(done, "first second");
    ForkJoin forkJoin;
    std::atomic<int> count = 0;
    oval4d::parallel::invoke(&forkJoin, [&] { ++count; }, [&] { count += 10; });
    EXPECT_EQ(count, 11);
}

}  // namespace
