#include "parallel/fork_join.hpp"

#include <utility>

namespace oval4d::parallel {

ForkJoin::ForkJoin() {
    if (processors_ > 1) thread_ = std::thread([this] { runHelperThread(); });
}

ForkJoin::~ForkJoin() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void ForkJoin::invoke(const Job& first, const Job& second) {
    if (!thread_.joinable() || busyProcessors_ >= processors_ || taken_.test_and_set()) {
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

void ForkJoin::runHelperThread() {
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

void invoke(ForkJoin* forkJoin, const ForkJoin::Job& first, const ForkJoin::Job& second) {
    if (forkJoin != nullptr) return forkJoin->invoke(first, second);
    first();
    second();
}

}  // namespace oval4d::parallel
