#pragma once
// The searches for critical values of w in a session.

#include <memory>
#include <stop_token>
#include <vector>

#include "net/live/peer.hpp"
#include "session/object_loader.hpp"
#include "session/session.hpp"

namespace oval4d::net {

/// A queued or running search for critical values of w.
class CriticalSearchRun {
  public:
    /// `by`: the connection that requested it, or null. The search stops when the workers are to stop.
    CriticalSearchRun(std::weak_ptr<Peer> by, const session::State& state, std::stop_token workersStop);

    bool isBy(const std::shared_ptr<Peer>& peer) const { return by_.lock() == peer; }
    /// Returns what the result depends on.
    const session::CriticalArguments& arguments() const { return arguments_; }
    std::stop_token stopToken() const { return stop_.get_token(); }
    void stop() { stop_.request_stop(); }

  private:
    struct RequestStop {
        std::stop_source stop;
        void operator()() noexcept { stop.request_stop(); }
    };
    const std::weak_ptr<Peer> by_;
    const session::CriticalArguments arguments_;
    std::stop_source stop_;
    std::stop_callback<RequestStop> whenWorkersStop_;
};

/// The searches of a session. Not thread-safe.
class CriticalSearches {
  public:
    /// Begins a search for the critical values of w of a state. It is registered here as long as the caller keeps it.
    std::shared_ptr<CriticalSearchRun> begin(const std::shared_ptr<Peer>& by, const session::State& state,
                                             std::stop_token workersStop);
    /// Ends the searches that this connection has requested.
    void stop(const std::shared_ptr<Peer>& by);
    /// Ends the searches whose results this state does not need.
    void stopOthers(const session::State& state);

  private:
    std::vector<std::shared_ptr<CriticalSearchRun>> running() const;

    std::vector<std::weak_ptr<CriticalSearchRun>> searches_;  // ended ones are removed when the next one begins
};

}  // namespace oval4d::net
