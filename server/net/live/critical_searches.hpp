#pragma once
// The searches of a session for critical values of w. At such a value, the section w = const changes its type.

#include <memory>
#include <stop_token>
#include <vector>

#include "net/live/peer.hpp"
#include "session/object_loader.hpp"
#include "session/session.hpp"

namespace oval4d::net {

/// A queued or running search for critical values of w, which can be stopped.
class CriticalValueSearch {
  public:
    /// `by` is the connection that has requested the search, or null if LiveSession::apply() has requested it.
    /// `workersStop` is the stop token of the workers: when the workers are stopped, the search is stopped, too.
    CriticalValueSearch(std::weak_ptr<Peer> by, const session::State& state, std::stop_token workersStop);

    bool isRequestedBy(const std::shared_ptr<Peer>& peer) const { return by_.lock() == peer; }
    /// Returns the parts of the state that determine the result of the search.
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

/// All searches of one session. Not thread-safe.
class CriticalValueSearches {
  public:
    /// Registers a search for the critical values of w of the object in `state`. The caller must run the search, and
    /// must keep the returned pointer until the search ends. `by` and `workersStop`: see CriticalValueSearch.
    std::shared_ptr<CriticalValueSearch> add(const std::shared_ptr<Peer>& by, const session::State& state,
                                             std::stop_token workersStop);
    /// Stops the searches that the connection `by` has requested.
    void stopSearchesOf(const std::shared_ptr<Peer>& by);
    /// Stops the searches whose results `state` does not need, because their arguments() differ from those of `state`.
    void stopUnneededSearches(const session::State& state);

  private:
    std::vector<std::shared_ptr<CriticalValueSearch>> runningSearches() const;

    std::vector<std::weak_ptr<CriticalValueSearch>> searches_;  // add() removes searches that have ended
};

}  // namespace oval4d::net
