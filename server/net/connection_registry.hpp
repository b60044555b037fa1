#pragma once
// The registry of open connections, which limits their number per client and in total.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>

#include "net/clients.hpp"

namespace oval4d::net {

/// Limits the number of open connections. When the limit is reached, evicts an idle connection to admit a new one: a
/// socket without a request in progress, or one that waits for its first message. Every function may be called from any
/// thread.
class ConnectionRegistry {
  public:
    ConnectionRegistry(std::size_t maxConnections, std::size_t maxPerClient)
        : maxConnections_(maxConnections), maxPerClient_(maxPerClient) {}

    /// The reason why a connection must end: the server is stopping, or an idle connection is evicted.
    enum class EndReason { stopping, evicted };
    using EndHandler = std::function<void(EndReason)>;

    /// One connection in the registry; the destructor removes it.
    class Slot {
      public:
        Slot(ConnectionRegistry& connections, ClientPtr client);
        Slot(const Slot&) = delete;
        Slot& operator=(const Slot&) = delete;
        ~Slot();

        /// Sets the handler that ends the connection. It is called from any thread: when the server stops or the
        /// connection is evicted, or within this call if either has happened already.
        void onEndRequest(EndHandler handler);

        /// Marks the connection as in use, which protects it from eviction, or as idle. It starts idle.
        void setInUse(bool inUse);

        /// Assigns the connection to another client, as identified by a trusted proxy.
        void setClient(const ClientPtr& client);

      private:
        ConnectionRegistry& connections_;
        std::uint64_t number_;
    };

    enum class Admission { admitted, server_full, client_full };
    /// Decides whether one more connection of this client is admitted. At a limit, evicts one idle connection: the
    /// oldest idle one of this client if the client is at its limit, else of the client with the most connections.
    /// `registered`: the number of connections of this client to leave out of the count, since the new one has its slot
    /// already. `isProxy`: the client is a trusted proxy and exempt from the limit per client.
    Admission admit(const Client& client, std::size_t registered = 0, bool isProxy = false);

    std::size_t size() const;
    /// Asks all connections to end, now and in future.
    void stopAll();

  private:
    struct Entry {
        ClientPtr client;
        EndHandler end;
        bool inUse = false;
    };
    using Entries = std::map<std::uint64_t, Entry>;

    // With mutex_ held.
    std::size_t countOf(const Client* client) const;
    EndHandler evictIdle(const Client* client);
    void uncount(const Client* client);

    const std::size_t maxConnections_, maxPerClient_;
    mutable std::mutex mutex_;
    Entries entries_;                              // guarded by mutex_; the oldest first
    std::map<const Client*, std::size_t> counts_;  // guarded by mutex_
    std::uint64_t last_ = 0;                       // guarded by mutex_
    bool stopping_ = false;                        // guarded by mutex_
};

}  // namespace oval4d::net
