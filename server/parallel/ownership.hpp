#pragma once
// Checks, in debug and sanitizer builds, that objects are used by the threads that they belong to. In release builds
// they are empty.

#include <atomic>
#include <cassert>
#include <thread>

namespace oval4d::parallel {

/// Belongs to the thread that constructs it.
class ThreadOwned {
  public:
#ifdef NDEBUG
    void assertOwner() const {}
#else
    void assertOwner() const {
        assert(std::this_thread::get_id() == owner_ && "used by a thread that does not own it");
    }

  private:
    std::thread::id owner_ = std::this_thread::get_id();
#endif
};

/// May be used by any thread, but by one at a time. Copies and moves are unused.
class OneAtATime {
  public:
    /// A use, for the lifetime of this object.
    class Use {
      public:
#ifdef NDEBUG
        explicit Use(OneAtATime& /*used*/) {}
#else
        explicit Use(OneAtATime& used) : used_(used) {
            const bool alone = !used_.inUse_.exchange(true);
            assert(alone && "used by two threads at once");
            (void)alone;
        }
        ~Use() { used_.inUse_ = false; }
        Use(const Use&) = delete;
        Use& operator=(const Use&) = delete;

      private:
        OneAtATime& used_;
#endif
    };

#ifndef NDEBUG
    OneAtATime() = default;
    OneAtATime(const OneAtATime& /*other*/) {}
    OneAtATime& operator=(const OneAtATime& /*other*/) { return *this; }

  private:
    std::atomic<bool> inUse_ = false;
#endif
};

}  // namespace oval4d::parallel
