#pragma once
// A second core for what is large.

#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace oval4d::geometry {

/// One thread beside all others of the process, begun when it is first wanted. Whoever has two things to do that do not
/// depend on one another lets it do the second. Where it is taken by another, or every processor has work already, the
/// caller does both: that is faster for all together. To wake it takes some 10 µs.
class Companion {
  public:
    using Job = std::function<void()>;

    /// While one lives, a processor has work.
    class Work {
      public:
        Work() { ++busyProcessors; }
        ~Work() { --busyProcessors; }
        Work(const Work&) = delete;
        Work& operator=(const Work&) = delete;
    };

    static Companion& instance();

    /// Returns when both are done. Throws what one of them threw; the other one may not have been begun then.
    void doBoth(const Job& first, const Job& second);

    Companion(const Companion&) = delete;
    Companion& operator=(const Companion&) = delete;

  private:
    Companion();
    ~Companion();
    void run();

    static inline std::atomic<unsigned> busyProcessors = 0;

    const unsigned processors_ = std::thread::hardware_concurrency();
    std::atomic_flag taken_;  // works for somebody
    std::mutex mutex_;
    std::condition_variable changed_;
    // Guarded by mutex_.
    const Job* job_ = nullptr;
    std::exception_ptr thrown_;
    bool ending_ = false;
    std::thread thread_;
};

}  // namespace oval4d::geometry
