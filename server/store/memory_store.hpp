#pragma once
// Sessions kept in memory: they end with the process.

#include <map>

#include "store/store.hpp"

namespace oval4d::store {

class MemoryStore final : public Store {
  public:
    using Clock = std::chrono::steady_clock;

    Pace pace() const override { return Pace::at_close; }
    std::string name() const override { return "memory"; }
    std::optional<std::string> token(const std::string& id) override;
    std::optional<Record> claim(const std::string& id) override;
    std::vector<Saved> save(std::span<const Saving> savings) override;
    void touch(std::span<const std::string> ids) override;
    std::size_t expire(Milliseconds age) override;
    std::vector<std::string> pulse() override { return {}; }
    std::size_t size() const override { return kept_.size(); }

  private:
    struct Kept {
        std::string token, whole, head;
        std::map<std::string, std::string> polytopes;
        Fence fence = 0;
        Clock::time_point touched;
    };

    std::map<std::string, Kept> kept_;
};

}  // namespace oval4d::store
