#include "net/registry.hpp"

#include <utility>
#include <vector>

namespace oval4d::net {

Registry::Place::Place(Registry& registry) : registry_(registry) {
    const std::lock_guard lock(registry_.mutex_);
    number_ = ++registry_.last_;
    registry_.stops_.emplace(number_, nullptr);
}

Registry::Place::~Place() {
    std::function<void()> gone;  // destroyed outside the lock: it may own the connection
    const std::lock_guard lock(registry_.mutex_);
    const auto found = registry_.stops_.find(number_);
    gone = std::move(found->second);
    registry_.stops_.erase(found);
}

void Registry::Place::onStop(std::function<void()> stop) {
    bool now = false;
    {
        const std::lock_guard lock(registry_.mutex_);
        now = registry_.stopping_;
        std::swap(registry_.stops_[number_], stop);
        if (now) stop = registry_.stops_[number_];
    }
    if (now) stop();
}

std::size_t Registry::size() const {
    const std::lock_guard lock(mutex_);
    return stops_.size();
}

void Registry::stopAll() {
    // Outside the lock: what is asked to end may end at once, and give its place back.
    std::vector<std::function<void()>> stops;
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        for (const auto& [number, stop] : stops_) {
            if (stop) stops.push_back(stop);
        }
    }
    for (const auto& stop : stops) stop();
}

}  // namespace oval4d::net
