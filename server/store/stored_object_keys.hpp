#pragma once
// Remembers which objects of each session are in the store, so that each object is written only once.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "store/cached_sessions.hpp"
#include "store/store.hpp"

namespace oval4d::store {

/// The keys under which a session's objects are stored. The index of the map is ObjectInfo::serial, the number of the
/// object in this process.
using KeysBySerial = std::map<std::uint64_t, std::string>;

/// A table of the objects of each session: the key of each object, and whether the store has the object. Not
/// thread-safe.
class StoredObjectKeys {
  public:
    /// Records that the store has these objects of a session, and no others.
    void setStored(const std::string& session, const KeysBySerial& keys);

    /// Encodes the changes of a session. Sets `update.head`, `update.changed` and `update.whole`, which contains at
    /// most `maxUndo` undo steps and `maxUndo` redo steps. Adds to `update.objects` the objects that the store lacks.
    /// If the whole session is written, also adds to `update.dropped` the keys of the objects that the session no
    /// longer contains. Returns the serial numbers of the objects in `update.objects`.
    std::vector<std::uint64_t> encodeChanges(const std::string& session, const PendingChanges& changes,
                                             std::size_t maxUndo, RecordUpdate& update);

    /// Records that the store has saved `update`. encodeChanges() must have made `update`, and returned `added`.
    void recordSaved(const std::string& session, const std::vector<std::uint64_t>& added, const RecordUpdate& update);

    /// markObjectsLost() records that the store has lost the objects of a session. markAllObjectsLost() records this
    /// for all sessions. The next updates then contain the objects again.
    void markObjectsLost(const std::string& session);
    void markAllObjectsLost();

    /// Removes a session from this table.
    void forget(const std::string& session) { sessions_.erase(session); }

  private:
    struct ObjectKeyState {
        std::string key;
        bool stored = false;
    };
    using ObjectKeyStates = std::map<std::uint64_t, ObjectKeyState>;  // the key is ObjectInfo::serial

    std::map<std::string, ObjectKeyStates, std::less<>> sessions_;
};

}  // namespace oval4d::store
