#pragma once
// Sessions kept in memory: they end with the process.

#include <map>
#include <mutex>

#include "store/store.hpp"

namespace oval4d::store {

class MemoryStore final : public Store {
  public:
    explicit MemoryStore(std::size_t capacity) : capacity_(capacity) {}

    protocol::Result<Ticket> create() override;
    protocol::Result<std::monostate> admit(const Ticket& ticket) const override;
    protocol::Result<session::Session> open(std::string_view id) override;
    void close(std::string_view id, session::Session value, Time now) override;
    std::size_t expire(Time limit) override;
    std::size_t size() const override;

  private:
    struct Kept {
        std::string token;
        std::optional<session::Session> value;  // none while in use
        Time closed;
    };

    const std::size_t capacity_;
    mutable std::mutex mutex_;
    std::map<std::string, Kept, std::less<>> kept_;  // guarded by mutex_
};

}  // namespace oval4d::store
