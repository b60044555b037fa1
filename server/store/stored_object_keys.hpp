#pragma once
// Records which objects of each session are in the store, so that an object is written only once.

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

/// The keys of the objects of each session, and for each object whether the store has it. Not thread-safe.
class StoredObjectKeys {
  public:
    /// Records that the store has exactly these objects of a session.
    void setStored(const std::string& session, const KeysBySerial& keys);

    /// Encodes changes of a session: sets `update.head`, `update.whole` (with at most `maxUndo` undo steps and at most
    /// `maxUndo` redo steps) and `update.changed`. Adds the records of the objects that the store lacks to
    /// `update.objects`. If the whole session is written, adds the keys of the objects that it no longer contains to
    /// `update.dropped`. Returns the serial numbers of the added objects.
    std::vector<std::uint64_t> encode(const std::string& session, const PendingChanges& changes, std::size_t maxUndo,
                                      RecordUpdate& update);

    /// Records that the store has saved `update`, which encode() had filled in. `added`: the result of encode().
    void recordSaved(const std::string& session, const std::vector<std::uint64_t>& added, const RecordUpdate& update);

    /// These functions record that the store has lost the objects of this session, or of all sessions. The next updates
    /// then contain the objects again.
    void markObjectsLost(const std::string& session);
    void markAllObjectsLost();

    /// Forgets a session.
    void forget(const std::string& session) { sessions_.erase(session); }

  private:
    struct ObjectKeyState {
        std::string key;
        bool stored = false;
    };
    using ObjectKeyStates = std::map<std::uint64_t, ObjectKeyState>;  // by ObjectInfo::serial

    std::map<std::string, ObjectKeyStates, std::less<>> sessions_;
};

}  // namespace oval4d::store
