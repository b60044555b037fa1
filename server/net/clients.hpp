#pragma once
// Clients, identified and limited by their IP address.

#include <boost/asio/ip/address.hpp>
#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "net/byte_budget.hpp"
#include "net/token_bucket.hpp"
#include "parallel/worker_pool.hpp"

namespace oval4d::net {

/// The limits of one client. Options has those of all clients together.
struct ClientLimits {
    std::size_t connections = 2048;
    std::size_t sessions = 2500;            ///< open sessions, and closed ones that have not expired
    double newSessions = 2000;              ///< per minute, and in one burst
    double wrongTokens = 20;                ///< per minute, and in one burst
    double requests = 20'000;               ///< messages and HTTP requests per second; excess ones are delayed
    std::size_t messageBytes = 16U << 20U;  ///< per second; excess ones are delayed
    std::size_t bytes = 1U << 30U;          ///< bytes held for the client (ByteBudget)
};

/// One client: an IPv4 address or an IPv6 /64 network, the size that providers assign to one customer. Every function
/// may be called from any thread.
class Client {
  public:
    using Clock = TokenBucket::Clock;

    Client(std::string name, const ClientLimits& limits, ByteBudget& budget, Clock::time_point now);

    /// The address or network, such as "192.0.2.7" or "2001:db8:1:2::/64".
    const std::string& name() const { return name_; }

    /// Counts a new session against the rate limit. Returns false, and counts nothing, if the limit is reached.
    bool tryOpenSession(Clock::time_point now);

    /// Counts a wrong token. After too many, mayTryToken() is false for a while, and correct tokens are refused too.
    void countWrongToken(Clock::time_point now);
    bool mayTryToken(Clock::time_point now) const;

    /// Counts a message against the rate limits and returns how long the client must be delayed.
    std::chrono::duration<double> countMessage(std::size_t bytes, Clock::time_point now);

    /// The bytes held for this client.
    ByteBudget::Account& byteAccount() { return *bytes_; }

    /// The client's scheduling identity on the picture workers and on the file workers. Each session has its own lanes.
    const parallel::WorkerPool::ClientPtr& share() const { return share_; }
    const parallel::WorkerPool::ClientPtr& fileShare() const { return fileShare_; }
    /// The lanes for jobs without a session, on the picture workers and on the file workers.
    const parallel::WorkerPool::LanePtr& lane() const { return lane_; }
    const parallel::WorkerPool::LanePtr& fileLane() const { return fileLane_; }
    /// The lane for reading files that the client loads.
    const parallel::WorkerPool::LanePtr& loadingLane() const { return loadingLane_; }

    /// Whether all rate limits have fully recovered, so that forgetting the client changes nothing.
    bool idle(Clock::time_point now) const;

  private:
    const std::string name_;
    const std::shared_ptr<ByteBudget::Account> bytes_;
    const parallel::WorkerPool::ClientPtr share_ = std::make_shared<parallel::WorkerPool::Client>();
    const parallel::WorkerPool::LanePtr lane_ = std::make_shared<parallel::WorkerPool::Lane>(share_);
    const parallel::WorkerPool::ClientPtr fileShare_ =
        std::make_shared<parallel::WorkerPool::Client>();  // of another pool
    const parallel::WorkerPool::LanePtr fileLane_ = std::make_shared<parallel::WorkerPool::Lane>(fileShare_);
    const parallel::WorkerPool::LanePtr loadingLane_ = std::make_shared<parallel::WorkerPool::Lane>(
        std::make_shared<parallel::WorkerPool::Client>());  // of a third pool
    mutable std::mutex mutex_;
    TokenBucket newSessions_, wrongTokens_, requests_, messageBytes_;  // guarded by mutex_
};
using ClientPtr = std::shared_ptr<Client>;

/// An IP network in CIDR notation or a single address: "10.0.0.0/8", "::1".
class Network {
  public:
    /// Parses an address with an optional prefix length. Throws std::invalid_argument if the text is not one.
    explicit Network(const std::string& text);
    bool contains(const boost::asio::ip::address& any) const;

  private:
    boost::asio::ip::address_v6 first_;  // IPv4 addresses are mapped to IPv6
    unsigned bits_;
};

/// All clients, looked up by address. Every function may be called from any thread.
class Clients {
  public:
    /// `trustedProxies`: networks of the proxies whose X-Forwarded-For is trusted. `bytes`: the byte budget of all
    /// clients together.
    Clients(const ClientLimits& limits, const std::vector<std::string>& trustedProxies, std::size_t bytes);

    /// The client at this address, created if it is not known. Once 65,536 clients are known, further ones share one
    /// client, "others".
    ClientPtr at(const boost::asio::ip::address& any);

    bool isTrustedProxy(const boost::asio::ip::address& any) const;

    /// The address of the client behind a proxy. Starts with `proxy` and goes backward through X-Forwarded-For as long
    /// as the current address is a trusted proxy and the next entry is valid; returns the address at which it stops.
    boost::asio::ip::address clientAddress(std::string_view forwardedFor, const boost::asio::ip::address& proxy) const;

    /// Bytes held for all clients together.
    std::size_t bytesHeld() const { return budget_.held(); }
    /// The number of known clients; idle ones are forgotten from time to time.
    std::size_t size() const;

  private:
    void forgetIdle(TokenBucket::Clock::time_point now);

    const ClientLimits limits_;
    std::vector<Network> trusted_;
    ByteBudget budget_;
    mutable std::mutex mutex_;
    std::map<std::string, ClientPtr, std::less<>> clients_;  // guarded by mutex_
    std::size_t sweepAt_;                                    // guarded by mutex_
};

}  // namespace oval4d::net
