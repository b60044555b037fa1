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

/// Returns the 5-cell, which new sessions show. All callers and all caches share the same object. Thread-safe.
const std::shared_ptr<const Polytope>& fiveCell();

/// A cache of polytopes by name. Finds every polytope that is still in use elsewhere, through a weak pointer; in
/// addition, owns the most recently used polytopes up to a memory limit. Thread-safe.
class PolytopeCache {
  public:
    using Shared = std::shared_ptr<const Polytope>;

    static constexpr std::size_t kDefaultBytes = std::size_t{64} << 20U;

    /// `bytes` is the limit on the memory of the polytopes that the cache owns.
    explicit PolytopeCache(std::size_t bytes = kDefaultBytes) : maxBytes_(bytes) {}

    /// Returns the polytope of this design, and builds it if necessary. Concurrent calls for the same design build it
    /// only once; the other calls wait. Throws std::invalid_argument as `build` does.
    Shared get(const Design& design);

    /// Returns the polytope of this design if it exists, else nullptr. Never waits for a polytope to be built.
    Shared find(const Design& design);

    /// Returns the memory in bytes of the polytopes that the cache owns, which never exceeds the limit.
    std::size_t bytes() const;

  private:
    // The entry of the cache for one name.
    struct Slot {
        std::mutex building;  // held while the polytope is being built
        std::weak_ptr<const Polytope> polytope;
    };

    // Returns the polytope of this design if it exists, without marking it as used; else nullptr.
    Shared peek(const Design& design) const;
    // Returns the slot of this name; creates it if necessary.
    std::shared_ptr<Slot> slotOf(const std::string& name);
    // Moves the polytope to the front of recent_, and removes the least recently used ones beyond the limit. Requires
    // that mutex_ is held.
    void markUsed(const Shared& polytope);

    const std::size_t maxBytes_;
    mutable std::mutex mutex_;  // guards the members below; not held while a polytope is being built
    std::map<std::string, std::shared_ptr<Slot>> slots_;
    std::list<Shared> recent_;  // the most recently used first
    std::size_t bytes_ = 0;     // the memory of the polytopes in `recent_`
};

}  // namespace oval4d::polytopes
