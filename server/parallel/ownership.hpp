#pragma once
// Assertions that only the allowed threads use an object. In builds with NDEBUG (release builds), the assertions do
// nothing.

#include <atomic>
#include <cassert>
#include <thread>

namespace oval4d::parallel {

/// Checks that only the thread that constructed an object uses it. Use as a member or a base of this object.
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

/// Checks that at most one thread at a time uses an object; this may be any thread. Use as a member of the object. A
/// copy of the object starts as not in use.
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
