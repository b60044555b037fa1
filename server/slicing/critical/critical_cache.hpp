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
class CriticalCache {
  public:
    /// `bytes` is the maximum memory of the results in the cache.
    explicit CriticalCache(std::size_t bytes) : maxBytes_(bytes) {}

    /// Returns the result for these arguments of findCriticalSections(), or null if it is not in the cache.
    CriticalPtr find(const Object& object, const geometry::Rotation& orientation, const FieldSettings& settings);

    /// Adds the result for these arguments of findCriticalSections(). Does nothing if the memory of this result exceeds
    /// the limit.
    void add(const Object& object, const geometry::Rotation& orientation, const FieldSettings& settings,
             CriticalPtr result);

    /// Returns the memory of the results in the cache, in bytes. It never exceeds the limit.
    std::size_t bytes() const;

  private:
    struct Key {
        std::uint64_t object;  // the serial number of the object
        geometry::Rotation orientation;
        FieldSettings settings;
        bool operator==(const Key&) const = default;
    };
    struct Entry {
        Key key;
        CriticalPtr result;
        std::size_t bytes;
    };

    const std::size_t maxBytes_;
    mutable std::mutex mutex_;  // guards the members below
    std::list<Entry> recent_;   // the most recently used entry first
    std::size_t bytes_ = 0;
};

}  // namespace oval4d::slicing
