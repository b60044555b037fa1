#pragma once
// Assertions that an object is used only by the threads that may use it. They do nothing in builds with NDEBUG (release
// builds).

#include <atomic>
#include <cassert>
#include <thread>

namespace oval4d::parallel {

/// Checks that an object is used only by the thread that constructed it. Use as a member or base of that object.
class ThreadOwned {
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

/// Checks that an object is used by at most one thread at a time, which may be any thread. A copy of it starts as not
/// in use.
class ExclusiveUse {
  public:
    /// Marks the object as in use as long as this Use exists. The constructor asserts that no other Use of the same
    /// object exists.
    class Use {
      public:
#ifdef NDEBUG
        explicit Use(ExclusiveUse& /*used*/) {}
#else
        explicit Use(ExclusiveUse& used) : used_(used) {
            const bool alone = !used_.inUse_.exchange(true);
            assert(alone && "used by two threads at once");
            (void)alone;
        }
        ~Use() { used_.inUse_ = false; }
        Use(const Use&) = delete;
        Use& operator=(const Use&) = delete;

      private:
        ExclusiveUse& used_;
#endif
    };

#ifndef NDEBUG
    ExclusiveUse() = default;
    ExclusiveUse(const ExclusiveUse& /*other*/) {}
    ExclusiveUse& operator=(const ExclusiveUse& /*other*/) { return *this; }

  private:
    std::atomic<bool> inUse_ = false;
#endif
};

}  // namespace oval4d::parallel
