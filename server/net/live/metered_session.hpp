#pragma once
// A session in memory, with the bytes that are reserved for it.

#include <cstddef>
#include <memory>

#include "net/byte_budget.hpp"
#include "net/clients.hpp"
#include "session/session.hpp"

namespace oval4d::net {

/// A session whose memory counts as bytes held for the client that opened it (ByteBudget::Account). Not thread-safe.
class MeteredSession {
  public:
    MeteredSession(ClientAccountPtr client, session::Session opened);

    const ClientAccountPtr& client() const { return client_; }

    /// Adjusts the number of reserved bytes to the memory that the session takes after a command. If this number would
    /// exceed a limit on the bytes held for clients, removes the older half of the undo steps, and then reserves the
    /// remaining memory even beyond the limit. `objectsChanged` tells whether the command may have added, removed or
    /// replaced objects of the session.
    void adjustReservationOrTrimUndo(bool objectsChanged);

    session::Session value;

  private:
    const ClientAccountPtr client_;
    std::size_t objectMemory_;             // result of session::unsharedMemoryOfObjects(), in bytes
    ByteBudget::Reservation reservation_;  // covers objectMemory_ and the undo history
};

}  // namespace oval4d::net
