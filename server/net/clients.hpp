#pragma once
// The clients of the server, which are identified by IP address, and the limits on each client.

#include <atomic>
#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include <boost/asio/ip/address.hpp>

#include "net/byte_budget.hpp"
#include "net/token_bucket.hpp"
#include "parallel/worker_pool.hpp"

namespace oval4d::net {

/// The limits on one client. ServerOptions has the limits on all clients together.
struct ClientLimits {
    std::size_t connections = 2048;                  ///< maximum number of open connections
    std::size_t sessions = 2500;                     ///< maximum number of open sessions, and of closed sessions that
                                                     ///< have not expired, together
    double newSessionsPerMinute = 2000;              ///< maximum new sessions per minute; all may come at once
    double wrongTokensPerMinute = 20;                ///< maximum wrong tokens per minute; all may come at once
    double requestsPerSecond = 20'000;               ///< messages and HTTP requests per second; excess ones are delayed
    std::size_t messageBytesPerSecond = 16U << 20U;  ///< bytes of messages per second; excess messages are delayed
    std::size_t bytes = 1U << 30U;                   ///< maximum bytes held for the client (ByteBudget)
};

/// The account of one client. It has the client's rate limits, the count of the bytes that the server holds for the
/// client (ByteBudget::Account), and the client's job queues in the worker pools (see parallel::FairQueue). A client is
/// everybody at one IPv4 address or in one IPv6 /64 network, the size that providers assign to one customer. Every
/// function may be called from any thread.
class ClientAccount {
  public:
    using Clock = TokenBucket::Clock;

    ClientAccount(std::string name, const ClientLimits& limits, ByteBudget& budget, Clock::time_point now);

    /// Returns the client's address or network, such as "192.0.2.7" or "2001:db8:1:2::/64".
    const std::string& name() const { return name_; }

    /// Counts a new session against the limit of new sessions per minute. If this limit is reached, returns false and
    /// counts nothing.
    bool admitNewSession(Clock::time_point now);

    /// Counts a wrong token against the limit of wrong tokens per minute.
    void countWrongToken(Clock::time_point now);
    /// Returns whether the client may present a token. After too many wrong tokens, this is false for some time; the
    /// caller must then refuse even correct tokens.
    bool mayTryToken(Clock::time_point now) const;

    /// Counts a message or an HTTP request of `bytes` bytes against the rate limits. Returns how long the caller must
    /// delay the message or request.
    std::chrono::duration<double> countMessage(std::size_t bytes, Clock::time_point now);

    /// Counts a part of a request body, `bytes` bytes long, against the limit of bytes per second. Returns how long the
    /// caller must wait before it reads the next part.
    std::chrono::duration<double> countBytes(std::size_t bytes, Clock::time_point now);

    /// Returns the account that counts the bytes held for this client.
    ByteBudget::Account& byteAccount() { return *bytes_; }

    /// pictureFlow() and exportFlow() return the client's flows (see parallel::FairQueue). A flow is the client's share
    /// of one worker pool: pictureFlow() belongs to the picture workers, exportFlow() to the export workers. Each
    /// session of the client creates its own job queue in each flow.
    const parallel::WorkerPool::ClientFlowPtr& pictureFlow() const { return pictureFlow_; }
    const parallel::WorkerPool::ClientFlowPtr& exportFlow() const { return exportFlow_; }
    /// pictureJobQueue() and exportJobQueue() return the client's job queues for work that belongs to no session:
    /// pictureJobQueue() for the pool of picture workers, exportJobQueue() for the pool of export workers.
    const parallel::WorkerPool::JobQueuePtr& pictureJobQueue() const { return pictureJobQueue_; }
    const parallel::WorkerPool::JobQueuePtr& exportJobQueue() const { return exportJobQueue_; }
    /// Returns the client's job queue in the pool of load workers (see Services::loadWorkers).
    const parallel::WorkerPool::JobQueuePtr& loadJobQueue() const { return loadJobQueue_; }

    /// Returns whether all rate limits have fully recovered. This account may then be deleted, because a new account
    /// would treat the client in the same way.
    bool hasRecoveredRateLimits(Clock::time_point now) const;

  private:
    const std::string name_;
    const std::shared_ptr<ByteBudget::Account> bytes_;
    const parallel::WorkerPool::ClientFlowPtr pictureFlow_ = std::make_shared<parallel::WorkerPool::ClientFlow>();
    const parallel::WorkerPool::JobQueuePtr pictureJobQueue_ =
        std::make_shared<parallel::WorkerPool::JobQueue>(pictureFlow_);
    const parallel::WorkerPool::ClientFlowPtr exportFlow_ =
        std::make_shared<parallel::WorkerPool::ClientFlow>();  // in the pool of export workers
    const parallel::WorkerPool::JobQueuePtr exportJobQueue_ =
        std::make_shared<parallel::WorkerPool::JobQueue>(exportFlow_);
    const parallel::WorkerPool::JobQueuePtr loadJobQueue_ = std::make_shared<parallel::WorkerPool::JobQueue>(
        std::make_shared<parallel::WorkerPool::ClientFlow>());  // in the pool of load workers
    mutable std::mutex mutex_;
    TokenBucket newSessions_, wrongTokens_, requests_, messageBytes_;  // guarded by mutex_
};
using ClientAccountPtr = std::shared_ptr<ClientAccount>;

/// An IP network in CIDR notation such as "10.0.0.0/8", or a single address such as "::1".
class IpNetwork {
  public:
    /// Parses an address with an optional prefix length. Throws std::invalid_argument if `text` is anything else.
    explicit IpNetwork(const std::string& text);
    /// Returns whether the network contains the address. IPv4-mapped IPv6 addresses count as IPv4 addresses.
    bool contains(const boost::asio::ip::address& any) const;

  private:
    boost::asio::ip::address_v6 first_;  // the first address; IPv4 addresses are mapped to IPv6
    unsigned bits_;                      // how many leading bits of first_ all addresses share, from 0 to 128
};

/// The accounts of all known clients, by address. Every function may be called from any thread.
class ClientAccounts {
  public:
    /// `trustedProxies` are the networks (see IpNetwork) of proxies whose header X-Forwarded-For is trusted. `bytes` is
    /// the maximum number of bytes held for all clients together (ByteBudget).
    ClientAccounts(const ClientLimits& limits, const std::vector<std::string>& trustedProxies, std::size_t bytes);

    /// Returns the account of the client at this address. Creates an account for an unknown client. Once 65,536 clients
    /// are known, all unknown clients share one account, "others". A new account counts its rate limits from the time
    /// `now`.
    ClientAccountPtr findOrCreate(const boost::asio::ip::address& any, TokenBucket::Clock::time_point now);

    bool isTrustedProxy(const boost::asio::ip::address& any) const;

    /// Returns the address of the client behind one or more proxies. `forwardedFor` is the value of X-Forwarded-For.
    /// Starts at the address `proxy`, and goes through the entries of `forwardedFor` from the last one to the first.
    /// Moves on while the current address belongs to a trusted proxy and the next entry is an address (see
    /// forwardedAddress()). Returns the address at which it stops. The first time that an entry is not an address, logs
    /// a warning.
    boost::asio::ip::address clientAddress(std::string_view forwardedFor, const boost::asio::ip::address& proxy) const;

    /// Returns the number of bytes held for all clients together.
    std::size_t bytesHeld() const { return budget_.heldBytes(); }
    /// Returns the number of known clients. A client is known until forgetIdleClients() deletes its account.
    std::size_t size() const;

  private:
    /// Deletes the accounts to which nothing else refers and whose rate limits have fully recovered.
    void forgetIdleClients(TokenBucket::Clock::time_point now);

    const ClientLimits limits_;
    std::vector<IpNetwork> trusted_;
    mutable std::atomic<bool> warnedOfForwarded_ = false;
    ByteBudget budget_;
    mutable std::mutex mutex_;
    std::map<std::string, ClientAccountPtr, std::less<>> clients_;  // guarded by mutex_
    std::size_t sweepAt_;  // forgetIdleClients() is called at this number of clients; guarded by mutex_
};

}  // namespace oval4d::net
