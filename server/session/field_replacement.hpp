#pragma once
// Replaces a field by a version of it that is longer or finer, without an undo step.

#include <cstdint>
#include <optional>

#include "session/command.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// How a field differs from the one that it replaces.
enum class FieldReplacement : std::uint8_t {
    longer,  ///< it has more time steps
    finer    ///< it is a finer level of the same image, in nearly the same box
};

/// Replaces the field `before` by `after` in the current state, in the states of the history and among the loaded
/// objects. Adds no undo step; increases the revision if the current state shows the field. Keeps all settings, with
/// these exceptions. If the field is longer, spacing and offset keep their ratios to slicing::initialSliceExtent(). If
/// it is finer, the spacing becomes spanningSpacing() if it was that before. Spacing, offset and focus point are
/// clamped to their bounds; and if the cell types of the domain change, all its cells become visible.
void replaceField(Session& session, const slicing::Object& before, const slicing::Object& after, FieldReplacement how);

/// Returns how to load the next finer level of the image that the state shows; an empty optional if none is to follow
/// (see fields::ImageLevel::finer).
std::optional<LoadObject> loadOfFinerLevel(const State& state);

/// Returns the same field as `field`, after which no finer level is to follow.
slicing::Object withoutFinerLevels(const slicing::Object& field);

}  // namespace oval4d::session
