#include "store/memory_store.hpp"

#include <algorithm>
#include <tuple>

#include "store/secret.hpp"

namespace oval4d::store {

std::size_t MemoryStore::StoredSession::bytes() const {
    constexpr std::size_t kOverhead = 512;  // estimated memory of an entry of a map without its texts, in bytes
    std::size_t bytes = kOverhead + tokenHash.size() + whole.size() + head.size();
    for (const auto& [key, object] : objects) bytes += kOverhead + object.size();
    return bytes;
}

std::optional<std::string> MemoryStore::tokenHash(const std::string& id) {
    const auto found = entries_.find(id);
    return found == entries_.end() ? std::nullopt : std::optional(found->second.tokenHash);
}

std::optional<SessionRecord> MemoryStore::read(const std::string& id) {
    const auto found = entries_.find(id);
    if (found == entries_.end()) return std::nullopt;
    const StoredSession& entry = found->second;
    return SessionRecord{entry.whole, entry.head, {entry.objects.begin(), entry.objects.end()}, entry.fence, {}};
}

std::optional<SessionRecord> MemoryStore::claim(const std::string& id) {
    const auto found = entries_.find(id);
    if (found == entries_.end()) return std::nullopt;
    found->second.touched = now_();
    ++found->second.fence;
    return read(id);
}

/// Returns an upper bound of the total size of all records after the updates, in bytes. Does not subtract the sizes of
/// the data that the updates replace.
std::size_t MemoryStore::sizeBoundAfter(std::span<const RecordUpdate> updates) const {
    std::size_t bytes = bytes_;
    for (const RecordUpdate& update : updates) bytes += estimateStoredSize(update);
    return bytes;
}

std::vector<SaveResult> MemoryStore::save(std::span<const RecordUpdate> updates) {
    if (sizeBoundAfter(updates) > quota_) {
        throw StoreNotWritable("memory: open sessions use up the quota (--store-quota)");
    }
    std::vector<SaveResult> results;
    for (const RecordUpdate& update : updates) {
        const auto found = entries_.find(update.credentials.id);
        const bool known = found != entries_.end();
        if (known ? update.fence < found->second.fence : update.whole.empty()) {
            results.push_back(known ? SaveResult::claimed : SaveResult::missing);
            continue;
        }
        results.push_back(SaveResult::saved);
        StoredSession& entry = entries_[update.credentials.id];
        if (known) bytes_ -= entry.bytes();
        if (!known) entry.tokenHash = hashToken(update.credentials.token);
        entry.fence = update.fence;
        entry.touched = now_();
        entry.changed = update.changed;
        if (!update.whole.empty()) entry.whole = update.whole;
        if (!update.whole.empty() || !update.head.empty()) entry.head = update.head;
        for (const auto& [key, bytes] : update.objects) entry.objects[key] = bytes;
        for (const std::string& key : update.dropped) entry.objects.erase(key);
        bytes_ += entry.bytes();
    }
    return results;
}

MemoryStore::SessionsById::iterator MemoryStore::erase(SessionsById::iterator entry) {
    bytes_ -= entry->second.bytes();
    return entries_.erase(entry);
}

std::size_t MemoryStore::evict(std::span<const RecordUpdate> updates, const PinnedPredicate& isPinned) {
    if (sizeBoundAfter(updates) <= quota_) return 0;
    std::vector<SessionsById::iterator> candidates;
    std::size_t evictable = 0;
    for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
        if (isPinned(entry->first)) continue;
        candidates.push_back(entry);
        evictable += entry->second.bytes();
    }
    if (sizeBoundAfter(updates) - evictable > quota_) return 0;
    std::ranges::sort(candidates, {},
                      [](const auto& entry) { return std::tuple(entry->second.changed, entry->second.touched); });
    std::size_t count = 0;
    for (const auto& entry : candidates) {
        if (sizeBoundAfter(updates) <= quota_) break;
        erase(entry);
        ++count;
    }
    return count;
}

void MemoryStore::remove(std::span<const std::string> ids) {
    for (const std::string& id : ids) {
        if (const auto found = entries_.find(id); found != entries_.end()) erase(found);
    }
}

void MemoryStore::restartExpiry(std::span<const std::string> ids) {
    for (const std::string& id : ids) {
        if (const auto found = entries_.find(id); found != entries_.end()) found->second.touched = now_();
    }
}

std::size_t MemoryStore::expire(Milliseconds age) {
    const auto limit = now_() - age;
    const std::size_t before = entries_.size();
    for (auto entry = entries_.begin(); entry != entries_.end();)
        entry = entry->second.touched < limit ? erase(entry) : std::next(entry);
    return before - entries_.size();
}

}  // namespace oval4d::store
