#pragma once
// The registry of open connections, which limits their number per client and in total.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>

#include "net/clients.hpp"

namespace oval4d::net {

/// Limits the number of open connections. At a limit, evicts an idle connection to admit a new one. A connection is
/// idle if it has no HTTP request in progress, or if it is a WebSocket whose client has not yet joined a session. Every
/// function may be called from any thread.
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

        /// Sets the handler that ends the connection. It is called, on any thread, when the server stops or the
        /// connection is evicted; if either has happened already, it is called within this call.
        void onEndRequest(EndHandler handler);

        /// Marks the connection as in use, which protects it from eviction, or as idle. A new connection is idle.
        void setInUse(bool inUse);

        /// Assigns the connection to another client, which a trusted proxy has named.
        void setClient(const ClientPtr& client);

      private:
        ConnectionRegistry& connections_;
        std::uint64_t number_;
    };

    /// Whether a connection is admitted, or else which limit is reached.
    enum class Admission { admitted, server_full, client_full };
    /// Decides whether one more connection of this client is admitted. At a limit, evicts one idle connection: the
    /// oldest one of this client if the client is at its limit, else the oldest one of the client with the most
    /// connections. `registered`: 1 if the new connection already has a slot, which is then not counted, else 0.
    /// `isProxy`: whether the client is a trusted proxy, to which the limit per client does not apply.
    Admission admit(const Client& client, std::size_t registered = 0, bool isProxy = false);

    /// Returns the number of registered connections.
    std::size_t size() const;
    /// Calls the handlers of all connections, and those of future connections as soon as they are set.
    void stopAll();

  private:
    struct Entry {
        ClientPtr client;
        EndHandler end;
        bool inUse = false;
    };
    using Entries = std::map<std::uint64_t, Entry>;

    // These require that mutex_ is held.
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
