#pragma once
// Saves a session in use to the store at the right times.

#include <boost/asio/any_io_executor.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "net/clock.hpp"
#include "net/one_shot_timer.hpp"
#include "session/session.hpp"
#include "store/write_behind_store.hpp"

namespace oval4d::net {

/// Saves a session in use, as the write policy of the store demands: a short time after each change, and perhaps before
/// the change is acknowledged. After detach(), never writes the session again. Not thread-safe: the functions of this
/// class, and the functions that they return, must be called on the strand of the session.
class SessionSaver : public std::enable_shared_from_this<SessionSaver> {
  public:
    /// Delay from a change until the session is saved. The store must be at most a second behind the session, even on a
    /// busy machine.
    static constexpr std::chrono::milliseconds kDelay{250};

    /// Hands a value of the session to the store, which calls `written` as WriteBehindStore::save() does.
    using WriteFunction = std::function<void(store::SaveCallback written)>;

    /// `fence`: the fence with which the session was created in the store or fetched from it (see store::Fence).
    /// `session`: the session, which the caller changes on `strand`. `clock` measures the delay.
    SessionSaver(store::WriteBehindStore& writeBehind, std::string id, store::Fence fence,
                 std::shared_ptr<const session::Session> session, const TimerClock& clock,
                 const boost::asio::any_io_executor& strand);

    /// Schedules a save. Must be called after each change.
    void scheduleSave();

    /// Hands the session to the store, which saves it as soon as possible and then calls `written`. If the session is
    /// detached, saves nothing and destroys `written` without calling it.
    void saveNow(store::SaveCallback written = {});

    /// If a change must be written before it is acknowledged, returns a function that writes the session as it is now;
    /// else returns an empty optional. `hasNewObject`: whether the change has added or replaced an object of the
    /// session. If the session is detached when the function is called, it writes nothing, and calls its argument with
    /// `false`.
    std::optional<WriteFunction> writeBeforeAcknowledgment(bool hasNewObject);

    /// Makes this object never write the session to the store again.
    void detach() { detached_ = true; }
    bool isDetached() const { return detached_; }

  private:
    WriteFunction writeOf(store::WriteBehindStore::SaveScope scope);

    store::WriteBehindStore& writeBehind_;
    const std::string id_;
    const store::Fence fence_;
    const std::shared_ptr<const session::Session> session_;
    const TimerClock& clock_;
    OneShotTimer timer_;  // of the delay
    bool detached_ = false;
};

}  // namespace oval4d::net
