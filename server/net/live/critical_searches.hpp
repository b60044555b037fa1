#pragma once
// The searches of a session for critical values of w, at which the type of the section changes.

#include <memory>
#include <stop_token>
#include <vector>

#include "net/live/peer.hpp"
#include "session/object_loader.hpp"
#include "session/session.hpp"

namespace oval4d::net {

/// A queued or running search for critical values of w.
class CriticalSearchHandle {
  public:
    /// `by`: the connection that requested the search; null if the search is for LiveSession::apply(). `workersStop`:
    /// the stop token of the workers; when the workers are stopped, the search stops, too.
    CriticalSearchHandle(std::weak_ptr<Peer> by, const session::State& state, std::stop_token workersStop);

    bool isRequestedBy(const std::shared_ptr<Peer>& peer) const { return by_.lock() == peer; }
    /// Returns the arguments that determine the result of the search.
    const session::CriticalSearchArguments& arguments() const { return arguments_; }
    std::stop_token stopToken() const { return stop_.get_token(); }
    void stop() { stop_.request_stop(); }

  private:
    struct StopRequester {
        std::stop_source stop;
        void operator()() noexcept { stop.request_stop(); }
    };
    const std::weak_ptr<Peer> by_;
    const session::CriticalSearchArguments arguments_;
    std::stop_source stop_;
    std::stop_callback<StopRequester> whenWorkersStop_;
};

/// The searches of a session. Not thread-safe.
class CriticalSearches {
  public:
    /// Registers a search for the critical values of w of a state. The caller must run the search, and keep the
    /// returned pointer until the search ends.
    std::shared_ptr<CriticalSearchHandle> add(const std::shared_ptr<Peer>& by, const session::State& state,
                                              std::stop_token workersStop);
    /// Requests a stop of the searches that this connection has requested.
    void stop(const std::shared_ptr<Peer>& by);
    /// Requests a stop of the searches whose results this state does not need: those with other arguments().
    void stopUnneeded(const session::State& state);

  private:
    std::vector<std::shared_ptr<CriticalSearchHandle>> running() const;

    std::vector<std::weak_ptr<CriticalSearchHandle>> searches_;  // ended searches are removed when a search is added
};

}  // namespace oval4d::net
