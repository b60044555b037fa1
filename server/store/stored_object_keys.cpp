#include "store/stored_object_keys.hpp"

#include <algorithm>
#include <set>

#include "store/object_codec.hpp"
#include "store/secret.hpp"
#include "store/session_codec.hpp"

namespace oval4d::store {

void StoredObjectKeys::setStored(const std::string& session, const KeysBySerial& keys) {
    ObjectKeyStates& objects = sessions_[session];
    objects.clear();
    for (const auto& [serial, key] : keys) objects[serial] = {key, true};
}

std::vector<std::uint64_t> StoredObjectKeys::encodeChanges(const std::string& session, const PendingChanges& changes,
                                                           std::size_t maxUndo, RecordUpdate& update) {
    constexpr std::size_t kKeyBytes = 10;
    ObjectKeyStates& objects = sessions_[session];
    std::vector<std::uint64_t> added;
    std::set<std::uint64_t> used;
    const ObjectKeyLookup keyOf = [&](const slicing::Object& object) {
        const std::uint64_t serial = slicing::infoOf(object).serial;
        auto& [key, stored] = objects[serial];
        if (key.empty()) key = randomName(kKeyBytes);
        if (used.insert(serial).second && !stored) {
            update.objects.emplace_back(key, encodeObjectRecord(object));
            added.push_back(serial);
        }
        return key;
    };
    const auto& [head, whole, waiting] = changes;
    if (whole) update.whole = encodeWhole(*whole, maxUndo, keyOf);
    if (head && (!whole || head->revision > whole->revision)) update.head = encodeHead(*head, keyOf);
    update.changed = (head && head->revision > 0) || (whole && whole->revision > 0);
    if (whole) {
        for (const auto& [serial, object] : objects) {
            if (!used.contains(serial)) update.dropped.push_back(object.key);
        }
    }
    return added;
}

void StoredObjectKeys::recordSaved(const std::string& session, const std::vector<std::uint64_t>& added,
                                   const RecordUpdate& update) {
    ObjectKeyStates& objects = sessions_[session];
    for (const std::uint64_t serial : added) objects[serial].stored = true;
    std::erase_if(objects, [&](const auto& entry) {
        return std::ranges::find(update.dropped, entry.second.key) != update.dropped.end();
    });
}

void StoredObjectKeys::markObjectsLost(const std::string& session) {
    for (auto& [serial, object] : sessions_[session]) object.stored = false;
}

void StoredObjectKeys::markAllObjectsLost() {
    for (auto& [session, objects] : sessions_) {
        for (auto& [serial, object] : objects) object.stored = false;
    }
}

}  // namespace oval4d::store
