#pragma once
// A session in memory, and the bytes that are reserved for it.

#include <cstddef>
#include <memory>

#include "net/byte_budget.hpp"
#include "net/clients.hpp"
#include "session/session.hpp"

namespace oval4d::net {

/// A session whose memory counts as bytes held for the client that opened it (ByteBudget::Account). Not thread-safe.
class MeteredSession {
  public:
    MeteredSession(AddressAccountPtr client, session::Session opened);

    const AddressAccountPtr& client() const { return client_; }

    /// Adjusts the reserved bytes to the memory of the session after a command. If they would exceed a limit on the
    /// bytes held for clients, removes the older half of the undo steps, and reserves the memory of the remaining
    /// session, even if it exceeds the limit. `objectsChanged`: whether the command may have added, removed or replaced
    /// objects of the session.
    void adjustReservationOrTrimUndo(bool objectsChanged);

    session::Session value;

  private:
    const AddressAccountPtr client_;
    std::size_t objectMemory_;             // result of session::ownObjectMemory(), in bytes
    ByteBudget::Reservation reservation_;  // for objectMemory_ and the memory of the history
};

}  // namespace oval4d::net
