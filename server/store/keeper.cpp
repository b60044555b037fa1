#include "store/keeper.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <set>

#include "store/codec.hpp"
#include "store/secret.hpp"

namespace oval4d::store {

using protocol::Error;
using protocol::ErrorCode;
using session::Session;
using namespace std::chrono_literals;

namespace {

constexpr std::size_t kIdBytes = 10, kTokenBytes = 20, kKeyBytes = 10;
constexpr std::size_t kBatch = 256;  // sessions written in one go
constexpr auto kPulse = 500ms;
constexpr auto kFirstPause = 100ms, kLongestPause = 5000ms;  // between attempts while the store fails
constexpr auto kLongestTidy = 60s;

const Error kNotFound{ErrorCode::not_found, "there is no such session; it may have expired"};
const Error kBadToken{ErrorCode::bad_token, "this token does not open the session"};
const Error kNoAnswer{ErrorCode::internal, "sessions that are kept elsewhere cannot be fetched at present; try again"};

}  // namespace

Keeper::Keeper(std::unique_ptr<Store> store, Settings settings, Listener listener)
    : store_(std::move(store)),
      pace_(store_->pace()),
      name_(store_->name()),
      settings_(settings),
      listener_(std::move(listener)),
      random_(std::random_device{}()),
      thread_([this] { run(); }) {}

Keeper::~Keeper() { stop(0ms); }

void Keeper::stop(Milliseconds limit) {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        stopAt_ = Clock::now() + limit;
    }
    wake_.notify_one();
    if (thread_.joinable()) thread_.join();
    // Who still waits may own much: let go of outside the lock, and no later than the caller of this expects.
    decltype(held_) held;
    decltype(tasks_) tasks;
    {
        const std::lock_guard lock(mutex_);
        held.swap(held_);
        tasks.swap(tasks_);
    }
}

Ticket Keeper::create() {
    Ticket ticket{randomName(kIdBytes), randomName(kTokenBytes)};
    const std::lock_guard lock(mutex_);
    held_[ticket.id].ticket = ticket;
    ++created_;
    return ticket;
}

void Keeper::fetch(Ticket ticket, std::function<void(Fetch)> done) {
    {
        const std::lock_guard lock(mutex_);
        tasks_.emplace_back([this, ticket = std::move(ticket), done = std::move(done)] { answer(ticket, done); });
    }
    wake_.notify_one();
}

void Keeper::know(const std::string& id, Keys keys) {
    const std::lock_guard lock(mutex_);
    tasks_.emplace_back([this, id, keys = std::move(keys)]() mutable { keys_[id] = std::move(keys); });
}

void Keeper::save(const std::string& id, Session value, Part part, Written written) {
    bool ours = false;
    {
        const std::lock_guard lock(mutex_);
        if (const auto found = held_.find(id); found != held_.end()) {
            ours = true;
            Held& held = found->second;
            (part == Part::head ? held.head : held.whole) = std::make_shared<const Session>(std::move(value));
            enqueue(id, held);
            if (trouble_.empty() && written) held.waiting.push_back(std::exchange(written, nullptr));
        }
    }
    wake_.notify_one();
    if (written) written(ours);
}

void Keeper::close(const std::string& id, Session value) {
    {
        const std::lock_guard lock(mutex_);
        const auto found = held_.find(id);
        if (found == held_.end()) return;
        Held& held = found->second;
        held.whole = std::make_shared<const Session>(std::move(value));
        held.closed = true;
        held.closedAt = Clock::now();
        enqueue(id, held);
    }
    wake_.notify_one();
}

void Keeper::letGo(const std::string& id) {
    const std::lock_guard lock(mutex_);
    held_.erase(id);
}

std::size_t Keeper::count() const {
    const std::lock_guard lock(mutex_);
    // What many servers share is no measure of what one of them bears.
    return pace_ == Store::Pace::at_once ? held_.size() : kept_ + created_;
}

std::size_t Keeper::unsaved() const {
    const std::lock_guard lock(mutex_);
    return static_cast<std::size_t>(std::ranges::count_if(held_, [](const auto& entry) {
        const Held& held = entry.second;
        return held.head || held.whole || held.underway;
    }));
}

std::string Keeper::trouble() const {
    const std::lock_guard lock(mutex_);
    return trouble_;
}

void Keeper::enqueue(const std::string& id, Held& held) {
    if (std::exchange(held.queued, true)) return;
    queue_.push_back(id);
}

bool Keeper::mayWrite() const { return !queue_.empty() && Clock::now() >= retryAt_; }

Keeper::Clock::time_point Keeper::nextWake() const {
    const auto next = queue_.empty() ? pulseAt_ : std::min(pulseAt_, retryAt_);
    return stopping_ ? std::min(next, stopAt_) : next;
}

void Keeper::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        if (!tasks_.empty()) {
            const auto task = std::move(tasks_.front());
            tasks_.pop_front();
            lock.unlock();
            task();
        } else if (stopping_ && (queue_.empty() || Clock::now() >= stopAt_)) {
            if (!queue_.empty()) spdlog::error("sessions not written count={} store={}", queue_.size(), name_);
            return;
        } else if (mayWrite()) {
            lock.unlock();
            write();
        } else if (Clock::now() >= pulseAt_) {
            lock.unlock();
            pulse();
        } else {
            wake_.wait_until(lock, nextWake());
            continue;
        }
        lock.lock();
    }
}

/// Asks the store, and tells how long it took.
template <typename Ask>
auto Keeper::ask(const char* what, Ask ask) {
    const auto start = Clock::now();
    const auto tell = [&](bool done) {
        listener_.asked(what, std::chrono::duration<double>(Clock::now() - start).count(), done);
    };
    try {
        auto answer = ask();
        tell(true);
        return answer;
    } catch (...) {
        tell(false);
        throw;
    }
}

void Keeper::failed(const std::string& why) {
    const Milliseconds longest = std::min<Milliseconds>(kFirstPause * (1 << std::min(failures_++, 10)), kLongestPause);
    const Milliseconds pause = longest / 2 + Milliseconds(random_() % static_cast<unsigned>(longest.count() / 2));
    const std::lock_guard lock(mutex_);
    retryAt_ = pulseAt_ = Clock::now() + pause;
    if (trouble_.empty()) spdlog::error("store fails, sessions stay in memory meanwhile fault=\"{}\"", why);
    trouble_ = why;
}

void Keeper::worked() {
    {
        const std::lock_guard lock(mutex_);
        failures_ = 0;
        if (trouble_.empty()) return;
        trouble_.clear();
    }
    spdlog::info("store answers again store={}", name_);
    listener_.back();
}

// --- Writing

void Keeper::write() {
    std::vector<Job> jobs;
    std::vector<Saving> savings;
    {
        const std::lock_guard lock(mutex_);
        while (!queue_.empty() && jobs.size() < kBatch) {
            const std::string id = std::move(queue_.front());
            queue_.pop_front();
            const auto found = held_.find(id);
            if (found == held_.end()) continue;
            Held& held = found->second;
            held.queued = false;
            held.underway = true;
            jobs.push_back({id,
                            std::exchange(held.head, nullptr),
                            std::exchange(held.whole, nullptr),
                            std::exchange(held.waiting, {}),
                            {}});
            savings.push_back({held.ticket, held.fence, {}, {}, {}, {}, held.closed});
        }
    }
    if (jobs.empty()) return;
    std::vector<Saved> said;
    try {
        for (std::size_t i = 0; i < jobs.size(); ++i) encode(jobs[i], savings[i]);
        said = ask("save", [&] { return store_->save(savings); });
    } catch (const std::exception& fault) {
        failed(fault.what());
        for (Job& job : jobs) putBack(job);
        return;
    }
    for (std::size_t i = 0; i < jobs.size(); ++i) settle(jobs[i], savings[i], said[i]);
    worked();
}

/// A polytope travels once; of those that are no longer in the session, the store is told.
void Keeper::encode(Job& job, Saving& saving) {
    Keys& keys = keys_[job.id];
    std::set<std::uint64_t> used;
    const KeyOf keyOf = [&](const session::PolytopePtr& polytope) {
        used.insert(polytope->serial);
        const auto [found, isNew] = keys.try_emplace(polytope->serial);
        if (isNew) {
            found->second = randomName(kKeyBytes);
            saving.polytopes.emplace_back(found->second, encodePolytope(*polytope));
            job.added.insert(*found);
        }
        return found->second;
    };
    if (job.whole) saving.whole = encodeWhole(*job.whole, settings_.maxUndo, keyOf);
    if (job.head && (!job.whole || job.head->revision > job.whole->revision))
        saving.head = encodeHead(*job.head, keyOf);
    if (!job.whole) return;
    for (const auto& [serial, key] : keys) {
        if (!used.contains(serial)) saving.dropped.push_back(key);
    }
}

void Keeper::settle(Job& job, const Saving& saving, Saved said) {
    if (said == Saved::yes) {
        std::erase_if(keys_[job.id], [&](const auto& entry) {
            return std::ranges::find(saving.dropped, entry.second) != saving.dropped.end();
        });
        const std::lock_guard lock(mutex_);
        const auto found = held_.find(job.id);
        if (found != held_.end()) {
            Held& held = found->second;
            held.underway = false;
            if (!std::exchange(held.saved, true)) pulseAt_ = Clock::time_point();  // there is one more
            if (held.closed && !held.queued) {
                held_.erase(found);
                keys_.erase(job.id);
            }
        }
    } else if (said == Saved::missing) {
        putBack(job);
        listener_.wanted(job.id);
        return;
    } else {
        lose(job.id);
    }
    for (const Written& written : job.waiting) written(said == Saved::yes);
}

/// What could not be written waits again, unless something newer does.
void Keeper::putBack(Job& job) {
    for (const auto& [serial, key] : job.added) keys_[job.id].erase(serial);
    std::vector<Written> released;
    {
        const std::lock_guard lock(mutex_);
        const auto found = held_.find(job.id);
        if (found == held_.end()) return;
        Held& held = found->second;
        held.underway = false;
        if (!held.head) held.head = std::move(job.head);
        if (!held.whole) held.whole = std::move(job.whole);
        std::ranges::move(job.waiting, std::back_inserter(held.waiting));
        if (!trouble_.empty()) {
            enqueue(job.id, held);
            released = std::exchange(held.waiting, {});
        }
    }
    for (const Written& written : released) written(true);
}

void Keeper::lose(const std::string& id) {
    std::vector<Written> released;
    bool open = false;
    {
        const std::lock_guard lock(mutex_);
        const auto found = held_.find(id);
        if (found == held_.end()) return;
        released = std::move(found->second.waiting);
        open = !found->second.closed;
        held_.erase(found);
    }
    keys_.erase(id);
    for (const Written& written : released) written(false);
    if (open) listener_.taken(id);
}

// --- Pulse

void Keeper::pulse() {
    {
        const std::lock_guard lock(mutex_);
        pulseAt_ = Clock::now() + kPulse;
    }
    try {
        if (Clock::now() >= tidyAt_) tidy();
        for (const std::string& id : ask("pulse", [&] { return store_->pulse(); })) lose(id);
    } catch (const std::exception& fault) {
        failed(fault.what());
        return;
    }
    bool waiting = false;
    {
        const std::lock_guard lock(mutex_);
        kept_ = store_->size();
        created_ = static_cast<std::size_t>(
            std::ranges::count_if(held_, [](const auto& entry) { return !entry.second.saved; }));
        waiting = !queue_.empty();
    }
    if (!waiting) worked();  // else it is for the next writing to say: a full store has a pulse too
}

/// Puts off the expiry of sessions that are open, and lets those expire that nobody has had open for long.
void Keeper::tidy() {
    const Milliseconds interval = std::min<Milliseconds>(settings_.expiry / 4, kLongestTidy);
    tidyAt_ = Clock::now() + interval;
    std::vector<std::string> open;
    {
        const std::lock_guard lock(mutex_);
        pulseAt_ = std::min(pulseAt_, tidyAt_);
        std::erase_if(held_, [&](const auto& entry) {
            const bool old = entry.second.closed && Clock::now() - entry.second.closedAt > settings_.expiry;
            if (old) keys_.erase(entry.first);
            return old;
        });
        for (const auto& [id, held] : held_) {
            if (held.saved && !held.closed) open.push_back(id);
        }
    }
    for (std::size_t i = 0; i < open.size(); i += kBatch) {
        const auto some = std::span(open).subspan(i, std::min(kBatch, open.size() - i));
        ask("touch", [&] { return store_->touch(some), true; });
    }
    const std::size_t gone = ask("expire", [&] { return store_->expire(settings_.expiry); });
    if (gone > 0) spdlog::info("sessions expired count={}", gone);
}

// --- Reading

void Keeper::answer(const Ticket& ticket, const std::function<void(Fetch)>& done) {
    try {
        done(lookUp(ticket));
    } catch (const std::exception& fault) {
        failed(fault.what());
        done(kNoAnswer);
    }
}

Keeper::Fetch Keeper::lookUp(const Ticket& ticket) {
    {
        const std::lock_guard lock(mutex_);
        if (const auto found = held_.find(ticket.id); found != held_.end()) {
            Held& held = found->second;
            if (!sameSecret(ticket.token, held.ticket.token)) return kBadToken;
            if (!held.whole) return kNoAnswer;  // it is being opened by another
            held.closed = false;
            return Fetched{*held.whole, {}};
        }
        if (Clock::now() < retryAt_) return kNoAnswer;
    }
    const auto token = ask("token", [&] { return store_->token(ticket.id); });
    if (!token) return kNotFound;
    if (!sameSecret(ticket.token, *token)) return kBadToken;
    auto record = ask("claim", [&] { return store_->claim(ticket.id); });
    if (!record) return kNotFound;
    const std::lock_guard lock(mutex_);
    Held& held = held_[ticket.id];
    held.ticket = ticket;
    held.fence = record->fence;
    held.saved = true;
    return Fetched{{}, std::move(*record)};
}

}  // namespace oval4d::store
