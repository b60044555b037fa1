#pragma once
// A cache of results of findCriticalSections(): the critical values of w of objects.

#include <cstddef>
#include <cstdint>
#include <list>
#include <mutex>

#include "geometry/rotation.hpp"
#include "slicing/critical/critical_sections.hpp"
#include "slicing/field_settings.hpp"
#include "slicing/object.hpp"

namespace oval4d::slicing {

/// Keeps the most recently used results of findCriticalSections(), up to a limit on their memory. Thread-safe.
class CriticalSectionsCache {
  public:
    /// Creates an empty cache. `bytes` is the maximum memory of the results in the cache.
    explicit CriticalSectionsCache(std::size_t bytes) : maxBytes_(bytes) {}

    /// Returns the result of findCriticalSections() for this object, orientation and settings, or null if the result is
    /// not in the cache.
    CriticalSectionsPtr find(const Object& object, const geometry::Rotation& orientation,
                             const FieldSettings& settings);

    /// Adds `result`, the result of findCriticalSections() for this object, orientation and settings. Removes the least
    /// recently used results if all together exceed the limit. Does nothing if `result` alone exceeds it.
    void add(const Object& object, const geometry::Rotation& orientation, const FieldSettings& settings,
             CriticalSectionsPtr result);

    /// Returns the memory of the results in the cache, in bytes. The memory never exceeds the limit.
    std::size_t bytes() const;

  private:
    // The arguments of findCriticalSections() that determine its result.
    struct SearchArguments {
        std::uint64_t object;  // the serial number of the object: ObjectInfo::serial
        geometry::Rotation orientation;
        FieldSettings settings;
        bool operator==(const SearchArguments&) const = default;
    };
    struct CachedSections {
        SearchArguments arguments;
        CriticalSectionsPtr result;
        std::size_t bytes;
    };

    const std::size_t maxBytes_;
    mutable std::mutex mutex_;          // guards the members below
    std::list<CachedSections> recent_;  // all entries, the most recently used entry first
    std::size_t bytes_ = 0;
};

}  // namespace oval4d::slicing
