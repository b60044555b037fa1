#pragma once
// The registry of open connections. It limits their number, per client and in total.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>

#include "net/clients.hpp"

namespace oval4d::net {

/// Limits the number of open connections. At a limit, ends an idle connection to make room for a new one. An HTTP
/// connection is idle while it has no request in progress. A WebSocket is idle until its client has joined a session.
/// Every function may be called from any thread.
class ConnectionRegistry {
  public:
    ConnectionRegistry(std::size_t maxConnections, std::size_t maxPerClient)
        : maxConnections_(maxConnections), maxPerClient_(maxPerClient) {}

    /// Why a connection must end: the server is stopping, or the idle connection makes room for another one.
    enum class EndReason { stopping, evicted };
    using EndHandler = std::function<void(EndReason)>;

    /// The registration of one connection. The constructor adds the connection to the registry, and the destructor
    /// removes it.
    class Registration {
      public:
        Registration(ConnectionRegistry& connections, ClientAccountPtr client);
        Registration(const Registration&) = delete;
        Registration& operator=(const Registration&) = delete;
        ~Registration();

        /// Sets the function that ends the connection. The registry calls it, on any thread, when the server stops or
        /// the connection is evicted. If one of these has already happened, setEndHandler() calls the function at once.
        void setEndHandler(EndHandler handler);

        /// Marks the connection as in use or as idle. A connection in use is never evicted. A new connection is idle.
        void setInUse(bool inUse);

        /// Assigns the connection to another client, which a trusted proxy has named in X-Forwarded-For.
        void setClient(const ClientAccountPtr& client);

      private:
        ConnectionRegistry& connections_;
        std::uint64_t number_;
    };

    /// The decision on a new connection: it is admitted, or refused because of one of two limits.
    enum class AdmissionDecision { admitted, server_full, client_full };
    /// Decides whether to admit one more connection of this client. At a limit, evicts idle connections, the oldest
    /// first, until there is room. If the client is at its own limit, these are connections of this client; otherwise,
    /// connections of the client that has the most. Returns the reached limit if no such idle connection is left.
    /// `registered` is the number of registrations that the new connection already has (0 or 1); these do not count
    /// against the limits. `isProxy` tells whether the client is a trusted proxy, to which the limit per client does
    /// not apply.
    AdmissionDecision makeRoomFor(const ClientAccount& client, std::size_t registered = 0, bool isProxy = false);

    /// Returns the number of connections in the registry.
    std::size_t size() const;
    /// Calls the end handlers of all connections with EndReason::stopping. From then on, setEndHandler() calls each new
    /// handler at once.
    void stopAll();

  private:
    // An entry of the registry: a connection, its client and how to end it.
    struct RegisteredConnection {
        ClientAccountPtr client;
        EndHandler end;
        bool inUse = false;
    };
    using ConnectionsByNumber = std::map<std::uint64_t, RegisteredConnection>;

    // The caller of these three functions must hold mutex_.
    std::size_t connectionCountOf(const ClientAccount* client) const;
    EndHandler evictIdle(const ClientAccount* client);
    void decrementCount(const ClientAccount* client);

    const std::size_t maxConnections_, maxPerClient_;
    mutable std::mutex mutex_;
    ConnectionsByNumber entries_;                         // by registration number, the oldest first; guarded by mutex_
    std::map<const ClientAccount*, std::size_t> counts_;  // number of connections of each client; guarded by mutex_
    std::uint64_t last_ = 0;                              // number of the newest registration; guarded by mutex_
    bool stopping_ = false;                               // guarded by mutex_
};

}  // namespace oval4d::net
