#pragma once
// Keeps account of which objects of which sessions are in the store, so that an object is written only once.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "store/cached_sessions.hpp"
#include "store/store.hpp"

namespace oval4d::store {

/// The keys under which a session's objects are stored, by ObjectInfo::serial.
using KeysBySerial = std::map<std::uint64_t, std::string>;

/// The keys of the objects of each session, and whether the store has them. Not thread-safe.
class StoredObjects {
  public:
    /// Records that the store has exactly these objects of a session.
    void setStored(const std::string& session, const KeysBySerial& keys);

    /// Encodes changes of a session as `update.head`, `update.whole` and `update.changed`, with at most `maxUndo` undo
    /// steps. Adds the records of the objects that the store lacks to `update.objects`, and the keys of those that the
    /// whole session no longer contains to `update.dropped`. Returns the serial numbers of the added objects.
    std::vector<std::uint64_t> encode(const std::string& session, const PendingChanges& changes, std::size_t maxUndo,
                                      RecordUpdate& update);

    /// Records that an update of a session, whose added objects were `added`, has been saved.
    void saved(const std::string& session, const std::vector<std::uint64_t>& added, const RecordUpdate& update);

    /// Records that the store has no objects of this session, or of any, so that they are written again.
    void markLost(const std::string& session);
    void markAllLost();

    /// Forgets a session.
    void forget(const std::string& session) { sessions_.erase(session); }

  private:
    struct Object {
        std::string key;
        bool stored = false;
    };
    using Objects = std::map<std::uint64_t, Object>;  // by ObjectInfo::serial

    std::map<std::string, Objects, std::less<>> sessions_;
};

}  // namespace oval4d::store
