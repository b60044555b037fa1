#include "store/memory_store.hpp"

#include "store/secret.hpp"

namespace oval4d::store {

using protocol::Error;
using protocol::ErrorCode;
using protocol::Result;

namespace {

constexpr std::size_t kIdBytes = 10, kTokenBytes = 20;

Error notFound() { return {ErrorCode::not_found, "there is no such session; it may have expired"}; }

}  // namespace

Result<Ticket> MemoryStore::create() {
    Ticket ticket{randomName(kIdBytes), randomName(kTokenBytes)};
    const std::lock_guard lock(mutex_);
    if (kept_.size() >= capacity_) {
        return Error{ErrorCode::too_many, "the server keeps at most " + std::to_string(capacity_) +
                                              " sessions, and all are taken; try again later"};
    }
    kept_.emplace(ticket.id, Kept{ticket.token, {}, {}});
    return ticket;
}

Result<std::monostate> MemoryStore::admit(const Ticket& ticket) const {
    const std::lock_guard lock(mutex_);
    const auto found = kept_.find(ticket.id);
    if (found == kept_.end()) return notFound();
    if (!sameSecret(ticket.token, found->second.token)) {
        return Error{ErrorCode::bad_token, "this token does not open the session"};
    }
    return std::monostate{};
}

Result<session::Session> MemoryStore::open(std::string_view id) {
    const std::lock_guard lock(mutex_);
    const auto found = kept_.find(id);
    if (found == kept_.end() || !found->second.value) return notFound();
    session::Session value = std::move(*found->second.value);
    found->second.value.reset();
    return value;
}

void MemoryStore::close(std::string_view id, session::Session value, Time now) {
    const std::lock_guard lock(mutex_);
    const auto found = kept_.find(id);
    if (found == kept_.end()) return;
    found->second.value = std::move(value);
    found->second.closed = now;
}

std::size_t MemoryStore::expire(Time limit) {
    const std::lock_guard lock(mutex_);
    return std::erase_if(
        kept_, [limit](const auto& entry) { return entry.second.value.has_value() && entry.second.closed < limit; });
}

std::size_t MemoryStore::size() const {
    const std::lock_guard lock(mutex_);
    return kept_.size();
}

}  // namespace oval4d::store
