#include "net/connection_registry.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <tuple>
#include <vector>

namespace oval4d::net {
namespace {

using Registration = ConnectionRegistry::Registration;
using AdmissionDecision = ConnectionRegistry::AdmissionDecision;
using EndReason = ConnectionRegistry::EndReason;

class ConnectionRegistryTest : public ::testing::Test {
  protected:
    ClientAccounts clients{ClientLimits{}, {}, 0};
    ClientAccountPtr one = clients.findOrCreate(boost::asio::ip::make_address("192.0.2.1"), {});
    ClientAccountPtr other = clients.findOrCreate(boost::asio::ip::make_address("192.0.2.2"), {});
};

TEST_F(ConnectionRegistryTest, CountsConnections) {
    ConnectionRegistry connections(10, 10);
    const auto first = std::make_unique<Registration>(connections, one);
    {
        const Registration second(connections, one);
        EXPECT_EQ(connections.size(), 2U);
    }
    EXPECT_EQ(connections.size(), 1U);
}

TEST_F(ConnectionRegistryTest, AsksEachConnectionOnceToEnd) {
    ConnectionRegistry connections(10, 10);
    Registration early(connections, one);
    int asked = 0;
    early.setEndHandler([&](EndReason reason) { asked += reason == EndReason::stopping ? 1 : 100; });
    connections.stopAll();
    EXPECT_EQ(asked, 1);
    Registration late(connections, one);
    late.setEndHandler([&](EndReason) { asked += 10; });
    EXPECT_EQ(asked, 11) << "later connections are asked at once";
}

TEST_F(ConnectionRegistryTest, ASlotMayBeDestroyedInItsEndHandler) {
    ConnectionRegistry connections(10, 10);
    auto early = std::make_unique<Registration>(connections, one);
    early->setEndHandler([&](EndReason) { early.reset(); });
    connections.stopAll();
    EXPECT_EQ(connections.size(), 0U);
    auto late = std::make_unique<Registration>(connections, one);
    late->setEndHandler([&](EndReason) { late.reset(); });
    EXPECT_EQ(connections.size(), 0U);
}

TEST_F(ConnectionRegistryTest, EvictsTheOldestIdleConnectionOfAFullClient) {
    ConnectionRegistry connections(100, 3);
    std::vector<std::unique_ptr<Registration>> registrations;
    std::vector<int> ended;
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(connections.makeRoomFor(*one), AdmissionDecision::admitted);
        registrations.push_back(std::make_unique<Registration>(connections, one));
        registrations.back()->setEndHandler(
            [&ended, i](EndReason reason) { ended.push_back(reason == EndReason::evicted ? i : -1); });
    }
    registrations[0]->setInUse(true);
    EXPECT_EQ(connections.makeRoomFor(*one), AdmissionDecision::admitted);
    EXPECT_EQ(ended, std::vector<int>{1});
    const Registration fourth(connections, one);
    registrations[2]->setInUse(true);
    EXPECT_EQ(connections.makeRoomFor(*one), AdmissionDecision::client_full) << "the fourth has no end handler";
    EXPECT_EQ(connections.makeRoomFor(*other), AdmissionDecision::admitted);
    EXPECT_EQ(connections.size(), 3U);
    registrations[1].reset();
    EXPECT_EQ(connections.size(), 3U) << "it was evicted before";
}

TEST_F(ConnectionRegistryTest, EvictsFromTheClientWithTheMostConnectionsWhenFull) {
    ConnectionRegistry connections(4, 4);
    std::vector<std::unique_ptr<Registration>> registrations;
    int asked = 0;
    for (int i = 0; i < 4; ++i) {
        registrations.push_back(std::make_unique<Registration>(connections, i == 0 ? other : one));
        registrations.back()->setEndHandler([&asked, i](EndReason) { asked = i; });
    }
    EXPECT_EQ(connections.makeRoomFor(*other), AdmissionDecision::admitted);
    EXPECT_EQ(asked, 1) << "the first of the three connections of this client";
    registrations.push_back(std::make_unique<Registration>(connections, other));
    for (const auto& registration : registrations) registration->setInUse(true);
    EXPECT_EQ(connections.makeRoomFor(*other), AdmissionDecision::server_full);
}

// A refused connection stays registered until it ends. Evicting it makes no room for another connection.
TEST_F(ConnectionRegistryTest, ARefusedConnectionMakesNoRoom) {
    for (const auto& [most, perClient, full] :
         {std::tuple(3, 100, AdmissionDecision::server_full), {100, 3, AdmissionDecision::client_full}}) {
        ConnectionRegistry connections(most, perClient);
        std::vector<std::unique_ptr<Registration>> registrations;
        const auto add = [&](bool inUse) {
            registrations.push_back(std::make_unique<Registration>(connections, one));
            registrations.back()->setEndHandler([](EndReason) {});
            registrations.back()->setInUse(inUse);
        };
        for (int i = 0; i < 3; ++i) {
            EXPECT_EQ(connections.makeRoomFor(*one), AdmissionDecision::admitted);
            add(true);
        }
        EXPECT_EQ(connections.makeRoomFor(*one), full);
        add(false);
        add(false);
        EXPECT_EQ(connections.makeRoomFor(*one), full);
        EXPECT_EQ(connections.size(), 3U) << "those that were refused have been evicted";
        registrations[1]->setInUse(false);
        EXPECT_EQ(connections.makeRoomFor(*one), AdmissionDecision::admitted);
        EXPECT_EQ(connections.size(), 2U);
    }
}

TEST_F(ConnectionRegistryTest, AConnectionMayMoveToAnotherClient) {
    ConnectionRegistry connections(10, 1);
    Registration registration(connections, one);
    registration.setInUse(true);
    registration.setClient(other);
    EXPECT_EQ(connections.makeRoomFor(*one), AdmissionDecision::admitted);
    EXPECT_EQ(connections.makeRoomFor(*other), AdmissionDecision::client_full);
    EXPECT_EQ(connections.makeRoomFor(*other, 1), AdmissionDecision::admitted) << "its own slot does not count";
}

}  // namespace
}  // namespace oval4d::net
