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

/// Saves a session in use, as the store's write policy demands: a short time after each change, and perhaps also before
/// the change is acknowledged. After stopSaving(), never writes the session again. Not thread-safe: the functions of
/// this class, and the functions that they return, must be called on the session's strand.
class SessionSaver : public std::enable_shared_from_this<SessionSaver> {
  public:
    /// The delay from a change to the save. It is short, because the store must be at most one second behind the
    /// session, even on a busy machine.
    static constexpr std::chrono::milliseconds kDelay{250};

    /// A function that hands a value of the session to the store. The store then calls `written`, as in
    /// WriteBehindStore::save().
    using WriteFunction = std::function<void(store::SaveCallback written)>;

    /// `id` is the id of the session. `fence` is the number with which the session was created in the store or fetched
    /// from it (see store::FencingToken). `session` is the session, which the caller changes on `strand`. `clock`
    /// measures the delay.
    SessionSaver(store::WriteBehindStore& writeBehind, std::string id, store::FencingToken fence,
                 std::shared_ptr<const session::Session> session, const TimerClock& clock,
                 const boost::asio::any_io_executor& strand);

    /// Schedules a save after kDelay. Must be called after each change of the session.
    void scheduleSave();

    /// Hands the session to the store. The store saves it as soon as possible and then calls `written`. After
    /// stopSaving(), saves nothing and never calls `written`.
    void saveNow(store::SaveCallback written = {});

    /// Returns a function that writes the present value of the session. Returns an empty optional if a change need not
    /// be written before it is acknowledged. `hasNewObject` tells whether the change has added or replaced an object.
    /// If stopSaving() was called before the function is called, the function writes nothing, and calls its argument
    /// with `false`.
    std::optional<WriteFunction> writeFunctionBeforeAcknowledgment(bool hasNewObject);

    /// Makes this object never write the session to the store again.
    void stopSaving() { detached_ = true; }
    bool hasStoppedSaving() const { return detached_; }

  private:
    WriteFunction makeWriteFunction(store::WriteBehindStore::SaveScope scope);

    store::WriteBehindStore& writeBehind_;
    const std::string id_;
    const store::FencingToken fence_;
    const std::shared_ptr<const session::Session> session_;
    const TimerClock& clock_;
    OneShotTimer timer_;  // measures kDelay
    bool detached_ = false;
};

}  // namespace oval4d::net
