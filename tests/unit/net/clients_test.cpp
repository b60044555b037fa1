#include "net/clients.hpp"
#include "net/forwarded.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>

#include "net/live/sessions_by_client.hpp"

namespace oval4d::net {
namespace {

using boost::asio::ip::make_address;
using namespace std::chrono_literals;

constexpr std::size_t kTotalBytes = 1000;

TEST(ClientAccounts, AreIdentifiedByAddress) {
    ClientAccounts clients({}, {}, kTotalBytes);
    EXPECT_EQ(clients.findOrCreate(make_address("192.0.2.1"), {}),
              clients.findOrCreate(make_address("::ffff:192.0.2.1"), {}));
    EXPECT_NE(clients.findOrCreate(make_address("192.0.2.1"), {}), clients.findOrCreate(make_address("192.0.2.2"), {}));
    EXPECT_EQ(clients.findOrCreate(make_address("2001:db8:1:2::1"), {}),
              clients.findOrCreate(make_address("2001:db8:1:2:ffff::9"), {}));
    EXPECT_NE(clients.findOrCreate(make_address("2001:db8:1:2::1"), {}),
              clients.findOrCreate(make_address("2001:db8:1:3::1"), {}));
    EXPECT_EQ(clients.findOrCreate(make_address("2001:db8:1:2::1"), {})->name(), "2001:db8:1:2::/64");
    EXPECT_NE(clients.findOrCreate(make_address("::1"), {}), clients.findOrCreate(make_address("::2"), {}));
}

TEST(ClientAccounts, ForwardedForIsUsedOnlyFromTrustedProxies) {
    const ClientAccounts clients({}, {"10.0.0.0/8", "2001:db8::1"}, kTotalBytes);
    const auto proxy = make_address("10.1.2.3"), stranger = make_address("192.0.2.9");
    const auto addressOf = [&](const char* forwarded, const auto& from) {
        return clients.clientAddress(forwarded, from).to_string();
    };
    EXPECT_EQ(addressOf("198.51.100.7", proxy), "198.51.100.7");
    EXPECT_EQ(addressOf("198.51.100.7", stranger), "192.0.2.9");
    EXPECT_EQ(addressOf("1.1.1.1, 198.51.100.7,10.9.9.9", proxy), "198.51.100.7")
        << "addresses that a client forged come first";
    EXPECT_EQ(addressOf("10.9.9.9", proxy), "10.9.9.9");
    EXPECT_EQ(addressOf("", proxy), "10.1.2.3");
    EXPECT_EQ(addressOf("nonsense", proxy), "10.1.2.3");
    EXPECT_EQ(addressOf("198.51.100.7, nonsense", proxy), "10.1.2.3");
    EXPECT_EQ(addressOf("2001:db8::5", make_address("2001:db8::1")), "2001:db8::5");
    EXPECT_TRUE(clients.isTrustedProxy(make_address("::ffff:10.0.0.1")));
    EXPECT_FALSE(clients.isTrustedProxy(make_address("11.0.0.1")));
}

TEST(ClientAccounts, ForwardedAddressesMayHavePortsBracketsAndQuotes) {
    const auto read = [](std::string_view entry) {
        const auto found = forwardedAddress(entry);
        return found ? found->to_string() : "none";
    };
    for (const char* entry : {"192.0.2.7", "192.0.2.7:51000", " 192.0.2.7:1 ", "\"192.0.2.7:51000\"", "\"192.0.2.7\""})
        EXPECT_EQ(read(entry), "192.0.2.7") << entry;
    for (const char* entry : {"2001:db8::7", "[2001:db8::7]", "[2001:db8::7]:4711", "\"[2001:db8::7]:4711\""})
        EXPECT_EQ(read(entry), "2001:db8::7") << entry;
    for (const char* entry : {"", "unknown", "_hidden", "_a:80", "192.0.2.7:", "192.0.2.7:http", "192.0.2.7:123456",
                              "[192.0.2.7]", "[2001:db8::7", "2001:db8::7]", "[2001:db8::7]x", "192.0.2", "\"", ":80"})
        EXPECT_EQ(read(entry), "none") << entry;
    const ClientAccounts clients({}, {"10.0.0.0/8"}, kTotalBytes);
    const auto addressOf = [&](const char* forwarded) {
        return clients.clientAddress(forwarded, make_address("10.1.2.3")).to_string();
    };
    EXPECT_EQ(addressOf("forged, 198.51.100.7:51000, 10.9.9.9:3128"), "198.51.100.7");
    EXPECT_EQ(addressOf("\"[2001:db8::7]:4711\""), "2001:db8::7");
    for (const char* list : {"198.51.100.21,", "198.51.100.21 , ,", ",198.51.100.21,,10.9.9.9,"})
        EXPECT_EQ(addressOf(list), "198.51.100.21") << list;
    EXPECT_EQ(addressOf(", ,"), "10.1.2.3");
}

TEST(IpNetwork, RejectsMalformedText) {
    for (const char* text : {"", "nobody", "10.0.0.0/33", "10.0.0.0/", "10.0.0.0/x", "::1/129", "10.0.0/8"}) {
        EXPECT_THROW(IpNetwork{text}, std::invalid_argument) << text;
    }
    EXPECT_TRUE(IpNetwork("0.0.0.0/0").contains(make_address("203.0.113.1")));
    EXPECT_FALSE(IpNetwork("0.0.0.0/0").contains(make_address("2001:db8::1")));
    EXPECT_TRUE(IpNetwork("::/0").contains(make_address("203.0.113.1")));
}

TEST(ClientAccount, LimitsNewSessionsPerMinute) {
    ByteBudget budget(kTotalBytes);
    ClientAccount client("one", {.newSessionsPerMinute = 60}, budget, {});
    const auto at = [](double seconds) {
        return ClientAccount::Clock::time_point(
            std::chrono::duration_cast<ClientAccount::Clock::duration>(seconds * 1s));
    };
    int opened = 0;
    for (int i = 0; i < 100; ++i) opened += client.admitNewSession(at(0)) ? 1 : 0;
    EXPECT_EQ(opened, 60);
    EXPECT_FALSE(client.admitNewSession(at(0.5)));
    EXPECT_TRUE(client.admitNewSession(at(1.5)));
    EXPECT_FALSE(client.hasRecoveredRateLimits(at(1.5)));
    EXPECT_TRUE(client.hasRecoveredRateLimits(at(100)));
}

TEST(ClientAccount, LimitsWrongTokensPerMinute) {
    ByteBudget budget(kTotalBytes);
    ClientAccount client("one", {.wrongTokensPerMinute = 3}, budget, {});
    const ClientAccount::Clock::time_point start{};
    for (int i = 0; i < 3; ++i) {
        EXPECT_TRUE(client.mayTryToken(start));
        client.countWrongToken(start);
    }
    for (int i = 0; i < 1000; ++i) client.countWrongToken(start);
    EXPECT_FALSE(client.mayTryToken(start + 10s));
    EXPECT_TRUE(client.mayTryToken(start + 21s)) << "further wrong tokens do not prolong the lockout";
}

TEST(ClientAccount, IsDelayedAboveItsMessageRate) {
    ByteBudget budget(kTotalBytes);
    ClientAccount client("one", {.requestsPerSecond = 100, .messageBytesPerSecond = 1000}, budget, {});
    const ClientAccount::Clock::time_point start{};
    EXPECT_EQ(client.countMessage(1000, start).count(), 0);
    EXPECT_DOUBLE_EQ(client.countMessage(500, start).count(), 0.5);
    EXPECT_EQ(client.countMessage(0, start + 1s).count(), 0);
    for (int i = 0; i < 97; ++i) client.countMessage(0, start + 1s);
    EXPECT_LT(client.countMessage(0, start + 1s).count(), 0.011);
    for (int i = 0; i < 100; ++i) client.countMessage(0, start + 1s);
    EXPECT_NEAR(client.countMessage(0, start + 1s).count(), 1, 0.02);
}

TEST(ByteBudget, LimitsEachClientAndAllTogether) {
    ByteBudget budget(100);
    const auto one = std::make_shared<ByteBudget::Account>(budget, 60);
    const auto other = std::make_shared<ByteBudget::Account>(budget, 60);
    auto first = one->reserve(50);
    ASSERT_TRUE(first);
    EXPECT_FALSE(one->reserve(11)) << "above the limit of one client";
    auto second = other->reserve(50);
    ASSERT_TRUE(second);
    EXPECT_FALSE(other->reserve(1)) << "above the limit of all clients";
    first->forceResize(20);
    EXPECT_EQ(one->heldBytes(), 20U);
    EXPECT_TRUE(one->reserve(30)) << "resizing released bytes at once";
    {
        const auto moved = std::move(*second);
        EXPECT_EQ(other->heldBytes(), 50U);
    }
    EXPECT_EQ(other->heldBytes(), 0U);
    first.reset();
    second.reset();
    auto growing = one->forceReserve(10);
    EXPECT_TRUE(growing.growTo(60));
    EXPECT_FALSE(growing.growTo(61));
    EXPECT_EQ(one->heldBytes(), 60U);
    growing.forceResize(0);
    const auto forced = one->forceReserve(1000);
    EXPECT_EQ(budget.heldBytes(), 1000U);
    EXPECT_FALSE(one->reserve(0));
}

TEST(SessionsByClient, FindsTheOldestUnmodifiedSession) {
    SessionsByClient ledger(100s);
    const SessionsByClient::Clock::time_point start{};
    const std::string one = "one", other = "other";
    for (const char* id : {"a", "b", "c"}) ledger.recordOpened(id, one);
    ledger.recordOpened("d", other);
    EXPECT_EQ(ledger.countSessionsOf(one, start), 3U);
    EXPECT_FALSE(ledger.firstClosedUnmodified(start)) << "all are open";
    ledger.recordClosed("d", true, start);
    ledger.recordClosed("b", false, start + 1s);
    ledger.recordClosed("a", true, start + 2s);
    EXPECT_EQ(ledger.firstClosedUnmodified(start + 2s), "d");
    EXPECT_EQ(ledger.firstClosedUnmodified(start + 2s, &one), "a");
    ledger.recordOpened("d", one);
    EXPECT_EQ(ledger.firstClosedUnmodified(start + 2s), "a") << "d is open again";
    EXPECT_EQ(ledger.countSessionsOf(other, start + 2s), 1U) << "and still belongs to the other client";
    ledger.remove("a");
    EXPECT_EQ(ledger.countSessionsOf(one, start + 2s), 2U);
    EXPECT_EQ(ledger.countSessionsOf(one, start + 101s), 1U) << "b has expired";
    EXPECT_EQ(ledger.countSessionsOf(one, start + 1000s), 1U) << "c is open";
}

}  // namespace
}  // namespace oval4d::net
