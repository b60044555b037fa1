#include "slicing/critical/critical_sections_cache.hpp"

#include <algorithm>
#include <utility>

namespace oval4d::slicing {

CriticalSectionsPtr CriticalSectionsCache::find(const Object& object, const geometry::Rotation& orientation,
                                                const FieldSettings& settings) {
    const SearchArguments arguments{infoOf(object).serial, orientation, settings};
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find(recent_, arguments, &CachedSections::arguments);
    if (found == recent_.end()) return nullptr;
    recent_.splice(recent_.begin(), recent_, found);
    return found->result;
}

void CriticalSectionsCache::add(const Object& object, const geometry::Rotation& orientation,
                                const FieldSettings& settings, CriticalSectionsPtr result) {
    const std::size_t bytes = sizeof(CachedSections) + sizeof(CriticalSections) +
                              settings.levels.capacity() * sizeof(double) +
                              result->all.capacity() * sizeof(CriticalSection);
    if (bytes > maxBytes_) return;
    const std::lock_guard lock(mutex_);
    recent_.push_front({{infoOf(object).serial, orientation, settings}, std::move(result), bytes});
    bytes_ += bytes;
    while (bytes_ > maxBytes_) {
        bytes_ -= recent_.back().bytes;
        recent_.pop_back();
    }
}

std::size_t CriticalSectionsCache::bytes() const {
    const std::lock_guard lock(mutex_);
    return bytes_;
}

}  // namespace oval4d::slicing
