#pragma once
// Changes the settings of a state, and checks the bounds of their values.

#include <span>

#include "fields/field.hpp"
#include "session/object_loader.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// The maximum absolute value of a rotation's angle, in radians. Doubles represent larger angles too imprecisely.
inline constexpr double kMaxAngle = 1e6;

/// Returns whether these control points are valid as FieldSettings::fog. There may be none, or kMinFogControlPoints …
/// kMaxFogControlPoints points (both in slicing). Their values must increase within ±slicing::kMaxLevel, their
/// opacities must be 0 … 1, and their colors must have 24 bits.
bool isValidTransferFunction(std::span<const slicing::FogControlPoint> points);

/// Returns the initial settings of a field: its level (isovalue), the side of the level that is inside, and no fog.
slicing::FieldSettings initialFieldSettings(const fields::Field& field);

/// Shows the object `source` in place of State::source, and updates State::object. Does nothing if `source` is already
/// shown.
///
/// Keeps the frame of reference, the orientation, and the ratio of the spacing to slicing::initialSliceExtent(). Ends
/// playing and a turn toward an element. Resets the settings with ResetOccasion::by_another_object or
/// ResetOccasion::by_reset_or_another_object. A new field gets its initial field settings. Sets Coloring::value if only
/// the new object has a second function. Replaces Coloring::value by Coloring::cell if only the old object has a second
/// function.
///
/// Error: the error of `loader` if transforming the object to the frame of reference is deferred. The state is then
/// unchanged.
Result<std::monostate> replaceObject(State& state, slicing::Object source, ObjectLoader& loader);

/// Keeps the settings of a field when `load` has replaced one part of an array in the data folder by another part, or
/// by the whole array, under the same name. `before` is the state that shows the old part. `next` is the state after
/// replaceObject(). `next` gets the field settings of `before` and, if both objects have the same cell types, its
/// hidden and faded cell types. Levels that still have their initial values are not kept, because each part has initial
/// levels of its own. Does nothing after any other load.
void carryOverFieldSettings(const State& before, const LoadObject& load, State& next);

/// Resets the orientation to the initial one, and ends all motion.
void returnToInitialOrientation(State& state);

/// Resets the orientation, ends all motion, and resets the settings with ResetOccasion::by_reset_or_another_object.
void resetOrientationAndFocus(State& state);

/// Returns whether the spacing of the slices is spanningSpacing(), apart from rounding.
bool slicesSpanObject(const State& state);

/// Shows the object in another frame of reference. Does nothing if the state already has this frame. The members of
/// `frame` must be within the bounds in geometry::ReferenceFrame. If the spacing is spanningSpacing(), as it is
/// initially, it becomes spanningSpacing() of the transformed object, and the w of the focus slice stays the same.
/// Otherwise, the slices stay the same. Spacing, offset and focus point are clamped to their bounds, which depend on
/// the circumradius. Ends a turn toward an element. Error: the error of `loader` if the transformation is deferred; the
/// state is then unchanged.
Result<std::monostate> changeReferenceFrame(State& state, const geometry::ReferenceFrame& frame, ObjectLoader& loader);

/// Changes the number of slices. If the old and the new number are greater than 1, the span (count − 1) · spacing stays
/// the same, as far as the bounds of the spacing allow.
void setSliceCount(State& state, int count);

/// Applies the settings that are present in `set`. After an error, some of these settings may have been applied, so
/// callers must pass a copy of the state. Errors: the errors of findObject(); `not_a_rotation`; `out_of_range`;
/// `nothing_to_undo` if `set` starts continuous turning, but there is no last rotation to repeat.
Result<std::monostate> applySet(State& state, const ChangeSettings& set, const LoadedObjects& loaded,
                                const Limits& limits, ObjectLoader& loader);

/// Returns the settings of a state. If applySet() applies them to another state with the same object, this state
/// becomes equal to `state`, except for the orientation, the last rotation and the motion.
ChangeSettings settingsOf(const State& state);

/// Returns the error `out_of_range` unless the angles of a rotation are finite and within ±kMaxAngle.
Result<std::monostate> checkTurn(const geometry::RotationAngles& turn);

/// Returns the error `out_of_range` if the object does not have the element.
Result<std::monostate> checkElement(const slicing::Object& object, const slicing::Element& element);

/// Rotates the object, stores the rotation as State::lastTurn, and ends a turn toward an element.
void rotate(State& state, const geometry::RotationAngles& turn);

/// Starts to turn the object until an element points to +w; with TurnToward::immediately, turns the object at once.
/// Without TurnToward::number, slicing::elementToTurnTo() chooses an element of the kind TurnToward::element: the
/// element closest to +w or, if this element already points to +w, the next one. If an element is highlighted, only
/// this element, elements that contain it, and elements that it contains can be chosen. Ends continuous turning. Error:
/// `out_of_range` if the object has no such element.
Result<std::monostate> turnToward(State& state, const TurnToward& command);

/// Highlights the next element of a kind, by index; the previous element if `forward` is false. After the last element
/// comes the first. Skips elements whose cells all have hidden types (CellTypeFilter::hidden). If no element of this
/// kind is highlighted, chooses the first visible element that the focus slice cuts (see slicing::elementsCutBy()). If
/// the focus slice cuts none, chooses the first visible element. Error: `out_of_range` if the object has no element of
/// this kind, or if all of them are hidden.
Result<std::monostate> highlightNeighbor(State& state, slicing::ElementKind kind, bool forward);

/// Moves the focus to `w`, in the object's coordinates. Sets the focus to w / spacing, rounded to an integer within
/// ±kMaxFocus, and the offset to the rest, w − focus · spacing. The caller must ensure |w| ≤ kMaxOffset circumradii.
void moveFocusTo(State& state, double w);

/// Moves the focus upward, or downward if `upward` is false, to the next w at which the section changes its type. In a
/// field, this is the next critical w (see slicing::findCriticalSections()). In other objects, it is the w of the next
/// vertex (see slicing::nextVertexHeight()). Does nothing if there is none. Error: the error of `loader` if the search
/// is deferred.
Result<std::monostate> moveFocusToNextCritical(State& state, bool upward, ObjectLoader& loader);

}  // namespace oval4d::session
