#include "store/memory_store.hpp"

namespace oval4d::store {

std::optional<std::string> MemoryStore::token(const std::string& id) {
    const auto found = kept_.find(id);
    return found == kept_.end() ? std::nullopt : std::optional(found->second.token);
}

std::optional<Record> MemoryStore::claim(const std::string& id) {
    const auto found = kept_.find(id);
    if (found == kept_.end()) return std::nullopt;
    Kept& kept = found->second;
    kept.touched = Clock::now();
    return Record{kept.whole, kept.head, {kept.polytopes.begin(), kept.polytopes.end()}, ++kept.fence};
}

std::vector<Saved> MemoryStore::save(std::span<const Saving> savings) {
    std::vector<Saved> said;
    for (const Saving& saving : savings) {
        const auto found = kept_.find(saving.ticket.id);
        const bool known = found != kept_.end();
        if (known ? saving.fence < found->second.fence : saving.whole.empty()) {
            said.push_back(known ? Saved::taken : Saved::missing);
            continue;
        }
        said.push_back(Saved::yes);
        Kept& kept = kept_[saving.ticket.id];
        kept.token = saving.ticket.token;
        kept.fence = saving.fence;
        kept.touched = Clock::now();
        if (!saving.whole.empty()) kept.whole = saving.whole;
        if (!saving.whole.empty() || !saving.head.empty()) kept.head = saving.head;
        for (const auto& [key, bytes] : saving.polytopes) kept.polytopes[key] = bytes;
        for (const std::string& key : saving.dropped) kept.polytopes.erase(key);
    }
    return said;
}

void MemoryStore::touch(std::span<const std::string> ids) {
    for (const std::string& id : ids) {
        if (const auto found = kept_.find(id); found != kept_.end()) found->second.touched = Clock::now();
    }
}

std::size_t MemoryStore::expire(Milliseconds age) {
    const auto limit = Clock::now() - age;
    return std::erase_if(kept_, [limit](const auto& entry) { return entry.second.touched < limit; });
}

}  // namespace oval4d::store
