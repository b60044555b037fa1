#include "net/registry.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace oval4d::net {
namespace {

TEST(Registry, CountsPlaces) {
    Registry registry;
    const auto one = std::make_unique<Registry::Place>(registry);
    {
        const Registry::Place two(registry);
        EXPECT_EQ(registry.size(), 2U);
    }
    EXPECT_EQ(registry.size(), 1U);
}

TEST(Registry, AsksEachOnce) {
    Registry registry;
    Registry::Place early(registry);
    int asked = 0;
    early.onStop([&] { ++asked; });
    registry.stopAll();
    EXPECT_EQ(asked, 1);
    Registry::Place late(registry);
    late.onStop([&] { asked += 10; });
    EXPECT_EQ(asked, 11) << "who comes after that is asked at once";
}

TEST(Registry, WhoIsAskedMayGiveItsPlaceBackAtOnce) {
    Registry registry;
    auto early = std::make_unique<Registry::Place>(registry);
    early->onStop([&] { early.reset(); });
    registry.stopAll();
    EXPECT_EQ(registry.size(), 0U);
    auto late = std::make_unique<Registry::Place>(registry);
    late->onStop([&] { late.reset(); });
    EXPECT_EQ(registry.size(), 0U);
}

}  // namespace
}  // namespace oval4d::net
