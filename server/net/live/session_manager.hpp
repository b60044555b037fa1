#pragma once
// Manages the sessions of this server. Sessions with clients are in memory; all others are in the store.

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "net/live/live_session.hpp"
#include "net/live/sessions_by_client.hpp"
#include "store/write_behind_store.hpp"

namespace oval4d::net {

/// Creates, opens and closes sessions for connections. Every function may be called from any thread.
class SessionManager : public std::enable_shared_from_this<SessionManager> {
  public:
    SessionManager(Services services, std::unique_ptr<store::Store> store);

    using JoinResult = Result<std::shared_ptr<LiveSession>>;
    using JoinHandler = std::function<void(JoinResult)>;

    /// Creates a session, and passes it to `done`. If the number of sessions is at a limit, deletes a closed session
    /// that was never changed; without such a session, passes the error `too_many` to `done`.
    void createSession(const ClientAccountPtr& client, const JoinHandler& done);
    /// Adds a client to the session with these credentials. Loads the session from the store if necessary. Passes the
    /// session to `done`, or an error: `not_found`, `bad_token` or `later_version`; `too_many` if too many jobs are
    /// queued; `internal` if the store does not answer or another server takes over the session.
    void join(const store::SessionCredentials& credentials, const ClientAccountPtr& client, const JoinHandler& done);
    /// Removes the client `peer` from a session. Closes the session if it has no other client. `peer` is null if the
    /// client was never welcomed, as for an upload. Must be called exactly once for each successful call of
    /// createSession() or join().
    void leave(const std::shared_ptr<LiveSession>& session, std::shared_ptr<Peer> peer);

    /// Writes all open sessions to the store, unless sessions are written only when they are closed
    /// (WriteTiming::at_close). Holds `completion` until all are written or the store is found to be unavailable. A
    /// caller that keeps a std::weak_ptr to `completion` can wait until the weak_ptr expires.
    void saveAll(const std::shared_ptr<void>& completion = {});
    const store::WriteBehindStore& writeBehind() const { return writeBehind_; }
    /// Writes pending changes to the store. Gives up after about the time `limit`. The caller must not call any
    /// function of this object afterward.
    void stop(Seconds limit);

    /// Returns the number of sessions with at least one client.
    std::size_t openSessionCount() const;

  private:
    // An open session, and the number of its clients.
    struct SessionWithClients {
        std::shared_ptr<LiveSession> session;
        int clients = 0;  // the session is closed when the number reaches 0
    };
    // The arguments of a call of join() that waits until the session is fetched from the store.
    struct PendingJoin {
        store::SessionCredentials credentials;
        ClientAccountPtr client;
        JoinHandler done;
    };

    store::WriteBehindStore::Listener storeListener();
    std::shared_ptr<LiveSession> find(const std::string& id) const;
    std::optional<Error> admitSessionMakingRoom(ClientAccount& client);
    void evict(const std::string& id);
    // The stored record of a session, with the decoded session and the keys of the session's objects in the store.
    struct DecodedRecord {
        std::shared_ptr<const store::SessionRecord> record;
        session::Session value;
        store::KeysBySerial keys;
    };
    enum class ClaimState : std::uint8_t { unclaimed, claimed };  // whether this server has claimed a record's session

    void onRecordRead(const PendingJoin& pending, store::WriteBehindStore::FetchResult fetch);
    void startDecoding(const PendingJoin& pending, std::shared_ptr<const store::SessionRecord> record,
                       ClaimState ownership);
    void decode(const PendingJoin& pending, const std::shared_ptr<const store::SessionRecord>& stored,
                ClaimState ownership);
    void claim(const PendingJoin& pending, const std::shared_ptr<const DecodedRecord>& decoded);
    void onClaimed(const PendingJoin& pending, const DecodedRecord& decoded,
                   store::WriteBehindStore::FetchResult fetch);
    void finishOpening(const PendingJoin& pending, Result<session::Session> value, store::FencingToken fence = 0);
    std::shared_ptr<LiveSession> createLiveSession(store::SessionCredentials credentials, store::FencingToken fence,
                                                   const ClientAccountPtr& client, session::Session value);
    void disconnectTakenOverSession(const std::string& id);

    const Services services_;
    mutable std::mutex mutex_;
    std::map<std::string, SessionWithClients, std::less<>> live_;  // guarded by mutex_
    SessionsByClient byClient_;                                    // guarded by mutex_
    // The calls of join() that wait for sessions being fetched from the store, by session id. The call that started a
    // fetch is not among them. Guarded by mutex_.
    std::map<std::string, std::vector<PendingJoin>, std::less<>> opening_;
    store::WriteBehindStore writeBehind_;  // declared last, because its thread uses the other members
};

}  // namespace oval4d::net
