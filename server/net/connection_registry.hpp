#pragma once
// The registry of open connections, which limits their number per client and in total.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>

#include "net/clients.hpp"

namespace oval4d::net {

/// Limits the number of open connections. At a limit, evicts an idle connection to admit a new one. An HTTP connection
/// is idle while no request is in progress. A WebSocket is idle until its client has joined a session. Every function
/// may be called from any thread.
class ConnectionRegistry {
  public:
    ConnectionRegistry(std::size_t maxConnections, std::size_t maxPerClient)
        : maxConnections_(maxConnections), maxPerClient_(maxPerClient) {}

    /// The reason why a connection must end: the server is stopping, or the connection was idle and is evicted.
    enum class EndReason { stopping, evicted };
    using EndHandler = std::function<void(EndReason)>;

    /// The registration of one connection. The constructor adds the connection to the registry, and the destructor
    /// removes it.
    class Registration {
      public:
        Registration(ConnectionRegistry& connections, AddressAccountPtr client);
        Registration(const Registration&) = delete;
        Registration& operator=(const Registration&) = delete;
        ~Registration();

        /// Sets the handler that ends the connection. The handler is called, on any thread, when the server stops or
        /// the connection is evicted. If one of these events has already happened, setEndHandler() itself calls the
        /// handler.
        void setEndHandler(EndHandler handler);

        /// Marks the connection as in use, which protects it from eviction, or as idle. A new connection is idle.
        void setInUse(bool inUse);

        /// Assigns the connection to another client, which a trusted proxy has named in X-Forwarded-For.
        void setClient(const AddressAccountPtr& client);

      private:
        ConnectionRegistry& connections_;
        std::uint64_t number_;
    };

    /// The decision on a new connection: admitted, or the limit that is reached.
    enum class AdmissionDecision { admitted, server_full, client_full };
    /// Decides whether to admit one more connection of this client. At a limit, evicts idle connections, the oldest
    /// first, until there is room for the new one: connections of this client if the client is at its limit, else
    /// connections of the client with the most connections. If there is no such idle connection left, returns the limit
    /// that is reached. `registered`: the number of registrations that the new connection itself already has (0 or 1);
    /// they are not counted. `isProxy`: whether the client is a trusted proxy, to which the limit per client does not
    /// apply.
    AdmissionDecision makeRoomFor(const AddressAccount& client, std::size_t registered = 0, bool isProxy = false);

    /// Returns the number of registered connections.
    std::size_t size() const;
    /// Calls the end handlers of all connections with EndReason::stopping. A handler that is set later is called at
    /// once.
    void stopAll();

  private:
    // A connection, as its Registration has recorded it.
    struct RegisteredConnection {
        AddressAccountPtr client;
        EndHandler end;
        bool inUse = false;
    };
    using ConnectionsByNumber = std::map<std::uint64_t, RegisteredConnection>;

    // The next three functions require that mutex_ is held.
    std::size_t countOf(const AddressAccount* client) const;
    EndHandler evictIdle(const AddressAccount* client);
    void uncount(const AddressAccount* client);

    const std::size_t maxConnections_, maxPerClient_;
    mutable std::mutex mutex_;
    ConnectionsByNumber entries_;  // by registration number, the oldest first; guarded by mutex_
    std::map<const AddressAccount*, std::size_t> counts_;  // number of connections of each client; guarded by mutex_
    std::uint64_t last_ = 0;                               // number of the newest registration; guarded by mutex_
    bool stopping_ = false;                                // guarded by mutex_
};

}  // namespace oval4d::net
