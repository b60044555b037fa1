#include "polytopes/catalogue/polytope_cache.hpp"

#include <algorithm>

#include "polytopes/catalogue/catalogue.hpp"
#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

const std::shared_ptr<const Polytope>& fiveCell() {
    static const auto shared = std::make_shared<const Polytope>(build(catalogue().front().design));
    return shared;
}

PolytopeCache::SharedPolytope PolytopeCache::findOrBuild(const PolytopeDesign& design) {
    if (design.name == fiveCell()->name) return fiveCell();
    const auto slot = findOrAddSlot(design.name);
    const std::scoped_lock building(slot->building);
    SharedPolytope polytope = peek(design);
    if (!polytope) polytope = std::make_shared<const Polytope>(build(design));
    const std::scoped_lock lock(mutex_);
    slot->polytope = polytope;
    markUsedAndEvict(polytope);
    return polytope;
}

PolytopeCache::SharedPolytope PolytopeCache::find(const PolytopeDesign& design) {
    if (design.name == fiveCell()->name) return fiveCell();
    SharedPolytope polytope = peek(design);
    const std::scoped_lock lock(mutex_);
    if (polytope) markUsedAndEvict(polytope);
    return polytope;
}

std::size_t PolytopeCache::bytes() const {
    const std::scoped_lock lock(mutex_);
    return bytes_;
}

PolytopeCache::SharedPolytope PolytopeCache::peek(const PolytopeDesign& design) const {
    const std::scoped_lock lock(mutex_);
    const auto found = slots_.find(design.name);
    return found == slots_.end() ? nullptr : found->second->polytope.lock();
}

std::shared_ptr<PolytopeCache::PolytopeCacheEntry> PolytopeCache::findOrAddSlot(const std::string& name) {
    const std::scoped_lock lock(mutex_);
    // If there are many slots, remove each slot whose polytope no longer exists, unless another thread uses the slot.
    constexpr std::size_t kMany = 1000;
    if (slots_.size() >= kMany) {
        std::erase_if(slots_,
                      [](const auto& slot) { return slot.second.use_count() == 1 && slot.second->polytope.expired(); });
    }
    auto& slot = slots_[name];
    if (!slot) slot = std::make_shared<PolytopeCacheEntry>();
    return slot;
}

void PolytopeCache::markUsedAndEvict(const SharedPolytope& polytope) {
    if (const auto at = std::ranges::find(recent_, polytope); at != recent_.end()) {
        recent_.splice(recent_.begin(), recent_, at);
        return;
    }
    recent_.push_front(polytope);
    bytes_ += memoryOf(*polytope);
    while (bytes_ > maxBytes_ && !recent_.empty()) {
        bytes_ -= memoryOf(*recent_.back());
        recent_.pop_back();
    }
}

}  // namespace oval4d::polytopes
