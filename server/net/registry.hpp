#pragma once
// The connections that are open, so that they can be counted and asked to end.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>

namespace oval4d::net {

/// Every function may be called from any thread.
class Registry {
  public:
    /// One place in the registry, given back when it is destroyed.
    class Place {
      public:
        explicit Place(Registry& registry);
        Place(const Place&) = delete;
        Place& operator=(const Place&) = delete;
        ~Place();

        /// How this connection is asked to end; called from any thread, at once if all have been asked already.
        void onStop(std::function<void()> stop);

      private:
        Registry& registry_;
        std::uint64_t number_;
    };

    std::size_t size() const;
    void stopAll();

  private:
    mutable std::mutex mutex_;
    std::map<std::uint64_t, std::function<void()>> stops_;  // guarded by mutex_
    std::uint64_t last_ = 0;                                // guarded by mutex_
    bool stopping_ = false;                                 // guarded by mutex_
};

}  // namespace oval4d::net
