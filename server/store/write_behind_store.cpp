#include "store/write_behind_store.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "store/codec.hpp"
#include "store/object_codec.hpp"
#include "store/secret.hpp"

namespace oval4d::store {

using session::Session;
using namespace std::chrono_literals;

namespace {

constexpr std::size_t kIdBytes = 10, kTokenBytes = 20, kKeyBytes = 10;
constexpr std::size_t kBatch = 256;                         // maximum number of sessions in one write
constexpr std::size_t kBatchBytes = std::size_t{8} << 20U;  // once a write has this size, no session is added
constexpr auto kPollInterval = 500ms;
constexpr auto kMinRetryPause = 100ms, kMaxRetryPause = 5000ms;  // between attempts while the store is unavailable
constexpr auto kMaxRefreshInterval = 60s;

const Error kNotFound{ErrorCode::not_found, "there is no such session; it may have expired"};
const Error kBadToken{ErrorCode::bad_token, "this token does not open the session"};
const Error kNoAnswer{ErrorCode::internal, "this session cannot be opened right now; try again"};

/// Returns an estimate of a session's memory in bytes, including objects that it shares with other sessions.
std::size_t bytesOf(const Session& session) {
    std::map<const void*, const slicing::Object*> objects;
    std::size_t bytes = sizeof session;
    const auto addObject = [&](const slicing::Object& object) {
        objects.try_emplace(slicing::identityOf(object), &object);
    };
    const auto add = [&](const session::State& state) {
        for (const slicing::Object* object : state.objects()) addObject(*object);
        bytes += sizeof state +
                 (state.look.cellTypes.hidden.size() + state.look.cellTypes.faded.size()) * sizeof(std::uint32_t);
    };
    for (const slicing::Object* object : session.current.objects()) addObject(*object);
    for (const session::State& state : session.undoSteps) add(state);
    for (const session::State& state : session.redoSteps) add(state);
    for (const auto& [name, object] : session.loaded) addObject(object);
    for (const auto& [identity, object] : objects) bytes += slicing::memoryOf(*object);
    return bytes;
}

}  // namespace

WriteBehindStore::WriteBehindStore(std::unique_ptr<Store> store, Settings settings, Listener listener, Now<Clock> now)
    : store_(std::move(store)),
      writeTiming_(store_->writePolicy()),
      name_(store_->name()),
      settings_(settings),
      listener_(std::move(listener)),
      now_(std::move(now)),
      random_(std::random_device{}()),
      thread_([this] { run(); }) {}

WriteBehindStore::~WriteBehindStore() { stop(0ms); }

void WriteBehindStore::stop(Milliseconds limit) {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        stopAt_ = now_() + limit;
    }
    wake_.notify_one();
    if (thread_.joinable()) thread_.join();
    // The callbacks may own large objects: destroy them before this function returns, but without holding the lock.
    decltype(cached_) cached;
    decltype(tasks_) tasks;
    {
        const std::lock_guard lock(mutex_);
        cached.swap(cached_);
        tasks.swap(tasks_);
    }
}

SessionCredentials WriteBehindStore::create() {
    SessionCredentials credentials{randomName(kIdBytes), randomName(kTokenBytes)};
    const std::lock_guard lock(mutex_);
    cached_[credentials.id].credentials = credentials;
    ++created_;
    return credentials;
}

void WriteBehindStore::fetch(SessionCredentials credentials, std::function<void(FetchResult)> done) {
    {
        const std::lock_guard lock(mutex_);
        tasks_.emplace_back(
            [this, credentials = std::move(credentials), done = std::move(done)] { fetchNow(credentials, done); });
    }
    wake_.notify_one();
}

void WriteBehindStore::setStoredKeys(const std::string& id, KeysBySerial keys) {
    const std::lock_guard lock(mutex_);
    tasks_.emplace_back([this, id, keys = std::move(keys)] {
        ObjectKeys& stored = keys_[id];
        stored.clear();
        for (const auto& [serial, key] : keys) stored[serial] = {key, true};
    });
}

void WriteBehindStore::save(const std::string& id, Session value, SaveScope scope, Written written) {
    bool ours = false;
    {
        const std::lock_guard lock(mutex_);
        if (const auto found = cached_.find(id); found != cached_.end()) {
            ours = true;
            CachedSession& cached = found->second;
            (scope == SaveScope::head ? cached.head : cached.whole) = std::make_shared<const Session>(std::move(value));
            enqueue(id, cached);
            if (lastError_.empty() && written) cached.waiting.push_back(std::exchange(written, nullptr));
        }
    }
    wake_.notify_one();
    if (written) written(ours);
}

void WriteBehindStore::close(const std::string& id, Session value) {
    const std::size_t bytes = bytesOf(value);
    std::vector<CachedSession> evicted;
    {
        const std::lock_guard lock(mutex_);
        const auto found = cached_.find(id);
        if (found == cached_.end()) return;
        CachedSession& cached = found->second;
        cached.whole = std::make_shared<const Session>(std::move(value));
        cached.closed = true;
        cached.closedAt = now_();
        cached.bytes = bytes;
        enqueue(id, cached);
        if (!lastError_.empty()) evicted = evictClosed();
    }
    if (!evicted.empty())
        spdlog::warn("sessions evicted from memory while the store is unavailable count={}", evicted.size());
    for (const CachedSession& cached : evicted) {
        for (const Written& written : cached.waiting) written(false);
    }
    wake_.notify_one();
}

/// Removes closed sessions from memory until the remaining ones fit within the quota, and returns the removed ones.
/// Removes sessions that were never changed first, then those that were closed first. Skips sessions that are being
/// written.
std::vector<WriteBehindStore::CachedSession> WriteBehindStore::evictClosed() {
    std::size_t bytes = 0;
    std::vector<decltype(cached_)::iterator> closed;
    for (auto entry = cached_.begin(); entry != cached_.end(); ++entry) {
        const CachedSession& cached = entry->second;
        if (!cached.closed || cached.inFlight) continue;
        bytes += cached.bytes;
        closed.push_back(entry);
    }
    std::vector<CachedSession> evicted;
    if (bytes <= settings_.quota) return evicted;
    std::ranges::sort(closed, {}, [](const auto& entry) {
        return std::tuple(entry->second.whole->revision > 0, entry->second.closedAt);
    });
    for (const auto& entry : closed) {
        if (bytes <= settings_.quota) break;
        bytes -= entry->second.bytes;
        tasks_.emplace_back([this, id = entry->first] { dropKeys(id); });
        evicted.push_back(std::move(entry->second));
        cached_.erase(entry);
    }
    recount();
    return evicted;
}

void WriteBehindStore::remove(const std::string& id) {
    {
        const std::lock_guard lock(mutex_);
        tasks_.emplace_back([this, id] {
            CachedSession cached;  // destroyed without holding the lock
            {
                const std::lock_guard inner(mutex_);
                const auto found = cached_.find(id);
                if (found != cached_.end() && !found->second.closed) return;
                if (found != cached_.end()) {
                    cached = std::move(found->second);
                    cached_.erase(found);
                }
                keys_.erase(id);
                removals_.insert(id);
            }
            for (const Written& written : cached.waiting) written(false);
        });
    }
    wake_.notify_one();
}

/// Drops the object keys of a session unless `cached_` contains it again.
void WriteBehindStore::dropKeys(const std::string& id) {
    const std::lock_guard lock(mutex_);
    if (!cached_.contains(id)) keys_.erase(id);
}

void WriteBehindStore::discardFetched(const std::string& id) {
    const std::lock_guard lock(mutex_);
    cached_.erase(id);
}

std::size_t WriteBehindStore::count() const {
    const std::lock_guard lock(mutex_);
    // If servers share the store (at_once), the number of stored sessions says nothing about the load of this server.
    return writeTiming_ == Store::WritePolicy::at_once ? cached_.size() : kept_ + created_;
}

std::size_t WriteBehindStore::unsaved() const {
    const std::lock_guard lock(mutex_);
    return static_cast<std::size_t>(std::ranges::count_if(cached_, [](const auto& entry) {
        const CachedSession& cached = entry.second;
        return cached.head || cached.whole || cached.inFlight;
    }));
}

std::string WriteBehindStore::lastError() const {
    const std::lock_guard lock(mutex_);
    return lastError_;
}

void WriteBehindStore::enqueue(const std::string& id, CachedSession& cached) {
    if (std::exchange(cached.queued, true)) return;
    queue_.push_back(id);
}

bool WriteBehindStore::isReadyToWrite() const { return (!queue_.empty() || !removals_.empty()) && now_() >= retryAt_; }

void WriteBehindStore::recount() {
    created_ =
        static_cast<std::size_t>(std::ranges::count_if(cached_, [](const auto& entry) { return !entry.second.saved; }));
}

WriteBehindStore::Clock::time_point WriteBehindStore::nextWake() const {
    const auto next = queue_.empty() && removals_.empty() ? pollAt_ : std::min(pollAt_, retryAt_);
    return stopping_ ? std::min(next, stopAt_) : next;
}

void WriteBehindStore::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        if (!tasks_.empty()) {
            const auto task = std::move(tasks_.front());
            tasks_.pop_front();
            lock.unlock();
            task();
        } else if (stopping_ && (queue_.empty() || now_() >= stopAt_)) {
            if (!queue_.empty()) spdlog::error("sessions not written count={} store={}", queue_.size(), name_);
            return;
        } else if (isReadyToWrite()) {
            lock.unlock();
            write();
        } else if (now_() >= pollAt_) {
            lock.unlock();
            poll();
        } else {
            wake_.wait_for(lock, nextWake() - now_());
            continue;
        }
        lock.lock();
    }
}

/// Calls `operation`, an operation of the store, and reports its duration and outcome to the listener. `name`: the name
/// of the operation in the metrics.
template <typename Operation>
auto WriteBehindStore::timed(const char* name, Operation operation) {
    const auto start = Clock::now();
    const auto report = [&](bool done) {
        listener_.operationEnded(name, std::chrono::duration<double>(Clock::now() - start).count(), done);
    };
    try {
        auto result = operation();
        report(true);
        return result;
    } catch (...) {
        report(false);
        throw;
    }
}

void WriteBehindStore::storeFailed(const std::exception& fault) {
    const std::string why = fault.what();
    const bool readable = dynamic_cast<const NotWritable*>(&fault) != nullptr;
    if (!readable) {
        // The store may have lost its data: all objects must be written again.
        for (auto& [id, keys] : keys_) {
            for (auto& [serial, object] : keys) object.stored = false;
        }
    }
    // Exponential backoff with jitter.
    const Milliseconds longest =
        std::min<Milliseconds>(kMinRetryPause * (1 << std::min(failures_++, 10)), kMaxRetryPause);
    const Milliseconds pause = longest / 2 + Milliseconds(random_() % static_cast<unsigned>(longest.count() / 2));
    const std::lock_guard lock(mutex_);
    retryAt_ = pollAt_ = now_() + pause;
    readAt_ = readable ? Clock::time_point() : retryAt_;
    recount();
    if (lastError_.empty())
        spdlog::error("store unavailable, changes stay in memory until it is available again fault=\"{}\"", why);
    lastError_ = why;
}

void WriteBehindStore::storeWorked() {
    {
        const std::lock_guard lock(mutex_);
        failures_ = 0;
        if (lastError_.empty()) return;
        lastError_.clear();
    }
    spdlog::info("store available again store={}", name_);
    listener_.recovered();
}

// --- Writing

/// Takes a batch of sessions from the queue, and encodes them as updates.
void WriteBehindStore::takeJobs(std::vector<Job>& jobs, std::vector<RecordUpdate>& updates) {
    const std::size_t maxBytes = std::min(kBatchBytes, settings_.quota / 8);
    std::size_t bytes = 0;
    while (jobs.size() < kBatch && bytes < maxBytes) {
        {
            const std::lock_guard lock(mutex_);
            if (queue_.empty()) break;
            const std::string id = std::move(queue_.front());
            queue_.pop_front();
            const auto found = cached_.find(id);
            if (found == cached_.end()) continue;
            CachedSession& cached = found->second;
            cached.queued = false;
            cached.inFlight = true;
            jobs.push_back({id,
                            std::exchange(cached.head, nullptr),
                            std::exchange(cached.whole, nullptr),
                            std::exchange(cached.waiting, {}),
                            {}});
            updates.push_back({cached.credentials, cached.fence, {}, {}, {}, {}, cached.closed, true});
        }
        encode(jobs.back(), updates.back());
        bytes += store::estimateStoredSize(updates.back());
    }
}

void WriteBehindStore::write() {
    writeRemovals();
    std::vector<RecordUpdate> updates;
    std::vector<Job> jobs;
    std::vector<std::optional<SaveResult>> results;
    try {
        takeJobs(jobs, updates);
        if (jobs.empty()) return;
        results = timed("save", [&] { return saveOrEvict(updates); });
    } catch (const std::exception& fault) {
        storeFailed(fault);
        for (Job& job : jobs) requeue(job);
        return;
    }
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        if (results[i]) {
            applyResult(jobs[i], updates[i], *results[i]);
        } else {
            requeue(jobs[i]);
        }
    }
    if (std::ranges::all_of(results, [](const auto& one) { return one.has_value(); })) storeWorked();
}

/// Saves the updates. If the store is full, evicts closed sessions from it. If an update does not fit even then, its
/// result is empty and storeFailed() is called; the other updates are saved.
std::vector<std::optional<SaveResult>> WriteBehindStore::saveOrEvict(std::span<const RecordUpdate> updates) {
    std::vector<std::optional<SaveResult>> results;
    try {
        for (const SaveResult one : store_->save(updates)) results.emplace_back(one);
        return results;
    } catch (const NotWritable&) {
        const std::size_t count = store_->evict(updates, [this](const std::string& id) {
            const std::lock_guard lock(mutex_);
            return cached_.contains(id);
        });
        if (count > 0) spdlog::warn("sessions evicted, the store is full count={} store={}", count, name_);
    }
    for (const RecordUpdate& update : updates) {
        try {
            results.emplace_back(store_->save({&update, 1}).at(0));
        } catch (const NotWritable& fault) {
            if (std::ranges::all_of(results, [](const auto& one) { return one.has_value(); })) storeFailed(fault);
            results.emplace_back();
        }
    }
    return results;
}

void WriteBehindStore::writeRemovals() {
    std::vector<std::string> ids;
    {
        const std::lock_guard lock(mutex_);
        std::erase_if(removals_, [&](const std::string& id) { return cached_.contains(id); });  // reopened meanwhile
        ids.assign(removals_.begin(), removals_.end());
    }
    if (ids.empty()) return;
    try {
        timed("remove", [&] { return store_->remove(ids), true; });
    } catch (const std::exception& fault) {
        storeFailed(fault);
        return;
    }
    const std::lock_guard lock(mutex_);
    removals_.clear();
    pollAt_ = Clock::time_point();  // poll now, to update the number of stored sessions
}

/// Encodes a job as an update. An object is written only once. It is dropped from the store when the session no longer
/// contains it.
void WriteBehindStore::encode(Job& job, RecordUpdate& update) {
    ObjectKeys& keys = keys_[job.id];
    std::set<std::uint64_t> used;
    const ObjectKeyLookup keyOf = [&](const slicing::Object& object) {
        const std::uint64_t serial = slicing::infoOf(object).serial;
        auto& [key, stored] = keys[serial];
        if (key.empty()) key = randomName(kKeyBytes);
        if (used.insert(serial).second && !stored) {
            update.objects.emplace_back(key, encodeObjectRecord(object));
            job.added.push_back(serial);
        }
        return key;
    };
    if (job.whole) update.whole = encodeWhole(*job.whole, settings_.maxUndo, keyOf);
    if (job.head && (!job.whole || job.head->revision > job.whole->revision))
        update.head = encodeHead(*job.head, keyOf);
    update.changed = (job.head && job.head->revision > 0) || (job.whole && job.whole->revision > 0);
    if (!job.whole) return;
    for (const auto& [serial, object] : keys) {
        if (!used.contains(serial)) update.dropped.push_back(object.key);
    }
}

void WriteBehindStore::applyResult(Job& job, const RecordUpdate& update, SaveResult result) {
    if (result == SaveResult::saved) {
        ObjectKeys& keys = keys_[job.id];
        for (const std::uint64_t serial : job.added) keys[serial].stored = true;
        std::erase_if(keys, [&](const auto& entry) {
            return std::ranges::find(update.dropped, entry.second.key) != update.dropped.end();
        });
        const std::lock_guard lock(mutex_);
        const auto found = cached_.find(job.id);
        if (found != cached_.end()) {
            CachedSession& cached = found->second;
            cached.inFlight = false;
            if (!std::exchange(cached.saved, true)) pollAt_ = Clock::time_point();  // poll now, to update count()
            if (cached.closed && !cached.queued) {
                cached_.erase(found);
                keys_.erase(job.id);
            }
        }
    } else if (result == SaveResult::missing) {
        for (auto& [serial, object] : keys_[job.id]) object.stored = false;
        requeue(job);
        listener_.missing(job.id);
        return;
    } else {
        dropTaken(job.id);
    }
    for (const Written& written : job.waiting) written(result == SaveResult::saved);
}

/// Makes the changes of a failed job pending again, unless newer ones are pending already. While the store is
/// unavailable, also queues them and calls their callbacks, so that no caller waits for the store.
void WriteBehindStore::requeue(Job& job) {
    std::vector<Written> released;
    {
        const std::lock_guard lock(mutex_);
        const auto found = cached_.find(job.id);
        if (found == cached_.end()) return;
        CachedSession& cached = found->second;
        cached.inFlight = false;
        if (!cached.head) cached.head = std::move(job.head);
        if (!cached.whole) cached.whole = std::move(job.whole);
        std::ranges::move(job.waiting, std::back_inserter(cached.waiting));
        if (!lastError_.empty()) {
            enqueue(job.id, cached);
            released = std::exchange(cached.waiting, {});
        }
    }
    for (const Written& written : released) written(true);
}

/// Drops a session that another server has claimed.
void WriteBehindStore::dropTaken(const std::string& id) {
    std::vector<Written> released;
    bool open = false;
    {
        const std::lock_guard lock(mutex_);
        const auto found = cached_.find(id);
        if (found == cached_.end()) return;
        released = std::move(found->second.waiting);
        open = !found->second.closed;
        cached_.erase(found);
    }
    keys_.erase(id);
    for (const Written& written : released) written(false);
    if (open) listener_.claimed(id);
}

// --- Polling

void WriteBehindStore::poll() {
    {
        const std::lock_guard lock(mutex_);
        pollAt_ = now_() + kPollInterval;
    }
    try {
        if (now_() >= refreshAt_) refreshExpiry();
        for (const std::string& id : timed("pulse", [&] { return store_->pollClaims(); })) dropTaken(id);
    } catch (const std::exception& fault) {
        storeFailed(fault);
        return;
    }
    bool waiting = false;
    {
        const std::lock_guard lock(mutex_);
        kept_ = store_->size();
        recount();
        waiting = !queue_.empty() || !removals_.empty();
    }
    if (!waiting) storeWorked();  // otherwise the next write shows whether the store works: a full store can be polled
}

/// Restarts the expiry period of open sessions, and deletes sessions whose expiry period has ended.
void WriteBehindStore::refreshExpiry() {
    const Milliseconds interval = std::min<Milliseconds>(settings_.expiry / 4, kMaxRefreshInterval);
    refreshAt_ = now_() + interval;
    std::vector<std::string> open;
    {
        const std::lock_guard lock(mutex_);
        pollAt_ = std::min(pollAt_, refreshAt_);
        std::erase_if(cached_, [&](const auto& entry) {
            const bool old = entry.second.closed && now_() - entry.second.closedAt > settings_.expiry;
            if (old) keys_.erase(entry.first);
            return old;
        });
        for (const auto& [id, session] : cached_) {
            if (session.saved && !session.closed) open.push_back(id);
        }
    }
    for (std::size_t i = 0; i < open.size(); i += kBatch) {
        const auto some = std::span(open).subspan(i, std::min(kBatch, open.size() - i));
        timed("touch", [&] { return store_->touch(some), true; });
    }
    const std::size_t expired = timed("expire", [&] { return store_->expire(settings_.expiry); });
    if (expired > 0) spdlog::info("sessions expired count={}", expired);
}

// --- Reading

void WriteBehindStore::fetchNow(const SessionCredentials& credentials, const std::function<void(FetchResult)>& done) {
    try {
        done(claimOrFind(credentials));
    } catch (const std::exception& fault) {
        storeFailed(fault);
        done(kNoAnswer);
    }
}

WriteBehindStore::FetchResult WriteBehindStore::claimOrFind(const SessionCredentials& credentials) {
    {
        const std::lock_guard lock(mutex_);
        if (const auto found = cached_.find(credentials.id); found != cached_.end()) {
            CachedSession& cached = found->second;
            if (!equalInConstantTime(credentials.token, cached.credentials.token)) return kBadToken;
            if (!cached.whole) return kNoAnswer;  // another client is opening it, or it is being written
            cached.closed = false;
            return Fetched{*cached.whole, {}};
        }
        if (removals_.contains(credentials.id)) return kNotFound;
        if (now_() < readAt_) return kNoAnswer;
    }
    const auto hash = timed("token", [&] { return store_->tokenHash(credentials.id); });
    if (!hash) return kNotFound;
    if (!equalInConstantTime(hashToken(credentials.token), *hash)) {
        // The token may be correct, if the stored hash is damaged.
        return timed("token", [&] { return store_->isDamaged(credentials.id); }) ? kNotFound : kBadToken;
    }
    auto record = timed("claim", [&] { return store_->claim(credentials.id); });
    if (!record) return kNotFound;
    const std::lock_guard lock(mutex_);
    CachedSession& cached = cached_[credentials.id];
    cached.credentials = credentials;
    cached.fence = record->fence;
    cached.saved = true;
    return Fetched{{}, std::move(*record)};
}

}  // namespace oval4d::store
