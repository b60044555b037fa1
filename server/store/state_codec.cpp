#include "store/state_codec.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "fields/field.hpp"
#include "session/settings.hpp"
#include "store/cbor.hpp"
#include "store/member_codec.hpp"

namespace oval4d::store {

using nlohmann::json;
using session::State;

namespace {

/// A visitor that writes the members of a state. Writes an index into the list of objects instead of the object.
class StateWriter : public MemberWriter {
  public:
    explicit StateWriter(ObjectListEncoder& objects) : objects_(objects) {}

    void object(std::size_t number, const slicing::Object& value) { put(number, objects_.findOrAddObject(value)); }

  private:
    ObjectListEncoder& objects_;
};

/// A visitor that reads the members of a state. Reads an index into the list of objects instead of the object.
class StateReader : public MemberReader {
  public:
    StateReader(const json& array, const ObjectListDecoder& objects) : MemberReader(array), objects_(objects) {}

    void object(std::size_t number, slicing::Object& value) { value = objects_.at(at(number)); }

  private:
    const ObjectListDecoder& objects_;
};

// --- Checks of a state whose members have been read
//
// The checks concern the values of single members, and whether members fit each other and the object. Without them, a
// damaged record could produce, for example, a state with a million slices instead of an error. All limits are at least
// as wide as the limits for clients. A later version may allow more, or build an object with more elements. So a value
// beyond a limit, or an element that the object lacks, throws NewerVersionRecord. After UnreadableRecord, clients would
// forget the session.

// The fraction of their limits by which spacing, offset and focus point may exceed the limits, because of rounding
// errors. The limits are multiples of the circumradius.
constexpr double kSlack = 1e-9;

void check(const session::HyperplaneSettings& slices, double circumradius) {
    constexpr int kMaxSlices = 100'001;
    const auto& [count, spacing, focus, offset] = slices;
    if (count < 1 || count > kMaxSlices || count % 2 == 0)
        throwLaterRecord("the number of slices is not allowed: " + std::to_string(count));
    if (!(spacing > 0 && spacing >= session::kMinSpacing * circumradius * (1 - kSlack) &&
          spacing <= session::kMaxSpacing * circumradius * (1 + kSlack)))
        throwLaterRecord("the spacing of the slices is out of range");
    if (focus < -session::kMaxFocus || focus > session::kMaxFocus) throwLaterRecord("the focus is out of range");
    if (!(std::abs(offset) <= session::kMaxOffset * circumradius * (1 + kSlack)))
        throwLaterRecord("the offset is out of range");
}

void check(const scene::CellTypeFilter& filter, std::size_t typeCount) {
    const auto& [hidden, faded] = filter;
    for (const std::vector<std::uint32_t>* types : {&hidden, &faded}) {
        if (std::ranges::adjacent_find(*types, std::greater_equal<>()) != types->end())
            throwUnreadableRecord("the hidden or faded cell types are not in order");
        if (!types->empty() && types->back() >= typeCount) throwLaterRecord("a hidden or faded cell type is missing");
    }
    if (std::ranges::any_of(hidden, [&](auto type) { return std::ranges::binary_search(faded, type); }))
        throwUnreadableRecord("a cell type is both hidden and faded");
}

void check(const slicing::FieldSettings& field) {
    if (field.levels.empty() || field.levels.size() > slicing::kMaxLevels)
        throwLaterRecord("the number of levels is out of range");
    if (!session::isValidTransferFunction(field.fog)) throwLaterRecord("the fog is not a transfer function");
}

void check(const State& state) {
    const geometry::ObjectInfo& info = slicing::infoOf(state.object);
    check(state.slices, info.circumradius);
    check(state.look.cellTypes, info.cellTypes.size());
    check(state.look.field);
    const auto& highlight = state.look.highlight;
    if (highlight && highlight->index >= slicing::elementCount(state.object, highlight->kind))
        throwLaterRecord("the highlighted element is missing");
    const glm::dvec3 point = glm::abs(state.look.focusPoint);
    if (!(std::max({point.x, point.y, point.z}) <= session::kMaxOffset * info.circumradius * (1 + kSlack)))
        throwLaterRecord("the focus point is out of range");
    if (state.turning && state.ongoingTurnToward)
        throwUnreadableRecord("a state both turns and approaches an orientation");
    if (state.turning && !state.lastTurn) throwUnreadableRecord("a state is turning, but has no last rotation");
}

// If the state shows a field from a file in the server's data folder, clamps the settings that are limited by the
// field's box to their limits. Since the state was stored, another file with another box may have replaced the file.
void clampToReplacedField(State& state) {
    const fields::Field* const field = slicing::fieldIn(state.source);
    if (field == nullptr || !field->source) return;
    const geometry::ObjectInfo& info = slicing::infoOf(state.object);
    const double radius = info.circumradius, reach = session::kMaxOffset * radius;
    auto& [count, spacing, focus, offset] = state.slices;
    spacing = std::clamp(spacing, session::kMinSpacing * radius, session::kMaxSpacing * radius);
    offset = std::clamp(offset, -reach, reach);
    state.look.focusPoint = glm::clamp(state.look.focusPoint, glm::dvec3(-reach), glm::dvec3(reach));
    for (std::vector<std::uint32_t>* types : {&state.look.cellTypes.hidden, &state.look.cellTypes.faded})
        std::erase_if(*types, [&](std::uint32_t type) { return type >= info.cellTypes.size(); });
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
        throwLaterRecord("a boost is too fast");
    state.object = objects.transformedTo(state.source, state.referenceFrame);
    clampToReplacedField(state);
    check(state);
    return state;
}

}  // namespace oval4d::store
