#include "store/state_codec.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "geometry/range.hpp"
#include "session/settings.hpp"
#include "store/cbor.hpp"
#include "text/choice.hpp"

namespace oval4d::store {

using nlohmann::json;
using session::State;

namespace {

using geometry::Range;
constexpr Range upTo(double most) { return {-most, most}; }
constexpr Range kAnyNumber = upTo(std::numeric_limits<double>::max());
constexpr double kLeastPositive = std::numeric_limits<double>::min();

/// Whether T is `Struct` or `const Struct`.
template <typename T, typename Struct>
concept Is = std::is_same_v<std::remove_const_t<T>, Struct>;

// --- The members of each struct, and their numbers
//
// A struct is encoded as an array. The number of a member is its index in this array. Servers of other versions read
// and write the same records, hence these rules: a member keeps its number forever; no number is used again; a new
// member gets the next number and is visited with addedMember(), because records of earlier versions lack it. The same
// rules hold for the numbers of enumerators and for the rows of scene::kParts. The structured bindings name every
// member of a struct, so that the code does not compile until a new member is added here. The ranges are those that
// are declared together with the members.

void visitMembers(Is<scene::CameraOrbit> auto& orbit, auto& visit) {
    auto& [azimuth, elevation, zoom] = orbit;
    visit.member(0, azimuth, scene::CameraOrbit::kAngleRange);
    visit.member(1, elevation, scene::CameraOrbit::kAngleRange);
    visit.member(2, zoom, scene::CameraOrbit::kZoomRange);
}

void visitMembers(Is<slicing::Element> auto& element, auto& visit) {
    auto& [kind, index] = element;
    visit.member(0, kind);
    visit.member(1, index);
}

void visitMembers(Is<slicing::FogPoint> auto& point, auto& visit) {
    auto& [value, opacity, color] = point;
    visit.member(0, value, upTo(slicing::kMaxLevel));
    visit.member(1, opacity, Range{0, 1});
    visit.member(2, color);
}

void visitMembers(Is<slicing::FieldSettings> auto& field, auto& visit) {
    auto& [levels, inside, fog] = field;
    visit.member(0, levels, upTo(slicing::kMaxLevel));
    visit.member(1, inside);
    visit.addedMember(2, fog);
}

void visitMembers(Is<scene::Look> auto& look, auto& visit) {
    auto& [view, parts, orbit, coloring, cellTypes, projection, highlight, focusPoint, field, caps, background,
           thickness] = look;
    auto& [hidden, faded] = cellTypes;
    auto& [kind, eye] = projection;
    visit.member(0, view);
    visit.member(1, parts);
    visit.member(2, orbit);
    visit.member(3, coloring);
    visit.member(4, hidden);
    visit.member(5, faded);
    visit.addedMember(6, kind);
    visit.addedMember(7, eye, scene::ProjectionSettings::kEyeRange);
    visit.addedMember(8, highlight);
    visit.addedMember(9, focusPoint, kAnyNumber);
    visit.addedMember(10, field);
    visit.addedMember(11, caps);
    visit.addedMember(12, background);
    visit.addedMember(13, thickness, scene::Look::kThicknessRange);
}

void visitMembers(Is<session::SliceSettings> auto& slices, auto& visit) {
    auto& [count, spacing, focus, offset] = slices;
    visit.member(0, count);
    visit.member(1, spacing, kAnyNumber);
    visit.member(2, focus);
    visit.addedMember(3, offset, kAnyNumber);
}

void visitMembers(Is<geometry::ReferenceFrame> auto& frame, auto& visit) {
    auto& [pace, follow, boost] = frame;
    visit.member(0, pace, geometry::ReferenceFrame::kPaceRange);
    visit.member(1, follow, geometry::ReferenceFrame::kFollowRange);
    visit.member(2, boost, upTo(geometry::ReferenceFrame::kMaxBoost));
}

void visitMembers(Is<session::OngoingTurnToward> auto& turn, auto& visit) {
    auto& [goal, seconds] = turn;
    visit.rotation(0, goal);  // two quaternions: the members 0 and 1
    visit.member(2, seconds, Range{kLeastPositive, session::OngoingTurnToward::kMaxSeconds});
}

/// The angles of the rotation keys. They are members of a State, but form an array of their own in its record.
template <typename Number>
struct KeyAngles {
    Number &alpha, &beta, &step;
};
template <typename Number>
KeyAngles(Number&, Number&, Number&) -> KeyAngles<Number>;

template <typename Number>
void visitMembers(const KeyAngles<Number>& angles, auto& visit) {
    visit.member(0, angles.alpha, State::kAngleRange);
    visit.member(1, angles.beta, State::kAngleRange);
    visit.member(2, angles.step, Range{kLeastPositive, State::kStepRange.most});
}

/// The number of the member State::source, which is written as an index into the list of objects.
constexpr std::size_t kSourceNumber = 0;

void visitMembers(Is<State> auto& state, auto& visit) {
    auto& [source, frame, object, orientation, alpha, beta, step, slices, look, turning, lastTurn, ongoing] = state;
    visit.rotation(1, orientation);  // two quaternions: the members 1 and 2
    visit.members(3, KeyAngles{alpha, beta, step});
    visit.member(4, slices);
    visit.member(5, look);
    visit.member(6, turning);
    visit.member(7, lastTurn);
    visit.addedMember(8, ongoing);
    visit.addedMember(9, frame);
}

// --- Encoding

/// Visits the members of a struct, and writes them into an array.
class MemberWriter {
  public:
    template <typename T, typename... Ranges>
    void member(std::size_t number, const T& value, Ranges... /*range*/) {
        put(number, encoded(value));
    }
    template <typename T, typename... Ranges>
    void addedMember(std::size_t number, const T& value, Ranges... /*range*/) {
        put(number, encoded(value));
    }
    /// Writes several members of a struct together, as one array.
    template <typename Members>
    void members(std::size_t number, const Members& some) {
        put(number, encoded(some));
    }
    /// Writes the two quaternions of a rotation as the members `number` and `number` + 1.
    void rotation(std::size_t number, const geometry::Rotation& rotation) {
        put(number, encoded(rotation.left()));
        put(number + 1, encoded(rotation.right()));
    }

    template <typename Struct>
    static json encoded(const Struct& value) {
        MemberWriter writer;
        visitMembers(value, writer);
        return std::move(writer.array_);
    }

  private:
    void put(std::size_t number, json value) {
        while (array_.size() <= number) array_.push_back(nullptr);
        array_[number] = std::move(value);
    }

    template <typename Number>
        requires std::is_arithmetic_v<Number>
    static json encoded(const Number& value) {
        return value;
    }
    template <text::HasChoices Enum>
    static json encoded(const Enum& value) {
        return static_cast<unsigned>(value);
    }
    template <typename T>
    static json encoded(const std::vector<T>& values) {
        json list = json::array();
        for (const T& value : values) list.push_back(encoded(value));
        return list;
    }
    template <typename T>
    static json encoded(const std::optional<T>& value) {
        return value ? encoded(*value) : json();
    }
    static json encoded(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
    static json encoded(const glm::dquat& q) { return {q.w, q.x, q.y, q.z}; }
    static json encoded(const scene::Parts& parts) {
        json flags = json::array();
        for (const scene::NamedPart& part : scene::kParts) flags.push_back(parts.*part.flag);
        return flags;
    }
    // A turn in one plane, or in two perpendicular planes, is encoded as [plane, angle, angle in the perpendicular
    // plane or null], which earlier versions can read, too. Any other turn is a list of pairs [[plane, angle], …].
    // Angles are in radians.
    static json encoded(const geometry::Turn& turn) {
        const std::vector<geometry::Plane> planes = turn.planes();
        const geometry::Plane first = planes.at(0);
        if (planes.size() == 1 || (planes.size() == 2 && planes[1] == geometry::perpendicular(first)))
            return {static_cast<unsigned>(first), *turn[first], encoded(turn[geometry::perpendicular(first)])};
        json pairs = json::array();
        for (const geometry::Plane plane : planes)
            pairs.push_back(json::array({static_cast<unsigned>(plane), *turn[plane]}));
        return pairs;
    }

    json array_ = json::array();
};

// --- Decoding

geometry::Plane planeIn(const json& value) {
    const auto number = readInteger<unsigned>(value);
    if (number >= geometry::kPlanes.size()) throwUnreadable("there is no plane " + std::to_string(number));
    return geometry::kPlanes[number];
}

glm::dquat quaternionIn(const json& value) {
    return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>(), value.at(3).get<double>()};
}

/// Visits the members of a struct, and reads them from an array.
class MemberReader {
  public:
    explicit MemberReader(const json& array) : array_(array) {}

    template <typename T, typename... Ranges>
    void member(std::size_t number, T& value, Ranges... range) const {
        read(array_.at(number), value, range...);
    }
    /// Leaves the value as it is if the array lacks the member.
    template <typename T, typename... Ranges>
    void addedMember(std::size_t number, T& value, Ranges... range) const {
        if (number < array_.size()) member(number, value, range...);
    }
    template <typename Members>
    void members(std::size_t number, const Members& some) const {
        const MemberReader reader(array_.at(number));
        visitMembers(some, reader);
    }
    void rotation(std::size_t number, geometry::Rotation& rotation) const {
        const auto decoded =
            geometry::Rotation::fromQuaternions(quaternionIn(array_.at(number)), quaternionIn(array_.at(number + 1)));
        if (!decoded) throwUnreadable("an orientation is not a rotation");
        rotation = *decoded;
    }

  private:
    template <typename Struct>
    static void read(const json& value, Struct& into) {
        const MemberReader reader(value);
        visitMembers(into, reader);
    }
    static void read(const json& value, bool& into) { into = value.get<bool>(); }
    template <std::integral Integer>
    static void read(const json& value, Integer& into) {
        into = readInteger<Integer>(value);
    }
    static void read(const json& value, double& into, Range range) {
        into = readNumber(value, range.least, range.most);
    }
    template <text::HasChoices Enum>
    static void read(const json& value, Enum& into) {
        const auto number = readInteger<unsigned>(value);
        const auto& choices = choicesOf(Enum{});
        const auto found = std::ranges::find_if(
            choices, [&](const auto& choice) { return static_cast<unsigned>(choice.value) == number; });
        if (found == choices.end()) throwUnreadable("an enumerator is out of range: " + std::to_string(number));
        into = found->value;
    }
    template <typename T, typename... Ranges>
    static void read(const json& value, std::vector<T>& into, Ranges... range) {
        if (!value.is_array()) throwUnreadable("a list is missing");
        into.clear();
        for (const json& element : value) read(element, into.emplace_back(), range...);
    }
    template <typename T>
    static void read(const json& value, std::optional<T>& into) {
        into.reset();
        if (!value.is_null()) read(value, into.emplace());
    }
    static void read(const json& value, glm::dvec3& into, Range range) {
        for (int i = 0; i < 3; ++i) read(value.at(static_cast<std::size_t>(i)), into[i], range);
    }
    // An array of an earlier version may lack some parts; these keep their defaults.
    static void read(const json& value, scene::Parts& into) {
        for (std::size_t i = 0; i < std::min(value.size(), scene::kParts.size()); ++i)
            read(value.at(i), into.*scene::kParts[i].flag);
    }
    static void read(const json& value, geometry::Turn& into) {
        const auto angle = [&](const json& plane, const json& radians) {
            into[planeIn(plane)] = readNumber(radians, session::kMaxAngle);
        };
        if (value.at(0).is_array()) {
            for (const json& pair : value) angle(pair.at(0), pair.at(1));
            return;
        }
        angle(value.at(0), value.at(1));
        if (!value.at(2).is_null())
            into[geometry::perpendicular(planeIn(value.at(0)))] = readNumber(value.at(2), session::kMaxAngle);
    }

    const json& array_;
};

// --- Checks of members together with other members or the object
//
// These limits are at least as wide as those that the server enforces for clients. Without them, a damaged record could
// produce, for example, a state with a million slices instead of an error.

// Spacing, offset and focus point are limited in proportion to the circumradius. Because of rounding errors, they may
// exceed these limits by this fraction.
constexpr double kSlack = 1e-9;

void check(const session::SliceSettings& slices, double circumradius) {
    constexpr int kMaxSlices = 100'001;
    const auto& [count, spacing, focus, offset] = slices;
    if (count < 1 || count > kMaxSlices || count % 2 == 0)
        throwUnreadable("the number of slices is not allowed: " + std::to_string(count));
    if (!(spacing > 0 && spacing >= session::kMinSpacing * circumradius * (1 - kSlack) &&
          spacing <= session::kMaxSpacing * circumradius * (1 + kSlack)))
        throwUnreadable("the spacing of the slices is out of range");
    if (focus < -session::kMaxFocus || focus > session::kMaxFocus) throwUnreadable("the focus is out of range");
    if (!(std::abs(offset) <= session::kMaxOffset * circumradius * (1 + kSlack)))
        throwUnreadable("the offset is out of range");
}

void check(const scene::CellTypeFilter& filter, std::size_t typeCount) {
    const auto& [hidden, faded] = filter;
    for (const std::vector<std::uint32_t>* types : {&hidden, &faded}) {
        const auto unsorted = std::ranges::adjacent_find(*types, std::greater_equal<>());
        if (unsorted != types->end() || (!types->empty() && types->back() >= typeCount))
            throwUnreadable("the hidden or faded cell types are not in order or out of range");
    }
    if (std::ranges::any_of(hidden, [&](auto type) { return std::ranges::binary_search(faded, type); }))
        throwUnreadable("a cell type is both hidden and faded");
}

void check(const slicing::FieldSettings& field) {
    if (field.levels.empty() || field.levels.size() > slicing::kMaxLevels)
        throwUnreadable("the number of levels is out of range");
    if (!session::isTransferFunction(field.fog)) throwUnreadable("the fog is not a transfer function");
}

void check(const State& state) {
    const geometry::ObjectInfo& info = slicing::infoOf(state.object);
    check(state.slices, info.circumradius);
    check(state.look.cellTypes, info.cellTypes.size());
    check(state.look.field);
    const auto& highlight = state.look.highlight;
    if (highlight && highlight->index >= slicing::elementCount(state.object, highlight->kind))
        throwUnreadable("an element is missing");
    const glm::dvec3 point = glm::abs(state.look.focusPoint);
    if (!(std::max({point.x, point.y, point.z}) <= session::kMaxOffset * info.circumradius * (1 + kSlack)))
        throwUnreadable("the focus point is out of range");
    if (state.turning && state.ongoingTurnToward) throwUnreadable("a state both turns and approaches an orientation");
    if (state.turning && !state.lastTurn) throwUnreadable("a state is turning, but has no last rotation");
}

}  // namespace

json encodeState(const State& state, ObjectListEncoder& objects) {
    json array = MemberWriter::encoded(state);
    array[kSourceNumber] = objects.indexOf(state.source);
    return array;
}

State decodeState(const json& array, ObjectListDecoder& objects) {
    const slicing::Object& source = objects.at(array.at(kSourceNumber));
    State state{source, {}, source, {}, 0, 0, 0, {}, {}, false, {}, {}};
    const MemberReader reader(array);
    visitMembers(state, reader);
    if (!(glm::length(state.referenceFrame.boost) <= geometry::ReferenceFrame::kMaxBoost))
        throwUnreadable("a boost is too fast");
    state.object = objects.transformedTo(source, state.referenceFrame);
    check(state);
    return state;
}

}  // namespace oval4d::store
