// This file is long, because the functions of the store thread and their callers share one lock.

#include "store/write_behind_store.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "store/secret.hpp"

namespace oval4d::store {

using session::Session;
using namespace std::chrono_literals;

namespace {

constexpr std::size_t kIdBytes = 10, kTokenBytes = 20;
constexpr std::size_t kBatch = 256;  // the maximum number of sessions in one write or one call of restartExpiry()
// A write gets no further session once its records have this many bytes, or an eighth of the quota if that is less.
constexpr std::size_t kBatchBytes = std::size_t{8} << 20U;
constexpr auto kPollInterval = 500ms;
constexpr auto kMaxRefreshInterval = 60s;

const Error kNotFound{ErrorCode::not_found, "there is no such session; it may have expired"};
const Error kBadToken{ErrorCode::bad_token, "this token does not open the session"};
const Error kNoAnswer{ErrorCode::internal, "this session cannot be opened right now; try again"};

}  // namespace

WriteBehindStore::WriteBehindStore(std::unique_ptr<Store> store, WriteBehindSettings settings, Listener listener,
                                   ClockFunction<Clock> now)
    : store_(std::move(store)),
      writePolicy_(store_->writeTiming()),
      name_(store_->name()),
      settings_(settings),
      listener_(std::move(listener)),
      now_(std::move(now)),
      storeThread_([this] { runThread(); }) {}

WriteBehindStore::~WriteBehindStore() { stop(0ms); }

void WriteBehindStore::stop(Milliseconds limit) {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        stopAt_ = now_() + limit;
    }
    wake_.notify_one();
    if (storeThread_.joinable()) storeThread_.join();
    // The callbacks may own large objects. Destroy them before this function returns, but without holding the lock.
    CachedSessions cached;
    decltype(tasks_) tasks, requests;
    {
        const std::lock_guard lock(mutex_);
        std::swap(cached, cached_);
        tasks.swap(tasks_);
        requests.swap(requests_);
    }
}

SessionCredentials WriteBehindStore::createSession() {
    SessionCredentials credentials{randomName(kIdBytes), randomName(kTokenBytes)};
    const std::lock_guard lock(mutex_);
    cached_.addNew(credentials);
    ++neverSaved_;
    return credentials;
}

void WriteBehindStore::read(SessionCredentials credentials, std::function<void(FetchResult)> done) {
    queueFetch(std::move(credentials), FetchMode::read, std::move(done));
}

void WriteBehindStore::claimAndFetch(SessionCredentials credentials, std::function<void(FetchResult)> done) {
    queueFetch(std::move(credentials), FetchMode::claim, std::move(done));
}

void WriteBehindStore::queueFetch(SessionCredentials credentials, FetchMode access,
                                  std::function<void(FetchResult)> done) {
    {
        const std::lock_guard lock(mutex_);
        requests_.emplace_back([this, credentials = std::move(credentials), access, done = std::move(done)] {
            runFetch(credentials, access, done);
        });
    }
    wake_.notify_one();
}

bool WriteBehindStore::ownsSession(const std::string& id, FencingToken fence) const {
    const std::lock_guard lock(mutex_);
    const CachedSession* const cached = cached_.find(id);
    return cached != nullptr && cached->fence == fence;
}

void WriteBehindStore::setStoredKeys(const std::string& id, KeysBySerial keys) {
    const std::lock_guard lock(mutex_);
    tasks_.emplace_back([this, id, keys = std::move(keys)] {
        const std::lock_guard inner(mutex_);
        // If the session is no longer in memory, another server has claimed it since it was fetched.
        if (cached_.contains(id)) objects_.setStored(id, keys);
    });
}

void WriteBehindStore::recordUnsavedChange(const std::string& id, FencingToken fence) {
    const std::lock_guard lock(mutex_);
    if (CachedSession* const cached = cached_.find(id); cached != nullptr && cached->fence == fence)
        cached->changed = true;
}

void WriteBehindStore::save(const std::string& id, FencingToken fence, Session value, SaveScope scope,
                            SaveCallback written) {
    bool ours = false;
    {
        const std::lock_guard lock(mutex_);
        if (CachedSession* const cached = cached_.find(id); cached != nullptr && cached->fence == fence) {
            ours = true;
            cached->changed = false;
            auto& [head, whole, waiting] = cached->pending;
            (scope == SaveScope::head ? head : whole) = std::make_shared<const Session>(std::move(value));
            cached_.enqueue(id, *cached);
            if (lastError_.empty() && written) waiting.push_back(std::exchange(written, nullptr));
        }
    }
    wake_.notify_one();
    if (written) written(ours);
}

void WriteBehindStore::closeSession(const std::string& id, Session value) {
    const std::size_t bytes = estimateMemory(value);
    std::vector<std::pair<std::string, CachedSession>> evicted;
    {
        const std::lock_guard lock(mutex_);
        CachedSession* const cached = cached_.find(id);
        if (cached == nullptr) return;
        cached->pending.whole = std::make_shared<const Session>(std::move(value));
        cached->changed = false;
        cached->closed = true;
        cached->closedAt = now_();
        cached->bytes = bytes;
        cached_.enqueue(id, *cached);
        if (!lastError_.empty()) evicted = cached_.evictClosed(settings_.quota);
        for (const auto& [other, session] : evicted)
            tasks_.emplace_back([this, other = other] { forgetObjectKeys(other); });
        if (!evicted.empty()) neverSaved_ = cached_.neverSavedCount();
    }
    if (!evicted.empty())
        spdlog::warn("sessions evicted from memory while the store is unavailable count={}", evicted.size());
    for (const auto& [other, session] : evicted) {
        for (const SaveCallback& written : session.pending.waiting) written(false);
    }
    wake_.notify_one();
}

void WriteBehindStore::remove(const std::string& id) {
    {
        const std::lock_guard lock(mutex_);
        requests_.emplace_back([this, id] {
            std::optional<CachedSession> removed;  // destroyed after the lock is released
            {
                const std::lock_guard inner(mutex_);
                const CachedSession* const cached = cached_.find(id);
                if (cached != nullptr && !cached->closed) return;
                removed = cached_.remove(id);
                objects_.forget(id);
                removals_.insert(id);
            }
            if (!removed) return;
            for (const SaveCallback& written : removed->pending.waiting) written(false);
        });
    }
    wake_.notify_one();
}

/// Makes objects_ forget a session that was evicted from memory, unless a client has opened the session again.
void WriteBehindStore::forgetObjectKeys(const std::string& id) {
    const std::lock_guard lock(mutex_);
    if (!cached_.contains(id)) objects_.forget(id);
}

void WriteBehindStore::discardFetched(const std::string& id) {
    const std::lock_guard lock(mutex_);
    cached_.remove(id);
}

std::size_t WriteBehindStore::sessionCount() const {
    const std::lock_guard lock(mutex_);
    // If servers share the store (WriteTiming::at_once), the number of stored sessions does not tell the load of this
    // server.
    return writePolicy_ == Store::WriteTiming::at_once ? cached_.size() : storedCount_ + neverSaved_;
}

std::size_t WriteBehindStore::unsaved() const {
    const std::lock_guard lock(mutex_);
    return cached_.unsaved();
}

std::string WriteBehindStore::lastError() const {
    const std::lock_guard lock(mutex_);
    return lastError_;
}

bool WriteBehindStore::isWriteDue() const { return hasPendingChanges() && now_() >= retryAt_; }

WriteBehindStore::Clock::time_point WriteBehindStore::nextWakeTime() const {
    const auto next = hasPendingChanges() ? std::min(pollAt_, retryAt_) : pollAt_;
    return stopping_ ? std::min(next, stopAt_) : next;
}

void WriteBehindStore::runThread() {
    // Whether a request was executed since the last write or poll. If so, a due write or poll comes before the next
    // request. Without this rule, clients that request many sessions could delay writes forever.
    bool isOthersTurn = false;
    std::unique_lock lock(mutex_);
    for (;;) {
        const bool mustYield = isOthersTurn && (isWriteDue() || now_() >= pollAt_);
        if (auto* const due = !tasks_.empty() ? &tasks_ : !requests_.empty() && !mustYield ? &requests_ : nullptr) {
            isOthersTurn = isOthersTurn || due == &requests_;
            const auto task = std::move(due->front());
            due->pop_front();
            lock.unlock();
            task();
        } else if (stopping_ && (cached_.queueLength() == 0 || now_() >= stopAt_)) {
            if (const std::size_t left = cached_.queueLength(); left > 0)
                spdlog::error("sessions not written count={} store={}", left, name_);
            return;
        } else if (isWriteDue()) {
            isOthersTurn = false;
            lock.unlock();
            writeQueued();
        } else if (now_() >= pollAt_) {
            isOthersTurn = false;
            lock.unlock();
            poll();
        } else {
            wake_.wait_for(lock, nextWakeTime() - now_());
            continue;
        }
        lock.lock();
    }
}

/// Calls `operation`, an operation of the store, and returns its result. Reports the duration of the operation, and
/// whether it succeeded, to the listener under the name `name`.
template <typename Operation>
auto WriteBehindStore::runAndReportTime(const char* name, Operation operation) {
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

void WriteBehindStore::onStoreFailed(const std::exception& fault) {
    const std::string why = fault.what();
    const bool readable = dynamic_cast<const StoreNotWritable*>(&fault) != nullptr;
    if (!readable) objects_.markAllObjectsLost();  // the store may have lost its data
    const Milliseconds pause = backoff_.nextPause();
    const std::lock_guard lock(mutex_);
    retryAt_ = pollAt_ = now_() + pause;
    readAt_ = readable ? Clock::time_point() : retryAt_;
    neverSaved_ = cached_.neverSavedCount();
    if (lastError_.empty())
        spdlog::error("store unavailable, changes stay in memory until it is available again fault=\"{}\"", why);
    lastError_ = why;
}

void WriteBehindStore::onStoreSucceeded() {
    backoff_.reset();
    {
        const std::lock_guard lock(mutex_);
        if (lastError_.empty()) return;
        lastError_.clear();
    }
    spdlog::info("store available again store={}", name_);
    listener_.recovered();
}

// --- Writing

/// Takes a batch of sessions from the queue, and appends them to `jobs`. Encodes their changes, and appends these to
/// `updates`.
void WriteBehindStore::takeBatch(std::vector<WriteJob>& jobs, std::vector<RecordUpdate>& updates) {
    const std::size_t maxBytes = std::min(kBatchBytes, settings_.quota / 8);
    std::size_t bytes = 0;
    while (jobs.size() < kBatch && bytes < maxBytes) {
        {
            const std::lock_guard lock(mutex_);
            const auto id = cached_.takeFirstQueued();
            if (!id) break;
            CachedSession& cached = *cached_.find(*id);
            jobs.push_back({*id, std::exchange(cached.pending, {}), {}});
            updates.push_back({cached.credentials, cached.fence, {}, {}, {}, {}, cached.closed, true});
        }
        WriteJob& job = jobs.back();
        job.added = objects_.encodeChanges(job.id, job.changes, settings_.maxUndo, updates.back());
        bytes += store::estimateStoredSize(updates.back());
    }
}

void WriteBehindStore::writeQueued() {
    writeRemovals();
    std::vector<RecordUpdate> updates;
    std::vector<WriteJob> jobs;
    std::vector<std::optional<SaveResult>> results;
    try {
        takeBatch(jobs, updates);
        if (jobs.empty()) return;
        results = runAndReportTime("save", [&] { return saveMakingRoom(updates); });
    } catch (const std::exception& fault) {
        onStoreFailed(fault);
        for (WriteJob& job : jobs) requeue(job);
        return;
    }
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        if (results[i]) {
            applySaveResult(jobs[i], updates[i], *results[i]);
        } else {
            requeue(jobs[i]);
        }
    }
    if (std::ranges::all_of(results, [](const auto& one) { return one.has_value(); })) onStoreSucceeded();
}

/// Saves the updates. If the store is full, evicts closed sessions from the store to make room. Returns a result for
/// each update: empty for updates that still do not fit. Calls onStoreFailed() if there are such updates. All others
/// are saved.
std::vector<std::optional<SaveResult>> WriteBehindStore::saveMakingRoom(std::span<const RecordUpdate> updates) {
    std::vector<std::optional<SaveResult>> results;
    try {
        for (const SaveResult one : store_->save(updates)) results.emplace_back(one);
        return results;
    } catch (const StoreNotWritable&) {
        evictToFit(updates);
    }
    for (const RecordUpdate& update : updates) {
        try {
            results.emplace_back(saveOneMakingRoom(update));
        } catch (const StoreNotWritable& fault) {
            if (std::ranges::all_of(results, [](const auto& one) { return one.has_value(); })) onStoreFailed(fault);
            results.emplace_back();
        }
    }
    return results;
}

/// Saves one update. If the store is full, evicts closed sessions from the store to make room. Throws StoreNotWritable
/// if the update still does not fit.
SaveResult WriteBehindStore::saveOneMakingRoom(const RecordUpdate& update) {
    const std::span<const RecordUpdate> one(&update, 1);
    try {
        return store_->save(one).at(0);
    } catch (const StoreNotWritable&) {
        if (evictToFit(one) == 0) throw;
    }
    return store_->save(one).at(0);
}

/// Evicts closed sessions from the store until the updates fit. Returns the number of evicted sessions.
std::size_t WriteBehindStore::evictToFit(std::span<const RecordUpdate> updates) {
    const std::size_t count = store_->evict(updates, [this](const std::string& id) {
        const std::lock_guard lock(mutex_);
        return cached_.contains(id);
    });
    if (count > 0) spdlog::warn("sessions evicted, the store is full count={} store={}", count, name_);
    return count;
}

void WriteBehindStore::writeRemovals() {
    std::vector<std::string> ids;
    {
        const std::lock_guard lock(mutex_);
        // Keep sessions that a client has opened again in the meantime.
        std::erase_if(removals_, [&](const std::string& id) { return cached_.contains(id); });
        ids.assign(removals_.begin(), removals_.end());
    }
    if (ids.empty()) return;
    try {
        runAndReportTime("remove", [&] { return store_->remove(ids), true; });
    } catch (const std::exception& fault) {
        onStoreFailed(fault);
        return;
    }
    const std::lock_guard lock(mutex_);
    removals_.clear();
    pollAt_ = Clock::time_point();  // poll soon, to update the number of stored sessions
}

void WriteBehindStore::applySaveResult(WriteJob& job, const RecordUpdate& update, SaveResult result) {
    if (result == SaveResult::saved) {
        objects_.recordSaved(job.id, job.added, update);
        const std::lock_guard lock(mutex_);
        if (CachedSession* const cached = cached_.find(job.id)) {
            cached->inFlight = false;
            if (!std::exchange(cached->everSaved, true))
                pollAt_ = Clock::time_point();  // poll soon, to update sessionCount()
            if (cached->closed && !cached->queued) {
                cached_.remove(job.id);
                objects_.forget(job.id);
            }
        }
    } else if (result == SaveResult::missing) {
        objects_.markObjectsLost(job.id);
        requeue(job);
        listener_.missing(job.id);
        return;
    } else {
        dropIfTakenOver(job.id, update.fence + 1);
    }
    for (const SaveCallback& written : job.changes.waiting) written(result == SaveResult::saved);
}

/// Makes the changes of a failed write pending again, except where newer changes are pending. If the store is
/// unavailable, also queues the session and calls the waiting callbacks, so that no caller waits for the store.
void WriteBehindStore::requeue(WriteJob& job) {
    std::vector<SaveCallback> released;
    {
        const std::lock_guard lock(mutex_);
        CachedSession* const cached = cached_.find(job.id);
        if (cached == nullptr) return;
        cached->inFlight = false;
        cached->pending.addOlder(std::move(job.changes));
        if (!lastError_.empty()) {
            cached_.enqueue(job.id, *cached);
            released = std::exchange(cached->pending.waiting, {});
        }
    }
    for (const SaveCallback& written : released) written(true);
}

/// Removes a session from memory because another server has claimed it. `fence` is the fence in the session's record.
/// Keeps the session if its own fence is not lower, because this server has then claimed it back.
void WriteBehindStore::dropIfTakenOver(const std::string& id, FencingToken fence) {
    std::optional<CachedSession> dropped;
    {
        const std::lock_guard lock(mutex_);
        const CachedSession* const cached = cached_.find(id);
        if (cached != nullptr && cached->fence < fence) dropped = cached_.remove(id);
    }
    if (!dropped) return;
    objects_.forget(id);
    for (const SaveCallback& written : dropped->pending.waiting) written(false);
    if (!dropped->closed) listener_.claimed(id);
}

// --- Polling

void WriteBehindStore::poll() {
    {
        const std::lock_guard lock(mutex_);
        pollAt_ = now_() + kPollInterval;
    }
    std::size_t stored = 0;
    try {
        if (now_() >= refreshAt_) renewAndExpireSessions();
        for (const auto& [id, fence] : runAndReportTime("pulse", [&] { return store_->pollTakenOverSessions(); }))
            dropIfTakenOver(id, fence);
        stored = store_->size();  // called without holding mutex_, because a store may wait for its own lock
    } catch (const std::exception& fault) {
        onStoreFailed(fault);
        return;
    }
    bool waiting = false;
    {
        const std::lock_guard lock(mutex_);
        storedCount_ = stored;
        neverSaved_ = cached_.neverSavedCount();
        waiting = hasPendingChanges();
    }
    // While changes wait, only a write shows whether the store works: even a full store can be polled.
    if (!waiting) onStoreSucceeded();
}

/// Restarts the expiry period of open sessions, and deletes sessions whose expiry period has ended.
void WriteBehindStore::renewAndExpireSessions() {
    const Milliseconds interval = std::min<Milliseconds>(settings_.expiry / 4, kMaxRefreshInterval);
    refreshAt_ = now_() + interval;
    std::vector<std::string> open;
    {
        const std::lock_guard lock(mutex_);
        pollAt_ = std::min(pollAt_, refreshAt_);
        for (const std::string& id : cached_.removeClosedBefore(now_() - settings_.expiry)) objects_.forget(id);
        open = cached_.idsOfOpenSavedSessions();
    }
    for (std::size_t i = 0; i < open.size(); i += kBatch) {
        const auto some = std::span(open).subspan(i, std::min(kBatch, open.size() - i));
        runAndReportTime("touch", [&] { return store_->restartExpiry(some), true; });
    }
    const std::size_t expired = runAndReportTime("expire", [&] { return store_->expire(settings_.expiry); });
    if (expired > 0) spdlog::info("sessions expired count={}", expired);
}

// --- Reading

void WriteBehindStore::runFetch(const SessionCredentials& credentials, FetchMode access,
                                const std::function<void(FetchResult)>& done) {
    try {
        done(fetch(credentials, access));
    } catch (const std::exception& fault) {
        onStoreFailed(fault);
        done(kNoAnswer);
    }
}

WriteBehindStore::FetchResult WriteBehindStore::fetch(const SessionCredentials& credentials, FetchMode access) {
    {
        const std::lock_guard lock(mutex_);
        if (CachedSession* const cached = cached_.find(credentials.id)) {
            if (!equalInConstantTime(credentials.token, cached->credentials.token)) return kBadToken;
            if (!cached->pending.whole)
                return kNoAnswer;  // another client is opening the session, or the session is being written
            cached->closed = false;
            FetchedSession found{*cached->pending.whole, {}};
            found.record.fence = cached->fence;
            return found;
        }
        if (removals_.contains(credentials.id)) return kNotFound;
        if (now_() < readAt_) return kNoAnswer;
    }
    const auto hash = runAndReportTime("token", [&] { return store_->tokenHash(credentials.id); });
    if (!hash) return kNotFound;
    if (!equalInConstantTime(hashToken(credentials.token), *hash)) {
        // If the stored hash is damaged, the token may be correct.
        return runAndReportTime("token", [&] { return store_->isDamaged(credentials.id); }) ? kNotFound : kBadToken;
    }
    if (access == FetchMode::read) {
        auto stored = runAndReportTime("read", [&] { return store_->read(credentials.id); });
        return stored ? FetchResult(FetchedSession{{}, std::move(*stored)}) : kNotFound;
    }
    auto record = runAndReportTime("claim", [&] { return store_->claim(credentials.id); });
    if (!record) return kNotFound;
    const std::lock_guard lock(mutex_);
    cached_.addStored(credentials, record->fence);
    return FetchedSession{{}, std::move(*record)};
}

}  // namespace oval4d::store
