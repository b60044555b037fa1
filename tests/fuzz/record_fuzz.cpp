// Fuzzes stored sessions. The input has three parts: the full record, the head and one object. Before each part is its
// length in two bytes (little-endian). Decoding must throw UnreadableRecord, or return a valid session that can be
// sliced, sent and stored again.

#include "store/object_codec.hpp"
#include "store/session_codec.hpp"
#include "support.hpp"

using namespace oval4d;
using fuzz::require;

namespace {

std::string_view takePart(std::string_view& rest) {
    if (rest.size() < 2) return {};
    const std::size_t length = static_cast<unsigned char>(rest[0]) + 256U * static_cast<unsigned char>(rest[1]);
    rest.remove_prefix(2);
    const std::string_view part = rest.substr(0, length);
    rest.remove_prefix(part.size());
    return part;
}

/// Returns whether a record names a polytope that takes long to build.
bool namesLarge(std::string_view record) {
    try {
        const auto value = nlohmann::json::from_cbor(record);
        return std::ranges::any_of(value.at(2), [](const auto& entry) {
            return entry.size() == 1 && !fuzz::isSmall(entry.at(0).template get_ref<const std::string&>());
        });
    } catch (const nlohmann::json::exception&) {
        return false;
    }
}

void requireUsable(const session::Session& session) {
    session::Limits wide;
    wide.maxSlices = 100'001;
    wide.maxUndo = wide.maxLoaded = 1'000'000;
    fuzz::requireSound(session, wide);
    fuzz::requireHistory(session);
    fuzz::requireSlices(session.current);
    fuzz::requireJson(wire::stateMessage(session.current, {}, session.revision));
    for (const auto& [name, object] : session.loaded)
        fuzz::requireJson(wire::catalogueMessage({}, std::vector{object}));
    for (const char* key : {"y", "l", "G", "}", "u"}) {
        session::Session next = session;
        session::ObjectLoader loader(wide, fuzz::cache());
        (void)session::apply(next, session::KeyPress{key}, wide, loader);
        fuzz::requireSound(next.current, wide);
    }
}

}  // namespace

OVAL4D_FUZZER(record) {
    std::string_view rest = fuzz::textOf(data, size);
    const std::string_view whole = takePart(rest);
    const std::string_view head = takePart(rest);
    std::optional<slicing::Object> own;
    try {
        own = store::decodeObjectRecord(rest);
        const std::string bytes = store::encodeObjectRecord(*own);
        require(store::encodeObjectRecord(store::decodeObjectRecord(bytes)) == bytes, "an object survives being kept");
        fuzz::requireJson(wire::catalogueMessage({}, std::vector{*own}));
    } catch (const store::UnreadableRecord& fault) {
        require(*fault.what() != 0, "what is unreadable says why");
    }
    if (namesLarge(whole) || namesLarge(head)) return 0;
    try {
        const store::ObjectLookup objectOf = [&](const std::string&) { return own; };
        const store::ObjectKeyLookup keyOf = [](const slicing::Object&) { return "key"; };
        const session::Session session = store::decodeSession(whole, head, objectOf, fuzz::cache());
        requireUsable(session);
        const std::string bytes = store::encodeWhole(session, 1'000'000, keyOf);
        require(store::decodeSession(bytes, "", objectOf, fuzz::cache()) == session, "a session survives being kept");
        const std::string present = store::encodeHead(session, keyOf);
        require(store::decodeSession(bytes, present, objectOf, fuzz::cache()) == session,
                "a head that is no newer changes nothing");
    } catch (const store::UnreadableRecord& fault) {
        require(*fault.what() != 0, "what is unreadable says why");
    }
    return 0;
}
