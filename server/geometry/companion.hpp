#pragma once
// A second core for what is large.

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace oval4d::geometry {

/// One thread beside all others of the process, begun when it is first wanted. Whoever has two things to do that do not
/// depend on one another lets it do the second. Where it is taken by another, or there is but one processor, the caller
/// does both: nobody waits for it. To wake it takes some 10 µs.
class Companion {
  public:
    using Job = std::function<void()>;

    static Companion& instance();

    /// Returns when both are done. Throws what one of them threw.
    void doBoth(const Job& first, const Job& second);

    Companion(const Companion&) = delete;
    Companion& operator=(const Companion&) = delete;

  private:
    Companion();
    ~Companion();
    void run();

    std::mutex taken_;  // held by whom it works for
    std::mutex mutex_;
    std::condition_variable changed_;
    // Guarded by mutex_.
    const Job* job_ = nullptr;
    std::exception_ptr thrown_;
    bool ending_ = false;
    std::thread thread_;
};

}  // namespace oval4d::geometry
