#include "store/codec.hpp"

#include <algorithm>
#include <concepts>
#include <limits>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "polytopes/catalogue/catalogue.hpp"
#include "session/settings.hpp"
#include "store/cbor.hpp"
#include "text/message_text.hpp"

// A session is encoded as a CBOR array, [version, …]. A state is encoded as an array, too, and refers to its object by
// an index into the session's list of objects. Structured bindings name every member of an encoded struct, so that a
// new member breaks the build until it is encoded here.

namespace oval4d::store {

using nlohmann::json;
using session::Session;
using session::State;

namespace {

// Limits on decoded values, far above those that the server enforces for clients. Without them, a damaged record could
// produce, for example, a state with a million slices instead of an error.
constexpr int kMaxSlices = 100'001;
constexpr std::size_t kMaxVertices = 1'000'000;  // of one polytope
// The maximum for all objects of a session that are built from their names, together with all images: a few bytes of a
// record can request large objects.
constexpr std::size_t kMaxTotalVertices = 10'000'000;
constexpr std::uint64_t kMaxRevision = 1ULL << 53U;  // JSON readers represent integers exactly up to this one

std::uint64_t revisionIn(const json& value) {
    const auto revision = readInteger<std::uint64_t>(value);
    if (revision > kMaxRevision) throwUnreadable("the revision is out of range");
    return revision;
}

template <text::HasChoices Enum>
Enum enumeratorIn(const json& value) {
    const auto number = readInteger<unsigned>(value);
    for (const auto& choice : choicesOf(Enum{})) {
        if (static_cast<unsigned>(choice.value) == number) return choice.value;
    }
    throwUnreadable("an enumerator is out of range: " + std::to_string(number));
}

json quaternion(const glm::dquat& q) { return {q.w, q.x, q.y, q.z}; }

glm::dquat quaternionIn(const json& value) {
    return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>(), value.at(3).get<double>()};
}

// --- Objects

/// Returns the polytope with this name, and subtracts its number of vertices from `vertexBudget`. Throws
/// UnreadableRecord if the budget is too small.
slicing::Object rebuilt(const std::string& name, polytopes::PolytopeCache& cache, std::size_t& vertexBudget) {
    const auto named = polytopes::designNamed(name, kMaxVertices);
    const auto* design = std::get_if<polytopes::Design>(&named);
    if (design == nullptr) throwUnreadable("the catalogue has no polytope called " + text::inQuotes(name));
    const std::size_t vertices = polytopes::elementCounts(*design).vertices;
    if (vertices > vertexBudget) throwUnreadable("its polytopes have too many vertices");
    vertexBudget -= vertices;
    try {
        return cache.get(*design);
    } catch (const std::invalid_argument& fault) {
        throwUnreadable("a polytope cannot be built: " + std::string(fault.what()));
    }
}

/// Collects the objects of a session in a list without duplicates, and numbers them.
class ObjectTable {
  public:
    explicit ObjectTable(const ObjectKeyLookup& keyOf) : keyOf_(keyOf) {}

    std::size_t number(const slicing::Object& object) {
        const auto [found, isNew] = numbers_.try_emplace(slicing::identityOf(object), list.size());
        if (isNew) {
            // An entry is [name] for an object that is built from its name, and [name, key] for any other object.
            const geometry::ObjectInfo& info = slicing::infoOf(object);
            json entry = json::array({info.name});
            if (!info.rebuildableFromName) entry.push_back(keyOf_(object));
            list.push_back(std::move(entry));
        }
        return found->second;
    }

    json list = json::array();

  private:
    const ObjectKeyLookup& keyOf_;
    std::map<const void*, std::size_t> numbers_;
};

/// The objects of a decoded session, and the images of them that its states show.
class ObjectList {
  public:
    ObjectList(const json& list, const ObjectLookup& objectOf, polytopes::PolytopeCache& cache) {
        for (const json& entry : list) {
            if (entry.size() == 1) {
                objects_.push_back(rebuilt(readShortText(entry.at(0)), cache, vertexBudget_));
            } else if (auto object = objectOf(readShortText(entry.at(1)))) {
                objects_.push_back(std::move(*object));
            } else {
                throwUnreadable("an object is missing");
            }
        }
    }

    const slicing::Object& at(const json& number) const {
        const auto index = readInteger<std::size_t>(number);
        if (index >= objects_.size()) throwUnreadable("an object is missing");
        return objects_[index];
    }

    /// Returns the image of an object in `frame`; the same one for all states that show it.
    slicing::Object imageOf(const slicing::Object& source, const geometry::ReferenceFrame& frame) {
        if (frame == geometry::ReferenceFrame{}) return source;
        const auto known = std::ranges::find_if(
            images_, [&](const Image& image) { return image.source == source && image.frame == frame; });
        if (known != images_.end()) return known->image;
        const std::size_t vertices = slicing::elementCounts(source)[0];
        if (vertices > vertexBudget_) throwUnreadable("its objects have too many vertices");
        vertexBudget_ -= vertices;
        images_.push_back({source, frame, slicing::imageOf(source, frame)});
        return images_.back().image;
    }

  private:
    struct Image {
        slicing::Object source;
        geometry::ReferenceFrame frame;
        slicing::Object image;
    };
    std::size_t vertexBudget_ = kMaxTotalVertices;
    std::vector<slicing::Object> objects_;
    std::vector<Image> images_;
};

// --- Parts of a state

// Spacing, offset and focus point are limited in proportion to the circumradius. Because of rounding errors, they may
// exceed these limits by this fraction.
constexpr double kSlack = 1e-9;

// A turn in one plane, or in two that are perpendicular, has the form [plane, angle, angle or null] that earlier
// versions read, too. Others are lists of pairs [[plane, angle], …].
json encoded(const std::optional<geometry::Turn>& turn) {
    if (!turn) return nullptr;
    const std::vector<geometry::Plane> planes = turn->planes();
    const geometry::Plane first = planes.at(0);
    if (planes.size() == 1 || (planes.size() == 2 && planes[1] == geometry::perpendicular(first))) {
        const auto& second = (*turn)[geometry::perpendicular(first)];
        return {static_cast<unsigned>(first), *(*turn)[first], second ? json(*second) : json()};
    }
    json pairs = json::array();
    for (const geometry::Plane plane : planes)
        pairs.push_back(json::array({static_cast<unsigned>(plane), *(*turn)[plane]}));
    return pairs;
}

geometry::Plane planeIn(const json& value) {
    const auto number = readInteger<unsigned>(value);
    if (number >= geometry::kPlanes.size()) throwUnreadable("there is no plane " + std::to_string(number));
    return geometry::kPlanes[number];
}

std::optional<geometry::Turn> turnIn(const json& value) {
    if (value.is_null()) return std::nullopt;
    geometry::Turn turn;
    if (value.at(0).is_array()) {
        for (const json& pair : value) turn[planeIn(pair.at(0))] = readNumber(pair.at(1), session::kMaxAngle);
    } else {
        const geometry::Plane plane = planeIn(value.at(0));
        turn = {plane, readNumber(value.at(1), session::kMaxAngle)};
        if (!value.at(2).is_null()) turn[geometry::perpendicular(plane)] = readNumber(value.at(2), session::kMaxAngle);
    }
    return turn;
}

json encoded(const std::optional<session::OngoingTurnToward>& ongoingTurnToward) {
    if (!ongoingTurnToward) return nullptr;
    const auto& [goal, seconds] = *ongoingTurnToward;
    return {quaternion(goal.left()), quaternion(goal.right()), seconds};
}

geometry::Rotation rotationIn(const json& left, const json& right) {
    const auto rotation = geometry::Rotation::fromQuaternions(quaternionIn(left), quaternionIn(right));
    if (!rotation) throwUnreadable("an orientation is not a rotation");
    return *rotation;
}

std::optional<session::OngoingTurnToward> ongoingTurnTowardIn(const json& value) {
    if (value.is_null()) return std::nullopt;
    return session::OngoingTurnToward{
        rotationIn(value.at(0), value.at(1)),
        readNumber(value.at(2), std::numeric_limits<double>::min(), session::kMaxTurnTowardSeconds)};
}

json encoded(const slicing::FieldSettings& settings) {
    const auto& [levels, inside, fog] = settings;
    json points = json::array();
    for (const auto& [value, opacity, color] : fog) points.push_back({value, opacity, color ? json(*color) : json()});
    return {levels, static_cast<unsigned>(inside), std::move(points)};
}

json encoded(const scene::Look& look) {
    const auto& [view, parts, orbit, coloring, cellTypes, projection, highlight, focusPoint, field, caps, background] =
        look;
    const auto& [azimuth, elevation, zoom] = orbit;
    const auto& [hidden, faded] = cellTypes;
    json flags = json::array();
    for (const scene::NamedPart& part : scene::kParts) flags.push_back(parts.*part.flag);
    const auto& [kind, eye] = projection;
    return {static_cast<unsigned>(view),
            std::move(flags),
            {azimuth, elevation, zoom},
            static_cast<unsigned>(coloring),
            hidden,
            faded,
            static_cast<unsigned>(kind),
            eye,
            highlight ? json({static_cast<unsigned>(highlight->kind), highlight->index}) : json(),
            {focusPoint.x, focusPoint.y, focusPoint.z},
            encoded(field),
            static_cast<unsigned>(caps),
            static_cast<unsigned>(background)};
}

/// A record written by an earlier version of the program has fewer flags; the other parts keep their defaults.
scene::Parts partsIn(const json& value) {
    scene::Parts parts;
    for (std::size_t i = 0; i < std::min(value.size(), scene::kParts.size()); ++i)
        parts.*scene::kParts[i].flag = value.at(i).get<bool>();
    return parts;
}

std::vector<std::uint32_t> cellTypesIn(const json& value, std::size_t count) {
    std::vector<std::uint32_t> kinds = readIntegers(value);
    const auto unsorted = std::ranges::adjacent_find(kinds, std::greater_equal<>());
    if (unsorted != kinds.end() || (!kinds.empty() && kinds.back() >= count))
        throwUnreadable("the hidden or faded cell types are not in order or out of range");
    return kinds;
}

std::optional<slicing::Element> elementIn(const json& value, const slicing::Object& object) {
    if (value.is_null()) return std::nullopt;
    const slicing::Element element{enumeratorIn<slicing::ElementKind>(value.at(0)),
                                   readInteger<std::size_t>(value.at(1))};
    if (element.index >= slicing::elementCount(object, element.kind)) throwUnreadable("an element is missing");
    return element;
}

glm::dvec3 pointIn(const json& value, double circumradius) {
    const double bound = session::kMaxOffset * circumradius * (1 + kSlack);
    return {readNumber(value.at(0), bound), readNumber(value.at(1), bound), readNumber(value.at(2), bound)};
}

slicing::FieldSettings fieldSettingsIn(const json& value) {
    slicing::FieldSettings field{{}, enumeratorIn<fields::Inside>(value.at(1)), {}};
    for (const json& level : value.at(0)) field.levels.push_back(readNumber(level, session::kMaxLevel));
    if (field.levels.empty() || field.levels.size() > slicing::kMaxLevels)
        throwUnreadable("the number of levels is out of range");
    // Records written by earlier versions of the program have no fog.
    if (value.size() <= 2) return field;
    for (const json& point : value.at(2)) {
        field.fog.push_back({readNumber(point.at(0), session::kMaxLevel), readNumber(point.at(1), 0, 1), {}});
        if (!point.at(2).is_null()) field.fog.back().color = readInteger<std::uint32_t>(point.at(2));
    }
    if (!session::isTransferFunction(field.fog)) throwUnreadable("the fog is not a transfer function");
    return field;
}

scene::Look lookIn(const json& value, const slicing::Object& object) {
    const std::size_t kinds = slicing::infoOf(object).cellTypes.size();
    const json& orbit = value.at(2);
    scene::Look look{
        enumeratorIn<scene::View>(value.at(0)),
        partsIn(value.at(1)),
        {readNumber(orbit.at(0), session::kMaxOrbitAngle), readNumber(orbit.at(1), session::kMaxOrbitAngle),
         readNumber(orbit.at(2), session::kMinZoom, session::kMaxZoom)},
        enumeratorIn<scene::Coloring>(value.at(3)),
        {cellTypesIn(value.at(4), kinds), cellTypesIn(value.at(5), kinds)},
        {},
        value.size() > 8 ? elementIn(value.at(8), object) : std::nullopt,
        value.size() > 9 ? pointIn(value.at(9), slicing::infoOf(object).circumradius) : glm::dvec3(0),
        value.size() > 10 ? fieldSettingsIn(value.at(10)) : slicing::FieldSettings{},
        value.size() > 11 ? enumeratorIn<scene::CapStyle>(value.at(11)) : scene::CapStyle::plain,
        value.size() > 12 ? enumeratorIn<scene::Background>(value.at(12)) : scene::Background::automatic};
    // Records written by earlier versions of the program lack the projection, highlight, focus point, field, caps and
    // background.
    if (value.size() > 6)
        look.projection = {enumeratorIn<scene::ProjectionKind>(value.at(6)),
                           readNumber(value.at(7), session::kMinEye, session::kMaxEye)};
    const auto& [hidden, faded] = look.cellTypes;
    if (std::ranges::any_of(hidden, [&](auto kind) { return std::ranges::binary_search(faded, kind); }))
        throwUnreadable("a cell type is both hidden and faded");
    return look;
}

// --- States

json encoded(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

json encoded(const geometry::ReferenceFrame& frame) {
    const auto& [pace, follow, boost] = frame;
    return {pace, encoded(follow), encoded(boost)};
}

glm::dvec3 velocityIn(const json& value, double most) {
    return {readNumber(value.at(0), most), readNumber(value.at(1), most), readNumber(value.at(2), most)};
}

geometry::ReferenceFrame referenceFrameIn(const json& value) {
    const geometry::ReferenceFrame frame{readNumber(value.at(0), session::kMinPace, session::kMaxPace),
                                         velocityIn(value.at(1), session::kMaxFollow),
                                         velocityIn(value.at(2), session::kMaxBoost)};
    if (!(glm::length(frame.boost) <= session::kMaxBoost)) throwUnreadable("a boost is too fast");
    return frame;
}

json encoded(const State& state, ObjectTable& objects) {
    const auto& [source, frame, object, orientation, alpha, beta, step, slices, look, turning, last,
                 ongoingTurnToward] = state;
    const auto& [count, spacing, focus, offset] = slices;
    return {objects.number(source),  // from which `object` is derived
            quaternion(orientation.left()),
            quaternion(orientation.right()),
            {alpha, beta, step},
            {count, spacing, focus, offset},
            encoded(look),
            turning,
            encoded(last),
            encoded(ongoingTurnToward),
            encoded(frame)};
}

State stateIn(const json& value, ObjectList& objects) {
    const slicing::Object& source = objects.at(value.at(0));
    const auto frame = value.size() > 9 ? referenceFrameIn(value.at(9)) : geometry::ReferenceFrame{};
    const slicing::Object object = objects.imageOf(source, frame);
    const geometry::ObjectInfo& info = slicing::infoOf(object);
    const json& angles = value.at(3);
    const json& slices = value.at(4);
    constexpr double kTwoPi = 2 * std::numbers::pi;
    // Records written by earlier versions of the program lack the offset, the turn toward an element, and the frame of
    // reference.
    const double radius = info.circumradius;
    State state{source,
                frame,
                object,
                rotationIn(value.at(1), value.at(2)),
                readNumber(angles.at(0), kTwoPi),
                readNumber(angles.at(1), kTwoPi),
                readNumber(angles.at(2), std::numeric_limits<double>::min(), kTwoPi),
                {readInteger<int>(slices.at(0)),
                 readNumber(slices.at(1), session::kMinSpacing * radius * (1 - kSlack),
                            session::kMaxSpacing * radius * (1 + kSlack)),
                 readInteger<int>(slices.at(2)),
                 slices.size() > 3 ? readNumber(slices.at(3), session::kMaxOffset * radius * (1 + kSlack)) : 0},
                lookIn(value.at(5), object),
                value.at(6).get<bool>(),
                turnIn(value.at(7)),
                value.size() > 8 ? ongoingTurnTowardIn(value.at(8)) : std::nullopt};
    const auto& [count, spacing, focus, offset] = state.slices;
    if (count < 1 || count > kMaxSlices || count % 2 == 0 || !(spacing > 0))
        throwUnreadable("the number of slices or their spacing is not allowed");
    if (focus < -session::kMaxFocus || focus > session::kMaxFocus) throwUnreadable("the focus is out of range");
    if (state.turning && state.ongoingTurnToward) throwUnreadable("a state both turns and approaches an orientation");
    if (state.turning && !state.lastTurn) throwUnreadable("a state is turning, but has no last rotation");
    return state;
}

/// Returns the encoding of the last `maxCount` states.
template <typename States>
json history(const States& states, std::size_t maxCount, ObjectTable& objects) {
    json list = json::array();
    for (std::size_t i = states.size() - std::min(states.size(), maxCount); i < states.size(); ++i) {
        list.push_back(encoded(states[i], objects));
    }
    return list;
}

}  // namespace

std::string encodeHead(const Session& session, const ObjectKeyLookup& keyOf) {
    ObjectTable objects(keyOf);
    json current = encoded(session.current, objects);
    return encodeCbor({kRecordVersion, session.revision, objects.list, std::move(current)});
}

std::string encodeWhole(const Session& session, std::size_t maxUndo, const ObjectKeyLookup& keyOf) {
    const auto& [current, undoSteps, redoSteps, loaded, pendingKey, revision] = session;
    ObjectTable objects(keyOf);
    json state = encoded(current, objects);
    json before = history(undoSteps, maxUndo, objects);
    json after = history(redoSteps, maxUndo, objects);
    json own = json::array();
    for (const auto& [name, object] : loaded) own.push_back({name, objects.number(object)});
    return encodeCbor({kRecordVersion, revision, objects.list, std::move(state), std::move(before), std::move(after),
                       std::move(own), pendingKey});
}

Session decode(std::string_view whole, std::string_view head, const ObjectLookup& objectOf,
               polytopes::PolytopeCache& cache) {
    return translatingErrors([&] {
        const json value = parseRecord(whole);
        ObjectList objects(value.at(2), objectOf, cache);
        Session session;
        session.revision = revisionIn(value.at(1));
        session.current = stateIn(value.at(3), objects);
        for (const json& state : value.at(4)) session.undoSteps.push_back(stateIn(state, objects));
        for (const json& state : value.at(5)) session.redoSteps.push_back(stateIn(state, objects));
        for (const json& own : value.at(6)) session.loaded[readShortText(own.at(0))] = objects.at(own.at(1));
        session.pendingKey = readShortText(value.at(7));
        if (head.empty()) return session;
        const json newer = parseRecord(head);
        const auto revision = revisionIn(newer.at(1));
        if (revision <= session.revision) return session;
        session.undoSteps.push_back(std::move(session.current));
        session.redoSteps.clear();
        ObjectList newerObjects(newer.at(2), objectOf, cache);
        session.current = stateIn(newer.at(3), newerObjects);
        session.revision = revision;
        session.pendingKey.clear();
        return session;
    });
}

}  // namespace oval4d::store
