#pragma once
// Assertions that an object is used only by the threads that may use it. The assertions do nothing in builds with
// NDEBUG (release builds).

#include <atomic>
#include <cassert>
#include <thread>

namespace oval4d::parallel {

/// Checks that an object is used only by the thread that constructed it. Use as a member or base of that object.
class ThreadOwnerAssertion {
  public:
#ifdef NDEBUG
    /// Asserts that the calling thread constructed this object.
    void assertOwner() const {}
#else
    void assertOwner() const {
        assert(std::this_thread::get_id() == owner_ && "used by a thread that does not own it");
    }

  private:
    std::thread::id owner_ = std::this_thread::get_id();
#endif
};

/// Checks that an object is used by at most one thread at a time, which may be any thread. Use as a member of that
/// object. A copy of the object starts as not in use.
class ExclusiveUseAssertion {
  public:
    /// Marks the object as in use as long as this ScopedUse exists. The constructor asserts that the object has no
    /// other ScopedUse.
    class ScopedUse {
      public:
#ifdef NDEBUG
        explicit ScopedUse(ExclusiveUseAssertion& /*used*/) {}
#else
        explicit ScopedUse(ExclusiveUseAssertion& used) : used_(used) {
            const bool alone = !used_.inUse_.exchange(true);
            assert(alone && "used by two threads at once");
            (void)alone;
        }
        ~ScopedUse() { used_.inUse_ = false; }
        ScopedUse(const ScopedUse&) = delete;
        ScopedUse& operator=(const ScopedUse&) = delete;

      private:
        ExclusiveUseAssertion& used_;
#endif
    };

#ifndef NDEBUG
    ExclusiveUseAssertion() = default;
    ExclusiveUseAssertion(const ExclusiveUseAssertion& /*other*/) {}
    ExclusiveUseAssertion& operator=(const ExclusiveUseAssertion& /*other*/) { return *this; }

  private:
    std::atomic<bool> inUse_ = false;
#endif
};

}  // namespace oval4d::parallel
