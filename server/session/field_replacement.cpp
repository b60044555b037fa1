#include "session/field_replacement.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <variant>

#include <glm/common.hpp>

#include "fields/field.hpp"
#include "session/load.hpp"
#include "session/settings.hpp"

namespace oval4d::session {

namespace {

// A field that replaces another field, in several frames of reference (see slicing::transformedTo()). A value is the
// new field in one frame. The key of the value is slicing::identityOf() of the replaced field in the same frame.
using FieldsByOriginal = std::map<const void*, slicing::Object>;

// If `state` shows the field `before`, replaces this field by `after` (see replaceField()) and returns true. Otherwise
// returns false. `images` contains the transformed fields made so far, and gets those that are missing, so that states
// with the same frame of reference share a field.
bool replaceFieldInState(State& state, const slicing::Object& before, const slicing::Object& after,
                         FieldReplacementKind how, FieldsByOriginal& images) {
    if (state.source != before) return false;
    const auto [image, isNew] = images.try_emplace(slicing::identityOf(state.object));
    if (isNew) image->second = slicing::transformedTo(after, state.referenceFrame);
    slicing::Object object = image->second;
    HyperplaneSettings& slices = state.slices;
    if (how == FieldReplacementKind::longer) {
        const double ratio = slicing::initialSliceExtent(object) / slicing::initialSliceExtent(state.object);
        slices.spacing *= ratio;
        slices.offset *= ratio;
    } else if (slicesSpanObject(state)) {
        slices.spacing = spanningSpacing(object, slices.count);
    }
    const double radius = slicing::infoOf(object).circumradius, reach = kMaxOffset * radius;
    // Clamp the values, because spanningSpacing() is proportional to initialSliceExtent(), but the bounds are
    // proportional to the circumradius. The ratio of these two lengths grows when an array gets its second time step.
    slices.spacing = std::clamp(slices.spacing, kMinSpacing * radius, kMaxSpacing * radius);
    slices.offset = std::clamp(slices.offset, -reach, reach);
    state.look.focusPoint = glm::clamp(state.look.focusPoint, glm::dvec3(-reach), glm::dvec3(reach));
    if (slicing::infoOf(object).cellTypes != slicing::infoOf(state.object).cellTypes) state.look.cellTypes = {};
    state.source = after;
    state.object = std::move(object);
    return true;
}

}  // namespace

void replaceField(Session& session, const slicing::Object& before, const slicing::Object& after,
                  FieldReplacementKind how) {
    FieldsByOriginal images;
    for (State& state : session.undoSteps) replaceFieldInState(state, before, after, how, images);
    for (State& state : session.redoSteps) replaceFieldInState(state, before, after, how, images);
    if (replaceFieldInState(session.current, before, after, how, images)) ++session.revision;
    for (auto& [name, loaded] : session.loaded) {
        if (loaded == before) loaded = after;
    }
}

std::optional<LoadObject> loadCommandForFinerLevel(const State& state) {
    const fields::Field* const field = slicing::fieldIn(state.source);
    if (field == nullptr || !field->source || field->imageLevel.finer == 0) return {};
    LoadObject load = loadCommandFor(field->name, *field->source);
    load.finer = FinerImageLevel{field->imageLevel.level - 1, field->initialLevel};
    return load;
}

slicing::Object withoutFinerLevels(const slicing::Object& field) {
    return fields::changedCopy(std::get<slicing::FieldPtr>(field),
                               [](fields::Field& copy) { copy.imageLevel.finer = 0; });
}

}  // namespace oval4d::session
