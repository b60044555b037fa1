#include "store/state_codec.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
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

// --- Encoding

/// Writes the members of a struct into an array (see serialization/stored_members.hpp).
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
    void array(std::size_t number, const auto& visitThem) {
        MemberWriter writer;
        visitThem(writer);
        put(number, std::move(writer.array_));
    }
    void rotation(std::size_t number, const geometry::Rotation& rotation) {
        put(number, encoded(rotation.left()));
        put(number + 1, encoded(rotation.right()));
    }

    /// Moves the array out of the writer.
    json takeArray() { return std::move(array_); }

  protected:
    void put(std::size_t number, json value) {
        while (array_.size() <= number) array_.push_back(nullptr);
        array_[number] = std::move(value);
    }

  private:
    template <typename Struct>
    static json encoded(const Struct& value) {
        MemberWriter writer;
        visitStoredMembers(value, writer);
        return std::move(writer.array_);
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

/// Writes the members of a state. Its object becomes an index into the list of objects.
class StateWriter : public MemberWriter {
  public:
    explicit StateWriter(ObjectListEncoder& objects) : objects_(objects) {}

    void object(std::size_t number, const slicing::Object& value) { put(number, objects_.findOrAddObject(value)); }

  private:
    ObjectListEncoder& objects_;
};

// --- Decoding

geometry::Plane planeIn(const json& value) {
    const auto number = readInteger<unsigned>(value);
    if (number >= geometry::kPlanes.size()) throwLater("there is no plane " + std::to_string(number));
    return geometry::kPlanes[number];
}

glm::dquat quaternionIn(const json& value) {
    return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>(), value.at(3).get<double>()};
}

/// Reads the members of a struct from an array.
class MemberReader {
  public:
    explicit MemberReader(const json& array) : array_(array) {}

    template <typename T, typename... Ranges>
    void member(std::size_t number, T& value, Ranges... range) {
        read(at(number), value, range...);
    }
    template <typename T, typename... Ranges>
    void addedMember(std::size_t number, T& value, Ranges... range) {
        if (number < array_.size()) member(number, value, range...);
    }
    void array(std::size_t number, const auto& visitThem) {
        MemberReader reader(at(number));
        visitThem(reader);
        reader.refuseUnreadMembers();
    }
    void rotation(std::size_t number, geometry::Rotation& rotation) {
        const auto decoded =
            geometry::Rotation::fromQuaternions(quaternionIn(at(number)), quaternionIn(at(number + 1)));
        if (!decoded) throwUnreadable("an orientation is not a rotation");
        rotation = *decoded;
    }

    /// Throws LaterRecord if the array has more members than those that have been read.
    void refuseUnreadMembers() const { refuseUnknownMembers(array_, readCount_); }

  protected:
    const json& at(std::size_t number) {
        readCount_ = std::max(readCount_, number + 1);
        return array_.at(number);
    }

  private:
    template <typename Struct>
    static void read(const json& value, Struct& into) {
        MemberReader reader(value);
        visitStoredMembers(into, reader);
        reader.refuseUnreadMembers();
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
        if (found == choices.end()) throwLater("an enumerator is out of range: " + std::to_string(number));
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
    std::size_t readCount_ = 0;  // all members that have been read have smaller numbers
};

/// Reads the members of a state. Its object is an index into the list of objects.
class StateReader : public MemberReader {
  public:
    StateReader(const json& array, const ObjectListDecoder& objects) : MemberReader(array), objects_(objects) {}

    void object(std::size_t number, slicing::Object& value) { value = objects_.at(at(number)); }

  private:
    const ObjectListDecoder& objects_;
};

// --- Checks of a state whose members have been read
//
// The checks concern single members, and how members fit each other and the object. Their limits are at least as wide
// as those that the server enforces for clients. Without them, a damaged record could produce, for example, a state
// with a million slices instead of an error.

// Spacing, offset and focus point are limited in proportion to the circumradius. Because of rounding errors, each may
// exceed its limit by this fraction.
constexpr double kSlack = 1e-9;

void check(const session::HyperplaneSettings& slices, double circumradius) {
    constexpr int kMaxSlices = 100'001;
    const auto& [count, spacing, focus, offset] = slices;
    if (count < 1 || count > kMaxSlices || count % 2 == 0)
        throwLater("the number of slices is not allowed: " + std::to_string(count));
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
        throwLater("the number of levels is out of range");
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
    StateWriter writer(objects);
    visitStoredMembers(state, writer);
    return writer.takeArray();
}

State decodeState(const json& array, ObjectListDecoder& objects) {
    State state{};
    StateReader reader(array, objects);
    visitStoredMembers(state, reader);
    reader.refuseUnreadMembers();
    if (!(glm::length(state.referenceFrame.boost) <= geometry::ReferenceFrame::kMaxBoost))
        throwUnreadable("a boost is too fast");
    state.object = objects.transformedTo(state.source, state.referenceFrame);
    check(state);
    return state;
}

}  // namespace oval4d::store
