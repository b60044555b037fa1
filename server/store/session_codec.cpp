#include "store/session_codec.hpp"

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "store/cbor.hpp"
#include "store/member_codec.hpp"
#include "store/object_list.hpp"
#include "store/state_codec.hpp"

// A session is encoded as two CBOR arrays, called the whole and the head. The whole has the members of the session; the
// index of a member is the number that visitStoredMembers() in session/session.hpp gives it. Index 0 contains the
// version, and index 2 the list of objects. The head has only four elements: version, revision, list of objects,
// current state. Arrays with members that this version does not know are refused.

namespace oval4d::store {

using nlohmann::json;
using session::Session;
using session::State;

namespace {

constexpr std::size_t kVersion = 0, kObjects = 2;  // the indices of elements that are not members of the session
constexpr std::size_t kHeadMembers = 4;

constexpr std::uint64_t kMaxRevision = 1ULL << 53U;  // 2^53; JSON readers represent integers up to this number exactly

/// A list of states, such as the undo steps or the redo steps.
template <typename T>
concept StateList = std::same_as<typename T::value_type, State>;

/// A visitor that finds the number of elements of the array that encodes a whole session.
class SessionMemberCounter {
  public:
    template <typename T>
    void member(std::size_t number, const T& /*value*/) {
        count_ = std::max(count_, number + 1);
    }
    template <typename T>
    void memberAddedLater(std::size_t number, const T& value) {
        member(number, value);
    }
    std::size_t count() const { return count_; }

  private:
    std::size_t count_ = 0;
};

std::size_t memberCountOf(const Session& session) {
    SessionMemberCounter counter;
    visitStoredMembers(session, counter);
    return counter.count();
}

/// A visitor that writes the first `size` elements of a session record. Of each list of states, writes only the last
/// `maxHistory` states.
class SessionWriter : public MemberWriter {
  public:
    SessionWriter(std::size_t size, std::size_t maxHistory, const ObjectKeyLookup& keyOf)
        : size_(size), maxHistory_(maxHistory), objects_(keyOf) {}

    template <typename T>
    void member(std::size_t number, const T& value) {
        if (number < size_) put(number, encoded(value));
    }
    template <typename T>
    void memberAddedLater(std::size_t number, const T& value) {
        member(number, value);
    }

    /// Returns the record. Called after all members have been visited.
    json takeRecord() {
        put(kVersion, kRecordVersion);
        put(kObjects, objects_.encodedList());
        return takeArray();
    }

  private:
    static json encoded(const std::string& text) { return text; }
    static json encoded(const std::uint64_t& number) { return number; }
    json encoded(const State& state) { return encodeState(state, objects_); }
    json encoded(const StateList auto& states) {
        json list = json::array();
        for (std::size_t i = states.size() - std::min(states.size(), maxHistory_); i < states.size(); ++i)
            list.push_back(encodeState(states[i], objects_));
        return list;
    }
    json encoded(const session::LoadedObjects& loaded) {
        json list = json::array();
        for (const auto& [name, object] : loaded) list.push_back({name, objects_.findOrAddObject(object)});
        return list;
    }

    const std::size_t size_, maxHistory_;
    ObjectListEncoder objects_;
};

/// A visitor that reads the members of a session among the first `size` elements of its record. `objects` decodes the
/// list of objects, which states and loaded objects need; it may be null if there are none among these elements.
class SessionReader : public MemberReader {
  public:
    SessionReader(const json& record, std::size_t size, ObjectListDecoder* objects)
        : MemberReader(record), size_(size), objects_(objects) {}

    template <typename T>
    void member(std::size_t number, T& value) {
        if (number < size_) decode(at(number), value);
    }
    template <typename T>
    void memberAddedLater(std::size_t number, T& value) {
        if (has(number)) member(number, value);
    }

  private:
    static void decode(const json& value, std::string& into) { into = readShortText(value); }
    static void decode(const json& value, std::uint64_t& into) {
        into = readInteger<std::uint64_t>(value);
        if (into > kMaxRevision) throwUnreadableRecord("the revision is out of range");
    }
    void decode(const json& value, State& into) const { into = decodeState(value, *objects_); }
    void decode(const json& value, StateList auto& into) const {
        for (const json& state : value) into.push_back(decodeState(state, *objects_));
    }
    void decode(const json& value, session::LoadedObjects& into) const {
        for (const json& own : value) {
            refuseUnknownMembers(own, 2);
            into[readShortText(own.at(0))] = objects_->at(own.at(1));
        }
    }

    const std::size_t size_;
    ObjectListDecoder* const objects_;
};

std::string encoded(const Session& session, std::size_t size, std::size_t maxHistory, const ObjectKeyLookup& keyOf) {
    SessionWriter writer(size, maxHistory, keyOf);
    visitStoredMembers(session, writer);
    return encodeCbor(writer.takeRecord());
}

void decodeInto(Session& session, const json& record, std::size_t size, ObjectListDecoder* objects) {
    SessionReader reader(record, size, objects);
    visitStoredMembers(session, reader);
}

}  // namespace

std::string encodeHead(const Session& session, const ObjectKeyLookup& keyOf) {
    return encoded(session, kHeadMembers, 0, keyOf);
}

std::string encodeWhole(const Session& session, std::size_t maxUndo, const ObjectKeyLookup& keyOf) {
    return encoded(session, memberCountOf(session), maxUndo, keyOf);
}

Session decodeSession(std::string_view whole, std::string_view head, const ObjectLookup& objectOf,
                      polytopes::PolytopeCache& cache) {
    return callTranslatingErrors([&] {
        const json value = parseRecord(whole);
        Session session;
        const std::size_t size = memberCountOf(session);
        refuseUnknownMembers(value, size);
        ObjectListDecoder objects(value.at(kObjects), objectOf, cache);
        decodeInto(session, value, size, &objects);
        if (head.empty()) return session;
        const json newerValue = parseRecord(head);
        refuseUnknownMembers(newerValue, kHeadMembers);
        Session newer;
        decodeInto(newer, newerValue, kObjects, nullptr);  // reads only the revision, the element before kObjects
        if (newer.revision <= session.revision) return session;
        ObjectListDecoder newerObjects(newerValue.at(kObjects), objectOf, cache);
        decodeInto(newer, newerValue, kHeadMembers, &newerObjects);
        session.undoSteps.push_back(std::move(session.current));
        session.redoSteps.clear();
        session.current = std::move(newer.current);
        session.revision = newer.revision;
        session.pendingKey.clear();
        return session;
    });
}

}  // namespace oval4d::store
