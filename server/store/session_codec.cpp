#include "store/session_codec.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "store/cbor.hpp"
#include "store/object_list.hpp"
#include "store/state_codec.hpp"

// A session is encoded as two CBOR arrays: the head [version, revision, objects, current state], and the whole, which
// has four more members: [version, revision, objects, current state, undo steps, redo steps, loaded objects, pending
// key]. New versions may add members only at the end of an array. A version refuses arrays with members that it
// does not know.

namespace oval4d::store {

using nlohmann::json;
using session::Session;

namespace {

constexpr std::size_t kHeadMembers = 4, kWholeMembers = 8;

constexpr std::uint64_t kMaxRevision = 1ULL << 53U;  // 2^53: JSON readers represent integers exactly up to this one

std::uint64_t revisionIn(const json& value) {
    const auto revision = readInteger<std::uint64_t>(value);
    if (revision > kMaxRevision) throwUnreadable("the revision is out of range");
    return revision;
}

/// Returns the encoding of the last `maxCount` states, or of all states if there are fewer.
template <typename States>
json history(const States& states, std::size_t maxCount, ObjectListEncoder& objects) {
    json list = json::array();
    for (std::size_t i = states.size() - std::min(states.size(), maxCount); i < states.size(); ++i) {
        list.push_back(encodeState(states[i], objects));
    }
    return list;
}

}  // namespace

std::string encodeHead(const Session& session, const ObjectKeyLookup& keyOf) {
    ObjectListEncoder objects(keyOf);
    json current = encodeState(session.current, objects);
    return encodeCbor({kRecordVersion, session.revision, objects.list(), std::move(current)});
}

std::string encodeWhole(const Session& session, std::size_t maxUndo, const ObjectKeyLookup& keyOf) {
    const auto& [current, undoSteps, redoSteps, loaded, pendingKey, revision] = session;
    ObjectListEncoder objects(keyOf);
    json state = encodeState(current, objects);
    json before = history(undoSteps, maxUndo, objects);
    json after = history(redoSteps, maxUndo, objects);
    json own = json::array();
    for (const auto& [name, object] : loaded) own.push_back({name, objects.findOrAddObject(object)});
    return encodeCbor({kRecordVersion, revision, objects.list(), std::move(state), std::move(before), std::move(after),
                       std::move(own), pendingKey});
}

Session decodeSession(std::string_view whole, std::string_view head, const ObjectLookup& objectOf,
                      polytopes::PolytopeCache& cache) {
    return callTranslatingErrors([&] {
        const json value = parseRecord(whole);
        refuseUnknownMembers(value, kWholeMembers);
        ObjectListDecoder objects(value.at(2), objectOf, cache);
        Session session;
        session.revision = revisionIn(value.at(1));
        session.current = decodeState(value.at(3), objects);
        for (const json& state : value.at(4)) session.undoSteps.push_back(decodeState(state, objects));
        for (const json& state : value.at(5)) session.redoSteps.push_back(decodeState(state, objects));
        for (const json& own : value.at(6)) session.loaded[readShortText(own.at(0))] = objects.at(own.at(1));
        session.pendingKey = readShortText(value.at(7));
        if (head.empty()) return session;
        const json newer = parseRecord(head);
        refuseUnknownMembers(newer, kHeadMembers);
        const auto revision = revisionIn(newer.at(1));
        if (revision <= session.revision) return session;
        session.undoSteps.push_back(std::move(session.current));
        session.redoSteps.clear();
        ObjectListDecoder newerObjects(newer.at(2), objectOf, cache);
        session.current = decodeState(newer.at(3), newerObjects);
        session.revision = revision;
        session.pendingKey.clear();
        return session;
    });
}

}  // namespace oval4d::store
