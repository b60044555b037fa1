#include "geometry/companion.hpp"

#include <utility>

namespace oval4d::geometry {

Companion& Companion::instance() {
    static Companion one;
    return one;
}

Companion::Companion() {
    if (processors_ > 1) thread_ = std::thread([this] { run(); });
}

Companion::~Companion() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void Companion::doBoth(const Job& first, const Job& second) {
    if (!thread_.joinable() || busyProcessors >= processors_ || taken_.test_and_set()) {
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
    std::exception_ptr others;
    {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return job_ == nullptr; });
        others = std::exchange(thrown_, nullptr);
    }
    taken_.clear();
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
