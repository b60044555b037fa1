// Two things done at once.

#include <array>
#include <atomic>
#include <functional>
#include <list>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/companion.hpp"

namespace {

using oval4d::geometry::Companion;

/// The threads that did the first and the second.
std::array<std::thread::id, 2> whoDoes() {
    std::array<std::thread::id, 2> who;
    Companion::instance().doBoth([&] { who[0] = std::this_thread::get_id(); },
                                 [&] { who[1] = std::this_thread::get_id(); });
    return who;
}

TEST(Companion, doesTheSecond) {
    if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "there is but one processor";
    const auto [first, second] = whoDoes();
    EXPECT_EQ(first, std::this_thread::get_id());
    EXPECT_NE(second, std::thread::id());
    EXPECT_NE(second, first);
}

TEST(Companion, restsWhereEveryProcessorHasWork) {
    const auto own = std::this_thread::get_id();
    {
        std::list<Companion::Work> all(std::thread::hardware_concurrency());
        EXPECT_EQ(whoDoes(), (std::array{own, own}));
    }
    if (std::thread::hardware_concurrency() > 1) {
        EXPECT_NE(whoDoes()[1], own);
    }
}

TEST(Companion, worksForOneAtATime) {
    Companion::instance().doBoth(
        [] {
            const auto own = std::this_thread::get_id();
            EXPECT_EQ(whoDoes(), (std::array{own, own}));
        },
        [] {});
    std::atomic<int> done = 0;
    {
        std::vector<std::jthread> threads;
        for (int i = 0; i < 4; ++i) {
            threads.emplace_back([&] {
                for (int j = 0; j < 200; ++j) Companion::instance().doBoth([&] { ++done; }, [&] { done += 1000; });
            });
        }
    }
    EXPECT_EQ(done, 4 * 200 * 1001);
}

TEST(Companion, throwsWhatOneOfThemThrows) {
    const auto failing = [](const char* what) { throw std::runtime_error(what); };
    bool done = false;
    const auto thrown = [&](const Companion::Job& first, const Companion::Job& second) -> std::string {
        done = false;
        try {
            Companion::instance().doBoth(first, second);
        } catch (const std::runtime_error& error) {
            return error.what();
        }
        return "nothing";
    };
    const Companion::Job good = [&] { done = true; };
    EXPECT_EQ(thrown([&] { failing("first"); }, good), "first");
    EXPECT_EQ(thrown(good, [&] { failing("second"); }), "second");
    EXPECT_TRUE(done);
    EXPECT_EQ(thrown(good, good), "nothing");
}

}  // namespace
