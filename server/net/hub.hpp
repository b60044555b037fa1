#pragma once
// Which sessions there are: those with clients live here, the others in the store.

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "net/live_session.hpp"
#include "store/keeper.hpp"

namespace oval4d::net {

/// Brings connections and sessions together. Every function may be called from any thread.
class Hub : public std::enable_shared_from_this<Hub> {
  public:
    Hub(Services services, std::unique_ptr<store::Store> store);

    using Joined = protocol::Result<std::shared_ptr<LiveSession>>;
    using Done = std::function<void(Joined)>;

    /// A new session, or `too_many`.
    void create(const Done& done);
    /// The session that the ticket opens; or `not_found`, `bad_token`, or `internal` where the store does not answer.
    void join(const store::Ticket& ticket, const Done& done);
    /// To be called once for each successful `create` and `join`.
    void leave(const std::shared_ptr<LiveSession>& session, std::shared_ptr<Peer> peer);

    /// Has all sessions written, as they are now; `until` is let go of when they are, or the store fails.
    void saveAll(const std::shared_ptr<void>& until = {});
    const store::Keeper& keeper() const { return keeper_; }
    /// Writes what is not yet written, for so long at most. Nothing more is to be called.
    void stop(Seconds limit);

    /// Sessions with a client.
    std::size_t open() const;

  private:
    struct Live {
        std::shared_ptr<LiveSession> session;
        int clients = 0;
    };
    struct Waiting {
        store::Ticket ticket;
        Done done;
    };

    store::Keeper::Listener listener();
    std::shared_ptr<LiveSession> find(const std::string& id) const;
    void fetched(const store::Ticket& ticket, const Done& done, store::Keeper::Fetch fetch);
    void read(const store::Ticket& ticket, const Done& done, const store::Record& record);
    void opened(const store::Ticket& ticket, const Done& done, protocol::Result<session::Session> value);
    std::shared_ptr<LiveSession> bringToLife(store::Ticket ticket, session::Session value);
    void dismiss(const std::string& id);

    const Services services_;
    mutable std::mutex mutex_;
    std::map<std::string, Live, std::less<>> live_;  // guarded by mutex_
    // guarded by mutex_: sessions that are being fetched, and who else wants them
    std::map<std::string, std::vector<Waiting>, std::less<>> opening_;
    store::Keeper keeper_;  // last: its thread calls the listener
};

}  // namespace oval4d::net
