#pragma once
// Replaces a field by a longer or finer version of the same field, without an undo step.

#include <cstdint>
#include <optional>

#include "session/command.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// The difference between a new field and the field that it replaces.
enum class FieldReplacementKind : std::uint8_t {
    longer,  ///< the new field has more time steps
    /// The new field is a finer resolution level of the same image, in nearly the same box.
    finer
};

/// Replaces the field `before` by `after` in the current state, in the states of the history and among the loaded
/// objects. Adds no undo step. Increases the revision if the current state shows the field. Settings stay the same,
/// with these exceptions:
/// - For a longer field, spacing and offset keep their ratios to slicing::initialSliceExtent().
/// - For a finer field, the spacing stays spanningSpacing() if it was that before.
/// - Spacing, offset and focus point are clamped to their bounds.
/// - If the cell types of the domain change, all its cells become visible.
void replaceField(Session& session, const slicing::Object& before, const slicing::Object& after,
                  FieldReplacementKind how);

/// Returns the command that loads the next finer level of the multiscale image that the state shows. Returns an empty
/// optional if no finer level is to be loaded.
std::optional<LoadObject> loadCommandForFinerLevel(const State& state);

/// Returns a copy of `field` for which loadCommandForFinerLevel() returns no further level.
slicing::Object withoutFinerLevels(const slicing::Object& field);

}  // namespace oval4d::session
