#include "net/clients.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include <spdlog/spdlog.h>

#include "net/forwarded.hpp"
#include "text/message_text.hpp"
#include "text/words.hpp"

namespace oval4d::net {

namespace asio = boost::asio;
using asio::ip::address;
using asio::ip::address_v6;

namespace {

constexpr double kMinute = 60;
// forgetIdleClients() is first called when this many clients are known.
constexpr std::size_t kFirstSweep = 256;
// The maximum number of clients with an account of their own. Further clients share one account.
constexpr std::size_t kMaxClients = 65'536;
constexpr unsigned kBits = 128, kMappedBits = 96;

address_v6 asIPv6(const address& any) {
    return any.is_v6() ? any.to_v6() : asio::ip::make_address_v6(asio::ip::v4_mapped, any.to_v4());
}

/// Returns the name of the client at an address. The name is the address for IPv4 and IPv4-mapped IPv6 addresses and
/// for ::1. For any other IPv6 address, the name is the /64 network of the address.
std::string clientNameOf(const address& any) {
    if (any.is_v4()) return any.to_string();
    address_v6 whole = any.to_v6();
    if (whole.is_v4_mapped()) return asio::ip::make_address_v4(asio::ip::v4_mapped, whole).to_string();
    if (whole.is_loopback()) return whole.to_string();
    auto bytes = whole.to_bytes();
    std::fill(bytes.begin() + bytes.size() / 2, bytes.end(), static_cast<unsigned char>(0));
    return address_v6(bytes).to_string() + "/64";
}

}  // namespace

ClientAccount::ClientAccount(std::string name, const ClientLimits& limits, ByteBudget& budget, Clock::time_point now)
    : name_(std::move(name)),
      bytes_(std::make_shared<ByteBudget::Account>(budget, limits.bytes)),
      newSessions_(limits.newSessionsPerMinute / kMinute, limits.newSessionsPerMinute, now),
      wrongTokens_(limits.wrongTokensPerMinute / kMinute, limits.wrongTokensPerMinute, now),
      requests_(limits.requestsPerSecond, limits.requestsPerSecond, now),
      messageBytes_(static_cast<double>(limits.messageBytesPerSecond),
                    static_cast<double>(limits.messageBytesPerSecond), now) {}

bool ClientAccount::admitNewSession(Clock::time_point now) {
    const std::lock_guard lock(mutex_);
    if (newSessions_.tokensAt(now) < 1) return false;
    newSessions_.take(1, now);
    return true;
}

void ClientAccount::countWrongToken(Clock::time_point now) {
    const std::lock_guard lock(mutex_);
    if (wrongTokens_.tokensAt(now) > 0) wrongTokens_.take(1, now);
}

bool ClientAccount::mayTryToken(Clock::time_point now) const {
    const std::lock_guard lock(mutex_);
    return wrongTokens_.tokensAt(now) >= 1;
}

std::chrono::duration<double> ClientAccount::countMessage(std::size_t bytes, Clock::time_point now) {
    const std::lock_guard lock(mutex_);
    requests_.take(1, now);
    messageBytes_.take(static_cast<double>(bytes), now);
    return std::max(requests_.timeUntilRepaid(now), messageBytes_.timeUntilRepaid(now));
}

std::chrono::duration<double> ClientAccount::countBytes(std::size_t bytes, Clock::time_point now) {
    const std::lock_guard lock(mutex_);
    messageBytes_.take(static_cast<double>(bytes), now);
    return messageBytes_.timeUntilRepaid(now);
}

bool ClientAccount::hasRecoveredRateLimits(Clock::time_point now) const {
    const std::lock_guard lock(mutex_);
    return newSessions_.isFull(now) && wrongTokens_.isFull(now) && requests_.isFull(now) && messageBytes_.isFull(now);
}

IpNetwork::IpNetwork(const std::string& text) {
    const std::size_t slash = text.find('/');
    boost::system::error_code fault;
    const address given = asio::ip::make_address(text.substr(0, slash), fault);
    const unsigned most = given.is_v4() ? kBits - kMappedBits : kBits;
    bits_ = most;
    if (slash != std::string::npos) {
        const char* const end = text.data() + text.size();
        const auto [stopped, bad] = std::from_chars(text.data() + slash + 1, end, bits_);
        if (bad != std::errc{} || stopped != end) bits_ = kBits + 1;
    }
    if (fault || bits_ > most)
        throw std::invalid_argument("a network must be an address or a CIDR range, such as ::1 or 10.0.0.0/8, not '" +
                                    text + "'");
    bits_ += kBits - most;
    first_ = asIPv6(given);
}

bool IpNetwork::contains(const address& any) const {
    const auto own = first_.to_bytes(), other = asIPv6(any).to_bytes();
    for (unsigned bit = 0; bit < bits_; ++bit) {
        const unsigned shift = 7 - bit % 8;
        if (((own[bit / 8] ^ other[bit / 8]) >> shift & 1U) != 0) return false;
    }
    return true;
}

ClientAccounts::ClientAccounts(const ClientLimits& limits, const std::vector<std::string>& trustedProxies,
                               std::size_t bytes)
    : limits_(limits), trusted_(trustedProxies.begin(), trustedProxies.end()), budget_(bytes), sweepAt_(kFirstSweep) {}

ClientAccountPtr ClientAccounts::findOrCreate(const address& any, TokenBucket::Clock::time_point now) {
    const std::lock_guard lock(mutex_);
    std::string name = clientNameOf(any);
    if (clients_.size() >= sweepAt_ && !clients_.contains(name)) forgetIdleClients(now);
    if (clients_.size() >= kMaxClients && !clients_.contains(name)) name = "others";
    ClientAccountPtr& client = clients_[name];
    if (!client) client = std::make_shared<ClientAccount>(name, limits_, budget_, now);
    return client;
}

void ClientAccounts::forgetIdleClients(TokenBucket::Clock::time_point now) {
    std::erase_if(clients_, [now](const auto& entry) {
        return entry.second.use_count() == 1 && entry.second->hasRecoveredRateLimits(now);
    });
    sweepAt_ = std::min(std::max(kFirstSweep, 2 * clients_.size()), kMaxClients);
}

bool ClientAccounts::isTrustedProxy(const address& any) const {
    return std::ranges::any_of(trusted_, [&](const IpNetwork& network) { return network.contains(any); });
}

address ClientAccounts::clientAddress(std::string_view forwardedFor, const address& proxy) const {
    address nearest = proxy;
    while (!forwardedFor.empty() && isTrustedProxy(nearest)) {
        const std::size_t comma = forwardedFor.rfind(',');
        const std::size_t start = comma == std::string_view::npos ? 0 : comma + 1;
        const std::string_view entry = forwardedFor.substr(start);
        forwardedFor = forwardedFor.substr(0, comma == std::string_view::npos ? 0 : comma);
        if (text::trimmed(entry).empty()) continue;  // a list may have empty elements (RFC 9110, section 5.6.1.2)
        const auto before = forwardedAddress(entry);
        if (!before) {
            if (!warnedOfForwarded_.exchange(true))
                spdlog::warn("X-Forwarded-For has no address, so all clients behind it count as one proxy={} entry={}",
                             nearest.to_string(), text::inQuotes(entry));
            break;
        }
        nearest = *before;
    }
    return nearest;
}

std::size_t ClientAccounts::size() const {
    const std::lock_guard lock(mutex_);
    return clients_.size();
}

}  // namespace oval4d::net
