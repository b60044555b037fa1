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

/// Returns the 5-cell, which new sessions show. All callers and all caches share one object, which exists until the
/// process ends. Thread-safe.
const std::shared_ptr<const Polytope>& fiveCell();

/// A cache of polytopes, with their names as keys. The cache owns the most recently used polytopes, up to a memory
/// limit. It also finds a polytope that it no longer owns, as long as a caller still holds this polytope. Thread-safe.
class PolytopeCache {
  public:
    using SharedPolytope = std::shared_ptr<const Polytope>;

    /// The default limit on the memory of the polytopes that the cache owns: 64 MiB.
    static constexpr std::size_t kDefaultBytes = std::size_t{64} << 20U;

    /// `bytes` is the limit on the memory of the polytopes that the cache owns.
    explicit PolytopeCache(std::size_t bytes = kDefaultBytes) : maxBytes_(bytes) {}

    /// Returns the polytope of this design, and builds it on the calling thread if the cache does not find it.
    /// Concurrent calls for the same design wait until the polytope is built. Throws std::invalid_argument as build()
    /// does.
    SharedPolytope findOrBuild(const PolytopeDesign& design);

    /// Returns the polytope of this design if the cache finds it, else nullptr. Never waits for a polytope to be
    /// built, except for the first use of the 5-cell.
    SharedPolytope find(const PolytopeDesign& design);

    /// Returns the memory in bytes of the polytopes that the cache owns, which never exceeds the limit.
    std::size_t bytes() const;

  private:
    // A slot: what the cache stores for one name. The slot holds the polytope by a weak pointer, which does not keep
    // the polytope alive.
    struct PolytopeCacheEntry {
        std::mutex building;  // held while the polytope is being built
        std::weak_ptr<const Polytope> polytope;
    };

    // Returns the polytope of this design if the cache finds it, else nullptr. The design must not be that of the
    // 5-cell, which is not in the cache. Unlike find(), does not mark the polytope as used.
    SharedPolytope peek(const PolytopeDesign& design) const;
    // Returns the slot of this name; creates it if necessary.
    std::shared_ptr<PolytopeCacheEntry> findOrAddSlot(const std::string& name);
    // Moves the polytope to the front of recent_. Removes the least recently used polytopes until the memory limit is
    // met. The caller must hold mutex_.
    void markUsedAndEvict(const SharedPolytope& polytope);

    const std::size_t maxBytes_;
    mutable std::mutex mutex_;  // guards the members below and PolytopeCacheEntry::polytope; not locked while a
                                // polytope is being built
    std::map<std::string, std::shared_ptr<PolytopeCacheEntry>> slots_;
    std::list<SharedPolytope> recent_;  // the polytopes that the cache owns; the most recently used first
    std::size_t bytes_ = 0;             // the memory of the polytopes in recent_, in bytes
};

}  // namespace oval4d::polytopes
