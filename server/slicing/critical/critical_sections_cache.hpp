#pragma once
// A cache of the results of findCriticalSections().

#include <cstddef>
#include <cstdint>
#include <list>
#include <mutex>

#include "geometry/rotation.hpp"
#include "slicing/critical/critical_sections.hpp"
#include "slicing/field_settings.hpp"
#include "slicing/object.hpp"

namespace oval4d::slicing {

/// Keeps the most recently used results of findCriticalSections(), up to a memory limit. Thread-safe.
class CriticalSectionsCache {
  public:
    /// `bytes` is the maximum memory of the results in the cache.
    explicit CriticalSectionsCache(std::size_t bytes) : maxBytes_(bytes) {}

    /// Returns the result for these arguments of findCriticalSections(), or null if it is not in the cache.
    CriticalSectionsPtr find(const Object& object, const geometry::Rotation& orientation,
                             const FieldSettings& settings);

    /// Adds the result for these arguments of findCriticalSections(). Does nothing if the memory of this result exceeds
    /// the limit.
    void add(const Object& object, const geometry::Rotation& orientation, const FieldSettings& settings,
             CriticalSectionsPtr result);

    /// Returns the memory of the results in the cache, in bytes. It never exceeds the limit.
    std::size_t bytes() const;

  private:
    // The arguments of findCriticalSections() that determine its result.
    struct SearchArguments {
        std::uint64_t object;  // the serial number of the object
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
    std::list<CachedSections> recent_;  // the most recently used entry first
    std::size_t bytes_ = 0;
};

}  // namespace oval4d::slicing
