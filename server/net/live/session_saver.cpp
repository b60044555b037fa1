#include "net/live/session_saver.hpp"

#include <utility>

namespace oval4d::net {

using SaveScope = store::WriteBehindStore::SaveScope;
using WriteTiming = store::Store::WriteTiming;

SessionSaver::SessionSaver(store::WriteBehindStore& writeBehind, std::string id, store::FencingToken fence,
                           std::shared_ptr<const session::Session> session, const TimerClock& clock,
                           const boost::asio::any_io_executor& strand)
    : writeBehind_(writeBehind),
      id_(std::move(id)),
      fence_(fence),
      session_(std::move(session)),
      clock_(clock),
      timer_(clock, strand) {}

void SessionSaver::scheduleSave() {
    if (writeBehind_.writeTiming() == WriteTiming::at_close) return;
    writeBehind_.recordUnsavedChange(id_, fence_);
    timer_.startUnlessRunning(weak_from_this(), clock_.now() + kDelay, [](SessionSaver& saver) { saver.saveNow(); });
}

void SessionSaver::saveNow(store::SaveCallback written) {
    if (!detached_) writeBehind_.save(id_, fence_, *session_, SaveScope::whole, std::move(written));
}

std::optional<SessionSaver::WriteFunction> SessionSaver::writeFunctionBeforeAcknowledgment(bool hasNewObject) {
    if (writeBehind_.writeTiming() != WriteTiming::at_once) return std::nullopt;
    // Saving only the head of a record saves no objects, so a change with a new object requires SaveScope::whole.
    return makeWriteFunction(hasNewObject ? SaveScope::whole : SaveScope::head);
}

/// Returns a function that writes the present value of the session: all of it, or only its head (the state and the
/// revision).
SessionSaver::WriteFunction SessionSaver::makeWriteFunction(SaveScope scope) {
    session::Session value;
    if (scope == SaveScope::whole) {
        value = *session_;
    } else {
        value.current = session_->current;
        value.revision = session_->revision;
    }
    return [self = shared_from_this(), scope, value = std::move(value)](const store::SaveCallback& written) {
        if (self->detached_) return written(false);
        self->writeBehind_.save(self->id_, self->fence_, value, scope, written);
    };
}

}  // namespace oval4d::net
