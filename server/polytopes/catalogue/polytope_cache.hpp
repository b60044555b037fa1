#pragma once
// A cache of polytopes built from designs.

#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "polytopes/construction/design.hpp"

namespace oval4d::polytopes {

/// The 5-cell, which new sessions show: the same object for all callers and all caches.
const std::shared_ptr<const Polytope>& fiveCell();

/// A cache keyed by name. It refers weakly to every polytope that is in use elsewhere, and owns the most recently used
/// ones up to a memory limit. Thread-safe.
class PolytopeCache {
  public:
    using Shared = std::shared_ptr<const Polytope>;

    static constexpr std::size_t kDefaultBytes = std::size_t{64} << 20U;

    /// `bytes`: the limit on the memory of the polytopes that the cache owns.
    explicit PolytopeCache(std::size_t bytes = kDefaultBytes) : maxBytes_(bytes) {}

    /// The polytope of this design, built on first use; concurrent calls for one design build it once. Throws
    /// std::invalid_argument as `build` does.
    Shared get(const Design& design);

    /// The polytope of this design if it is built, else nullptr. Never waits for a build.
    Shared find(const Design& design);

    /// The memory in bytes of the polytopes that the cache owns; never more than the limit.
    std::size_t bytes() const;

  private:
    struct Slot {
        std::mutex building;  // held while the polytope is being built
        std::weak_ptr<const Polytope> polytope;
    };

    Shared peek(const Design& design) const;
    std::shared_ptr<Slot> slotOf(const std::string& name);
    void markUsed(const Shared& polytope);

    const std::size_t maxBytes_;
    mutable std::mutex mutex_;  // guards the members below; not held while a polytope is being built
    std::map<std::string, std::shared_ptr<Slot>> slots_;
    std::list<Shared> recent_;  // the most recently used first
    std::size_t bytes_ = 0;     // of `recent_`
};

}  // namespace oval4d::polytopes
