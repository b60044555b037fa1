#include "net/live/session_manager.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>

#include "net/jobs/file_reader.hpp"
#include "store/object_codec.hpp"
#include "store/secret.hpp"
#include "store/session_codec.hpp"

namespace oval4d::net {

using store::KeysBySerial;
using store::WriteBehindStore;

namespace {

const Error kTakenOver{ErrorCode::internal, "another server has taken over this session; try again"};

store::WriteBehindStore::WriteBehindSettings writeBehindSettings(const ServerOptions& options) {
    return {std::chrono::duration_cast<store::Milliseconds>(options.sessionExpiry), options.keptUndo,
            options.storeQuota};
}

/// Looks up the objects of a stored record (a store::ObjectLookup). Decodes each object when it is first requested.
/// keysBySerial() returns the keys of the decoded objects.
class RecordObjectDecoder {
  public:
    RecordObjectDecoder(const store::SessionRecord& record, store::DataFolderReader open) : open_(std::move(open)) {
        for (const auto& [key, bytes] : record.objects) bytes_[key] = bytes;
    }
    std::optional<slicing::Object> operator()(const std::string& key) {
        auto& object = decoded_[key];
        if (!object && bytes_.contains(key)) object = store::decodeObjectRecord(bytes_[key], open_);
        return object;
    }
    KeysBySerial keysBySerial() const {
        KeysBySerial keys;
        for (const auto& [key, object] : decoded_) {
            if (object) keys[slicing::infoOf(*object).serial] = key;
        }
        return keys;
    }

  private:
    store::DataFolderReader open_;
    std::map<std::string, std::string_view> bytes_;
    std::map<std::string, std::optional<slicing::Object>> decoded_;
};

/// Returns the estimated time to decode the stored record of a session.
Seconds decodingCost(const store::SessionRecord& record) {
    constexpr double kByte = 1e-7;  // seconds for each byte
    std::size_t bytes = record.whole.size() + record.head.size();
    for (const auto& [key, object] : record.objects) bytes += object.size();
    return Seconds(1e-4 + kByte * static_cast<double>(bytes));
}

}  // namespace

SessionManager::SessionManager(Services services, std::unique_ptr<store::Store> store)
    : services_(services),
      byClient_(std::chrono::duration_cast<SessionsByClient::Clock::duration>(services.options.sessionExpiry)),
      writeBehind_(std::move(store), writeBehindSettings(services.options), storeListener(),
                   [&clock = services.clock] { return clock.now(); }) {}

WriteBehindStore::Listener SessionManager::storeListener() {
    return {[this](const std::string& id) { disconnectTakenOverSession(id); },
            [this](const std::string& id) {
                if (const auto session = find(id)) session->save();
            },
            [this] { saveAll(); },
            [this](const char* operation, double seconds, bool succeeded) {
                services_.metrics.observeStore(operation, seconds, succeeded);
            }};
}

/// Counts a new session against the client's limit of new sessions per minute. If the number of stored sessions is at a
/// limit, evicts a closed session that was never changed. Returns an error if the limit per minute is reached or no
/// session can be evicted. The caller must hold mutex_.
std::optional<Error> SessionManager::admitSessionMakingRoom(ClientAccount& client) {
    const auto now = services_.clock.now();
    const ServerOptions& options = services_.options;
    // The session to evict is found here, but is evicted only when no limit can refuse the new session anymore.
    std::optional<std::string> evicted;
    if (byClient_.countSessionsOf(client.name(), now) >= options.client.sessions) {
        evicted = byClient_.firstClosedUnmodified(now, &client.name());
        if (!evicted) {
            return Error{ErrorCode::too_many, "the server stores at most " + std::to_string(options.client.sessions) +
                                                  " sessions for one address; reopen one of them or try again later"};
        }
    } else if (writeBehind_.sessionCount() >= options.maxSessions) {
        evicted = byClient_.firstClosedUnmodified(now);
        if (!evicted) {
            return Error{ErrorCode::too_many, "the server stores at most " + std::to_string(options.maxSessions) +
                                                  " sessions, and none of them may be discarded now; try again later"};
        }
    }
    if (!client.admitNewSession(now)) {
        const auto most = static_cast<long long>(options.client.newSessionsPerMinute);
        return Error{ErrorCode::too_many,
                     "one address may open at most " + std::to_string(most) + " sessions per minute; try again soon"};
    }
    if (evicted) evict(*evicted);
    return std::nullopt;
}

/// Deletes a session to make room for a new one. The caller must hold mutex_.
void SessionManager::evict(const std::string& id) {
    spdlog::debug("session evicted for a new one session={}", id);
    writeBehind_.remove(id);
    byClient_.remove(id);
}

void SessionManager::createSession(const ClientAccountPtr& client, const JoinHandler& done) {
    std::unique_lock lock(mutex_);
    if (auto refused = admitSessionMakingRoom(*client)) {
        lock.unlock();
        done(std::move(*refused));
        return;
    }
    const store::SessionCredentials credentials = writeBehind_.createSession();
    const auto session = createLiveSession(credentials, store::kFirstFence, client, session::Session{});
    lock.unlock();
    spdlog::info("session created session={}", credentials.id);
    if (writeBehind_.writeTiming() == store::Store::WriteTiming::at_once) {
        // The shared store must have the session before the client learns its id, so that every server can open the
        // session.
        writeBehind_.save(credentials.id, store::kFirstFence, session::Session{}, WriteBehindStore::SaveScope::whole,
                          [done, session](bool) { done(session); });
    } else {
        if (writeBehind_.writeTiming() == store::Store::WriteTiming::soon) session->save();
        done(session);
    }
}

void SessionManager::join(const store::SessionCredentials& credentials, const ClientAccountPtr& client,
                          const JoinHandler& done) {
    std::unique_lock lock(mutex_);
    if (const auto found = live_.find(credentials.id); found != live_.end()) {
        SessionWithClients& live = found->second;
        const auto session = live.session;
        const bool authorized = store::equalInConstantTime(credentials.token, session->credentials().token);
        if (authorized) ++live.clients;
        lock.unlock();
        done(authorized ? JoinResult(session) : Error{ErrorCode::bad_token, "this token does not match the session"});
        return;
    }
    const auto [opening, isFirst] = opening_.try_emplace(credentials.id);
    if (!isFirst) {
        opening->second.push_back({credentials, client, done});
        return;
    }
    lock.unlock();
    writeBehind_.read(credentials,
                      [self = shared_from_this(), pending = PendingJoin{credentials, client, done}](
                          WriteBehindStore::FetchResult fetch) { self->onRecordRead(pending, std::move(fetch)); });
}

/// Handles a session that was read from the store. Runs on the thread of the write-behind store. This server claims the
/// session only after the session's record has been decoded. So it does not take over a session that it cannot open:
/// such a session stays with the server that has it open.
void SessionManager::onRecordRead(const PendingJoin& pending, WriteBehindStore::FetchResult fetch) {
    if (!fetch) {
        finishOpening(pending, fetch.error());
    } else if (fetch->session) {
        finishOpening(pending, std::move(*fetch->session), fetch->record.fence);
    } else {
        startDecoding(pending, std::make_shared<const store::SessionRecord>(std::move(fetch->record)),
                      ClaimState::unclaimed);
    }
}

/// Makes a worker decode a record, because decoding here would block the thread of the write-behind store. `ownership`
/// tells whether this server has claimed the session.
void SessionManager::startDecoding(const PendingJoin& pending, std::shared_ptr<const store::SessionRecord> record,
                                   ClaimState ownership) {
    const Seconds cost = decodingCost(*record);
    // A record that refers to a file of the data folder goes to a load worker, because opening the file may take long.
    const bool opensFile =
        std::ranges::any_of(record->objects, [](const auto& object) { return store::refersToFile(object.second); });
    parallel::WorkerPool& pool = opensFile ? services_.loadWorkers : services_.pictureWorkers.workers();
    const bool accepted =
        pool.post([self = shared_from_this(), pending, record = std::move(record),
                   ownership](std::size_t /*worker*/) { self->decode(pending, record, ownership); },
                  opensFile ? pending.client->loadJobQueue() : pending.client->pictureJobQueue(), cost);
    if (accepted) return;
    if (ownership == ClaimState::claimed) writeBehind_.discardFetched(pending.credentials.id);
    finishOpening(pending, kTooManyJobs);
}

void SessionManager::decode(const PendingJoin& pending, const std::shared_ptr<const store::SessionRecord>& stored,
                            ClaimState ownership) {
    const store::SessionRecord& record = *stored;
    const std::string& id = pending.credentials.id;
    // Whether a file to which the record refers was not read, and whether this file may be readable later.
    bool isUnread = false, mustWait = false;
    try {
        RecordObjectDecoder objects(record, [&](const session::LoadObject& load) -> Result<slicing::Object> {
            isUnread = mustWait = true;  // both stay true if the reader throws an exception, as when the server stops
            const auto loaded = makeFileReader(services_)(load, services_.options.session);
            isUnread = !loaded;
            if (loaded) return loaded->object;
            // `too_large` also means that reading took too long, which may happen when many files are read at once.
            constexpr std::array kForNow{ErrorCode::too_many, ErrorCode::too_large, ErrorCode::internal};
            mustWait = std::ranges::find(kForNow, loaded.error().code) != kForNow.end();
            return loaded.error();
        });
        auto value = store::decodeSession(record.whole, record.head, std::ref(objects), services_.polytopes);
        if (!record.damage.empty()) throw store::UnreadableRecord(record.damage);
        if (ownership == ClaimState::unclaimed) {
            claim(pending, std::make_shared<const DecodedRecord>(
                               DecodedRecord{stored, std::move(value), objects.keysBySerial()}));
            return;
        }
        writeBehind_.setStoredKeys(id, objects.keysBySerial());
        finishOpening(pending, std::move(value), record.fence);
    } catch (const std::exception& fault) {
        // Nothing in a damaged record is certain, not even that a later version has stored it.
        const bool isLater = record.damage.empty() && dynamic_cast<const store::NewerVersionRecord*>(&fault) != nullptr;
        if (isLater) {
            spdlog::warn("session of a later version refused session={} store={} reason=\"{}\"", id,
                         writeBehind_.name(), fault.what());
        } else if (isUnread) {
            spdlog::warn("session waits for its field session={} reason=\"{}\"", id, fault.what());
        } else {
            spdlog::error("session cannot be read session={} store={} fault=\"{}\"", id, writeBehind_.name(),
                          fault.what());
        }
        if (ownership == ClaimState::claimed) writeBehind_.discardFetched(id);
        const std::string what = isLater    ? "this server keeps the session, but cannot open it: "
                                 : isUnread ? "this session cannot be opened: "
                                            : "this session is stored in a form that the server cannot read: ";
        // After `not_found`, clients forget the session; after the other errors, they try again.
        const ErrorCode code = isLater                ? ErrorCode::later_version
                               : isUnread && mustWait ? ErrorCode::internal
                                                      : ErrorCode::not_found;
        finishOpening(pending, Error{code, what + fault.what()});
    }
}

/// Claims a session in the store, after its record was read and decoded.
void SessionManager::claim(const PendingJoin& pending, const std::shared_ptr<const DecodedRecord>& decoded) {
    writeBehind_.claimAndFetch(pending.credentials,
                               [self = shared_from_this(), pending, decoded](WriteBehindStore::FetchResult fetch) {
                                   self->onClaimed(pending, *decoded, std::move(fetch));
                               });
}

/// Handles a session that this server has claimed. Runs on the thread of the write-behind store. If another server has
/// saved the session since its record was read, the newer record is decoded.
void SessionManager::onClaimed(const PendingJoin& pending, const DecodedRecord& decoded,
                               WriteBehindStore::FetchResult fetch) {
    if (!fetch) {
        finishOpening(pending, fetch.error());
        return;
    }
    if (fetch->session) {
        finishOpening(pending, std::move(*fetch->session), fetch->record.fence);
        return;
    }
    store::SessionRecord& claimed = fetch->record;
    if (claimed.whole == decoded.record->whole && claimed.head == decoded.record->head) {
        writeBehind_.setStoredKeys(pending.credentials.id, decoded.keys);
        finishOpening(pending, decoded.value, claimed.fence);
        return;
    }
    startDecoding(pending, std::make_shared<const store::SessionRecord>(std::move(claimed)), ClaimState::claimed);
}

/// Passes the session, or the error, to the client that asked first. If another server has meanwhile taken over the
/// session and may have changed it, passes kTakenOver. Then calls join() again for the other waiting clients. `fence`
/// is the number with which the session was fetched (see store::FencingToken); 0 if `value` is an error.
void SessionManager::finishOpening(const PendingJoin& pending, Result<session::Session> value,
                                   store::FencingToken fence) {
    const std::string& id = pending.credentials.id;
    std::vector<PendingJoin> others;
    std::shared_ptr<LiveSession> session;
    {
        const std::lock_guard lock(mutex_);
        others = std::move(opening_[id]);
        opening_.erase(id);
        // Another server may have claimed the session while its record was decoded. If a server claims it from now on,
        // disconnectTakenOverSession() finds it in live_, because that function locks mutex_.
        if (value && !writeBehind_.ownsSession(id, fence)) value = kTakenOver;
        if (value) session = createLiveSession(pending.credentials, fence, pending.client, std::move(*value));
    }
    if (session) spdlog::info("session opened session={}", id);
    pending.done(session ? JoinResult(session) : value.error());
    for (const auto& [credentials, client, done] : others) join(credentials, client, done);
}

std::shared_ptr<LiveSession> SessionManager::createLiveSession(store::SessionCredentials credentials,
                                                               store::FencingToken fence,
                                                               const ClientAccountPtr& client, session::Session value) {
    const std::string id = credentials.id;
    auto session =
        std::make_shared<LiveSession>(services_, writeBehind_, std::move(credentials), fence, client, std::move(value));
    live_.emplace(id, SessionWithClients{session, 1});
    byClient_.recordOpened(id, client->name());
    return session;
}

void SessionManager::leave(const std::shared_ptr<LiveSession>& session, std::shared_ptr<Peer> peer) {
    session->leave(std::move(peer), [self = shared_from_this(), session](const session::Session& value) {
        const std::string& id = session->credentials().id;
        const std::lock_guard lock(self->mutex_);
        const auto found = self->live_.find(id);
        if (found == self->live_.end() || found->second.session != session || --found->second.clients > 0) return false;
        const bool unmodified = value.revision == 0 && value.loaded.empty();
        self->byClient_.recordClosed(id, unmodified, self->services_.clock.now());
        self->writeBehind_.closeSession(id, value);
        self->live_.erase(found);
        spdlog::info("session closed session={}", id);
        return true;
    });
}

/// Disconnects the clients of a session that another server has taken over.
void SessionManager::disconnectTakenOverSession(const std::string& id) {
    std::shared_ptr<LiveSession> session;
    {
        const std::lock_guard lock(mutex_);
        const auto found = live_.find(id);
        if (found == live_.end()) return;
        session = std::move(found->second.session);
        live_.erase(found);
        byClient_.remove(id);
    }
    services_.metrics.sessionsTaken.Increment();
    spdlog::info("session taken over by another server session={}", id);
    session->detachAndDisconnectAll();
}

std::shared_ptr<LiveSession> SessionManager::find(const std::string& id) const {
    const std::lock_guard lock(mutex_);
    const auto found = live_.find(id);
    return found == live_.end() ? nullptr : found->second.session;
}

void SessionManager::saveAll(const std::shared_ptr<void>& completion) {
    if (writeBehind_.writeTiming() == store::Store::WriteTiming::at_close) return;
    const std::lock_guard lock(mutex_);
    for (const auto& [id, live] : live_) live.session->save(completion);
}

void SessionManager::stop(Seconds limit) { writeBehind_.stop(std::chrono::duration_cast<store::Milliseconds>(limit)); }

std::size_t SessionManager::openSessionCount() const {
    const std::lock_guard lock(mutex_);
    return live_.size();
}

}  // namespace oval4d::net
