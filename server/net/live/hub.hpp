#pragma once
// The hub of all sessions: sessions with clients are held here, the others are in the store.

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "net/live/live_session.hpp"
#include "net/live/session_ledger.hpp"
#include "store/write_behind_store.hpp"

namespace oval4d::net {

/// Creates, opens and closes sessions for connections. Every function may be called from any thread.
class Hub : public std::enable_shared_from_this<Hub> {
  public:
    Hub(Services services, std::unique_ptr<store::Store> store);

    using JoinResult = Result<std::shared_ptr<LiveSession>>;
    using JoinHandler = std::function<void(JoinResult)>;

    /// Creates a session and passes it, or the error `too_many`, to `done`. At a limit, deletes a closed session that
    /// was never changed.
    void create(const ClientPtr& client, const JoinHandler& done);
    /// Opens the session with these credentials and passes it to `done`, or an error: `not_found`, `bad_token`,
    /// `too_many` if too many jobs are queued, or `internal` if the store does not answer.
    void join(const store::SessionCredentials& credentials, const ClientPtr& client, const JoinHandler& done);
    /// Removes a client from a session. Must be called once for each successful `create` and `join`.
    void leave(const std::shared_ptr<LiveSession>& session, std::shared_ptr<Peer> peer);

    /// Writes all sessions to the store in their current state. Releases `completion` once they are written or the
    /// store has failed.
    void saveAll(const std::shared_ptr<void>& completion = {});
    const store::WriteBehindStore& writeBehind() const { return writeBehind_; }
    /// Writes all pending changes to the store, for at most this time. No function may be called afterwards.
    void stop(Seconds limit);

    /// The number of sessions with at least one client.
    std::size_t openCount() const;

  private:
    struct LiveEntry {
        std::shared_ptr<LiveSession> session;
        int clients = 0;
    };
    /// A join that waits for the session to be fetched from the store.
    struct PendingJoin {
        store::SessionCredentials credentials;
        ClientPtr client;
        JoinHandler done;
    };

    store::WriteBehindStore::Listener listener();
    std::shared_ptr<LiveSession> find(const std::string& id) const;
    std::optional<Error> admitSession(Client& client);
    void evict(const std::string& id);
    void onFetched(const PendingJoin& pending, store::WriteBehindStore::FetchResult fetch);
    void decode(const PendingJoin& pending, const store::Record& record);
    void finishOpening(const PendingJoin& pending, Result<session::Session> value);
    std::shared_ptr<LiveSession> activate(store::SessionCredentials credentials, const ClientPtr& client,
                                          session::Session value);
    void dismiss(const std::string& id);

    const Services services_;
    mutable std::mutex mutex_;
    std::map<std::string, LiveEntry, std::less<>> live_;  // guarded by mutex_
    SessionLedger ledger_;                                // guarded by mutex_
    // Guarded by mutex_: the sessions being fetched, with further joins that wait for them.
    std::map<std::string, std::vector<PendingJoin>, std::less<>> opening_;
    store::WriteBehindStore writeBehind_;  // declared last: its thread calls the listener
};

}  // namespace oval4d::net
