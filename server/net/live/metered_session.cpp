#include "net/live/metered_session.hpp"

#include <utility>

#include "session/history.hpp"

namespace oval4d::net {

MeteredSession::MeteredSession(ClientAccountPtr client, session::Session opened)
    : value(std::move(opened)),
      client_(std::move(client)),
      objectMemory_(session::unsharedMemoryOfObjects(value)),
      reservation_(client_->byteAccount().forceReserve(objectMemory_ + session::historyMemoryWithoutObjects(value))) {}

void MeteredSession::adjustReservationOrTrimUndo(bool objectsChanged) {
    if (objectsChanged) objectMemory_ = session::unsharedMemoryOfObjects(value);
    const std::size_t bytes = objectMemory_ + session::historyMemoryWithoutObjects(value);
    if (bytes > reservation_.size() && !reservation_.growTo(bytes)) {
        session::forgetOlderUndoSteps(value);
        objectMemory_ = session::unsharedMemoryOfObjects(value);
    }
    reservation_.forceResize(objectMemory_ + session::historyMemoryWithoutObjects(value));
}

}  // namespace oval4d::net
