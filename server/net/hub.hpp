#pragma once
// Which sessions there are: those with clients live here, the others in the store.

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "net/live_session.hpp"
#include "store/store.hpp"

namespace oval4d::net {

/// Brings connections and sessions together. Every function may be called from any thread.
class Hub : public std::enable_shared_from_this<Hub> {
  public:
    Hub(Services services, std::unique_ptr<store::Store> store) : services_(services), store_(std::move(store)) {}

    using Joined = protocol::Result<std::shared_ptr<LiveSession>>;

    /// A new session, or `too_many`.
    Joined create();
    /// The session that the ticket opens, or `not_found` or `bad_token`.
    Joined join(const store::Ticket& ticket);
    /// To be called once for each successful `create` and `join`.
    void leave(const std::shared_ptr<LiveSession>& session, std::shared_ptr<Peer> peer);

    /// Forgets the sessions that nobody has had open for `age`, and brings the metrics up to date.
    void tidy(Seconds age);

  private:
    struct Live {
        std::shared_ptr<LiveSession> session;
        int clients = 0;
    };

    std::shared_ptr<LiveSession> bringToLife(store::Ticket ticket, session::Session value);
    void countSessions();

    const Services services_;
    const std::unique_ptr<store::Store> store_;
    std::mutex mutex_;
    std::map<std::string, Live, std::less<>> live_;  // guarded by mutex_
};

}  // namespace oval4d::net
