#include "geometry/companion.hpp"

#include <utility>

namespace oval4d::geometry {

Companion& Companion::instance() {
    static Companion one;
    return one;
}

Companion::Companion() {
    if (std::thread::hardware_concurrency() > 1) thread_ = std::thread([this] { run(); });
}

Companion::~Companion() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void Companion::doBoth(const Job& first, const std::function<void()>& second) {
    const std::unique_lock taken(taken_, std::try_to_lock);
    if (!taken || !thread_.joinable()) {
        first();
        second();
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        job_ = &second;
    }
    changed_.notify_all();
    std::exception_ptr own;
    try {
        first();
    } catch (...) {
        own = std::current_exception();
    }
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return job_ == nullptr; });
    const std::exception_ptr others = std::exchange(thrown_, nullptr);
    if (own) std::rethrow_exception(own);
    if (others) std::rethrow_exception(others);
}

void Companion::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return job_ != nullptr || ending_; });
        if (ending_) return;
        lock.unlock();
        std::exception_ptr thrown;
        try {
            (*job_)();
        } catch (...) {
            thrown = std::current_exception();
        }
        lock.lock();
        thrown_ = thrown;
        job_ = nullptr;
        changed_.notify_all();
    }
}

}  // namespace oval4d::geometry
