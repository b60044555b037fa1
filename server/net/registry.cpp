#include "net/registry.hpp"

#include <utility>

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
    const std::lock_guard lock(registry_.mutex_);
    if (registry_.stopping_) stop();
    registry_.stops_[number_] = std::move(stop);
}

std::size_t Registry::size() const {
    const std::lock_guard lock(mutex_);
    return stops_.size();
}

void Registry::stopAll() {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    for (const auto& [number, stop] : stops_) {
        if (stop) stop();
    }
}

}  // namespace oval4d::net
