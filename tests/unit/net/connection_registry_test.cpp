#include "net/connection_registry.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace oval4d::net {
namespace {

using Slot = ConnectionRegistry::Slot;
using Admission = ConnectionRegistry::Admission;
using EndReason = ConnectionRegistry::EndReason;

class ConnectionRegistryTest : public ::testing::Test {
  protected:
    Clients clients{ClientLimits{}, {}, 0};
    ClientPtr one = clients.at(boost::asio::ip::make_address("192.0.2.1"));
    ClientPtr other = clients.at(boost::asio::ip::make_address("192.0.2.2"));
};

TEST_F(ConnectionRegistryTest, CountsConnections) {
    ConnectionRegistry connections(10, 10);
    const auto first = std::make_unique<Slot>(connections, one);
    {
        const Slot second(connections, one);
        EXPECT_EQ(connections.size(), 2U);
    }
    EXPECT_EQ(connections.size(), 1U);
}

TEST_F(ConnectionRegistryTest, AsksEachConnectionOnceToEnd) {
    ConnectionRegistry connections(10, 10);
    Slot early(connections, one);
    int asked = 0;
    early.onEndRequest([&](EndReason reason) { asked += reason == EndReason::stopping ? 1 : 100; });
    connections.stopAll();
    EXPECT_EQ(asked, 1);
    Slot late(connections, one);
    late.onEndRequest([&](EndReason) { asked += 10; });
    EXPECT_EQ(asked, 11) << "later connections are asked at once";
}

TEST_F(ConnectionRegistryTest, ASlotMayBeDestroyedInItsEndHandler) {
    ConnectionRegistry connections(10, 10);
    auto early = std::make_unique<Slot>(connections, one);
    early->onEndRequest([&](EndReason) { early.reset(); });
    connections.stopAll();
    EXPECT_EQ(connections.size(), 0U);
    auto late = std::make_unique<Slot>(connections, one);
    late->onEndRequest([&](EndReason) { late.reset(); });
    EXPECT_EQ(connections.size(), 0U);
}

TEST_F(ConnectionRegistryTest, EvictsTheOldestIdleConnectionOfAFullClient) {
    ConnectionRegistry connections(100, 3);
    std::vector<std::unique_ptr<Slot>> slots;
    std::vector<int> ended;
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(connections.admit(*one), Admission::admitted);
        slots.push_back(std::make_unique<Slot>(connections, one));
        slots.back()->onEndRequest(
            [&ended, i](EndReason reason) { ended.push_back(reason == EndReason::evicted ? i : -1); });
    }
    slots[0]->setInUse(true);
    EXPECT_EQ(connections.admit(*one), Admission::admitted);
    EXPECT_EQ(ended, std::vector<int>{1});
    const Slot fourth(connections, one);
    slots[2]->setInUse(true);
    EXPECT_EQ(connections.admit(*one), Admission::client_full) << "the fourth has no end handler";
    EXPECT_EQ(connections.admit(*other), Admission::admitted);
    EXPECT_EQ(connections.size(), 3U);
    slots[1].reset();
    EXPECT_EQ(connections.size(), 3U) << "it was evicted before";
}

TEST_F(ConnectionRegistryTest, EvictsFromTheClientWithTheMostConnectionsWhenFull) {
    ConnectionRegistry connections(4, 4);
    std::vector<std::unique_ptr<Slot>> slots;
    int asked = 0;
    for (int i = 0; i < 4; ++i) {
        slots.push_back(std::make_unique<Slot>(connections, i == 0 ? other : one));
        slots.back()->onEndRequest([&asked, i](EndReason) { asked = i; });
    }
    EXPECT_EQ(connections.admit(*other), Admission::admitted);
    EXPECT_EQ(asked, 1) << "the first of the three connections of this client";
    slots.push_back(std::make_unique<Slot>(connections, other));
    for (const auto& slot : slots) slot->setInUse(true);
    EXPECT_EQ(connections.admit(*other), Admission::server_full);
}

TEST_F(ConnectionRegistryTest, AConnectionMayMoveToAnotherClient) {
    ConnectionRegistry connections(10, 1);
    Slot slot(connections, one);
    slot.setInUse(true);
    slot.setClient(other);
    EXPECT_EQ(connections.admit(*one), Admission::admitted);
    EXPECT_EQ(connections.admit(*other), Admission::client_full);
    EXPECT_EQ(connections.admit(*other, 1), Admission::admitted) << "its own slot does not count";
}

}  // namespace
}  // namespace oval4d::net
