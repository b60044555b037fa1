// Polytopes built once and shared.

#include <list>
#include <map>
#include <mutex>
#include <utility>

#include "geometry/catalogue.hpp"

namespace oval4d::geometry {

namespace {

using Shared = std::shared_ptr<const Polytope>;

std::size_t bytesOf(const Lists& lists) { return sizeof(std::uint32_t) * (lists.begin.size() + lists.items.size()); }

std::size_t bytesOf(const Polytope& p) {
    return sizeof p + p.vertices.size() * sizeof p.vertices[0] + p.edges.size() * sizeof p.edges[0] +
           p.faceCells.size() * sizeof p.faceCells[0] + p.cellSigns.size() +
           p.cellKinds.size() * sizeof p.cellKinds[0] + bytesOf(p.faces) + bytesOf(p.faceEdges) + bytesOf(p.edgeFaces) +
           bytesOf(p.cells);
}

// Every polytope that anyone holds, and the ones used last.
class Library {
  public:
    Shared get(const Design& design) {
        const auto slot = slotOf(design.name);
        const std::scoped_lock building(slot->building);
        Shared polytope = slot->polytope.lock();
        if (!polytope) {
            polytope = std::make_shared<const Polytope>(build(design));
            slot->polytope = polytope;
        }
        remember(polytope);
        return polytope;
    }

    Shared find(const Design& design) {
        const auto slot = slotOf(design.name);
        const std::unique_lock building(slot->building, std::try_to_lock);
        Shared polytope = building ? slot->polytope.lock() : nullptr;
        if (polytope) remember(polytope);
        return polytope;
    }

    void keep(std::size_t bytes) {
        const std::scoped_lock lock(mutex_);
        most_ = bytes;
        forget();
    }

    std::size_t kept() {
        const std::scoped_lock lock(mutex_);
        return bytes_;
    }

  private:
    struct Slot {
        std::mutex building;
        std::weak_ptr<const Polytope> polytope;  // guarded by `building`
    };

    std::shared_ptr<Slot> slotOf(const std::string& name) {
        const std::scoped_lock lock(mutex_);
        // Names that are not in use any more go once they are many.
        constexpr std::size_t kMany = 1000;
        if (slots_.size() >= kMany) {
            std::erase_if(slots_, [](const auto& slot) {
                if (slot.second.use_count() > 1) return false;
                const std::scoped_lock building(slot.second->building);
                return slot.second->polytope.expired();
            });
        }
        auto& slot = slots_[name];
        if (!slot) slot = std::make_shared<Slot>();
        return slot;
    }

    void remember(const Shared& polytope) {
        const std::scoped_lock lock(mutex_);
        for (auto at = latest_.begin(); at != latest_.end(); ++at) {
            if (*at != polytope) continue;
            latest_.splice(latest_.begin(), latest_, at);
            return;
        }
        latest_.push_front(polytope);
        bytes_ += bytesOf(*polytope);
        forget();
    }

    void forget() {
        while (bytes_ > most_ && !latest_.empty()) {
            bytes_ -= bytesOf(*latest_.back());
            latest_.pop_back();
        }
    }

    std::mutex mutex_;
    std::map<std::string, std::shared_ptr<Slot>> slots_;
    std::list<Shared> latest_;  // the one used last first
    std::size_t bytes_ = 0;     // of `latest_`
    std::size_t most_ = std::size_t{64} << 20U;
};

Library& library() {
    static Library shared;
    return shared;
}

}  // namespace

std::shared_ptr<const Polytope> polytopeOf(const Design& design) { return library().get(design); }

std::shared_ptr<const Polytope> polytopeIfBuilt(const Design& design) { return library().find(design); }

std::shared_ptr<const Polytope> polytopeOf(const CatalogueEntry& entry) { return polytopeOf(entry.design); }

void keepPolytopes(std::size_t bytes) { library().keep(bytes); }

std::size_t polytopesKept() { return library().kept(); }

}  // namespace oval4d::geometry
