#pragma once
// Changes the settings of a state, and checks their bounds.

#include <span>

#include "fields/field.hpp"
#include "session/object_loader.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// The maximum absolute value of an angle of a rotation in radians; larger doubles are imprecise.
inline constexpr double kMaxAngle = 1e6;

/// Returns whether these control points are valid as FieldSettings::fog: either none, or slicing::kMinFogControlPoints
/// … slicing::kMaxFogControlPoints points with increasing values within ±slicing::kMaxLevel, opacities of 0 … 1, and
/// colors of 24 bits.
bool isTransferFunction(std::span<const slicing::FogControlPoint> points);

/// Returns the levels of a field at first, which side of them is inside, and no fog.
slicing::FieldSettings initialFieldSettings(const fields::Field& field);

/// Replaces State::source by `source`, and State::object accordingly; does nothing if State::source is already this
/// object. Keeps the frame of reference, the orientation, and the ratio of the spacing to
/// slicing::initialSliceExtent(). Ends a turn toward an element, and playing. Sets back the settings that are
/// ResetOccasion::by_another_object or ResetOccasion::by_reset_or_another_object; the levels of a field, and which side
/// of them is inside, become those of the new field. If only the new object has a second function, sets
/// Coloring::value; if only the old object has one, replaces Coloring::value by Coloring::cell. Error: that of
/// `loader`, if it defers transforming the object to the frame of reference; the state is then unchanged.
Result<std::monostate> replaceObject(State& state, slicing::Object source, ObjectLoader& loader);

/// Keeps the settings of a field if `load` has replaced the part of an array in the data folder that `before` shows by
/// another part of it, or by the whole array, under the same name: its values measure the same. `next` is the state
/// after replaceObject(), which gets the field settings and the hidden and faded kinds of `before`, except levels that
/// nobody has changed: each part has initial levels of its own. Does nothing after any other load.
void keepSettingsOfPart(const State& before, const LoadObject& load, State& next);

/// Sets the orientation back to the initial one, and ends all motion.
void returnToInitialOrientation(State& state);

/// Calls returnToInitialOrientation(), and sets back the settings that are ResetOccasion::by_reset_or_another_object.
void resetOrientationAndFocus(State& state);

/// Returns whether the slices have the spacing spanningSpacing(), apart from rounding.
bool hasSpanningSpacing(const State& state);

/// Shows the object in another frame of reference; does nothing if the state has this frame already. The caller must
/// ensure that the members of `frame` are within their bounds (see geometry::ReferenceFrame). If the slices have the
/// spacing spanningSpacing(), as they do initially, they also have it in the new frame, and the w of the focus slice
/// stays the same; otherwise, the slices stay the same. In both cases, spacing, offset and focus point are clamped to
/// their bounds, which depend on the circumradius. Ends a turn toward an element. Error: that of `loader`, if it defers
/// the transformation; the state is then unchanged.
Result<std::monostate> changeReferenceFrame(State& state, const geometry::ReferenceFrame& frame, ObjectLoader& loader);

/// Changes the number of slices. If the old and the new count are greater than 1, also changes the spacing, within its
/// bounds, so that the span (count − 1) · spacing stays the same.
void setSliceCount(State& state, int count);

/// Applies the settings that are present in `set`. After an error, some of these settings may have been applied, so
/// callers must pass a copy of the state. Errors: those of findObject(); `not_a_rotation`; `out_of_range`;
/// `nothing_to_undo` if `set` starts continuous turning, but no rotation has been made that could be repeated.
Result<std::monostate> applySet(State& state, const Set& set, const LoadedObjects& loaded, const Limits& limits,
                                ObjectLoader& loader);

/// Returns the settings of a state. If another state shows the same object, applySet() with these settings makes it
/// equal to `state`, except for the orientation, the last rotation and the motion, which the settings do not contain.
Set settingsOf(const State& state);

/// Returns the error `out_of_range` unless the angles are finite and within ±kMaxAngle.
Result<std::monostate> checkTurn(const geometry::Turn& turn);

/// Returns the error `out_of_range` if the object has no such element.
Result<std::monostate> checkElement(const slicing::Object& object, const slicing::Element& element);

/// Rotates the object, stores the rotation as State::lastTurn, and ends a turn toward an element.
void rotate(State& state, const geometry::Turn& turn);

/// Starts to turn the object toward the orientation in which the element points to +w; with TurnToward::immediately,
/// rotates it to this orientation at once. Without TurnToward::number, slicing::elementToTurnTo() chooses an element
/// of the kind TurnToward::element: the one closest to +w or, if that already points there, the next one. If an element
/// is highlighted, only this element and those that contain it or are contained in it can be chosen. Ends continuous
/// turning. Error: `out_of_range` if the object has no such element.
Result<std::monostate> turnToward(State& state, const TurnToward& command);

/// Highlights the element of this kind whose index comes after that of the highlighted element or, if `forward` is
/// false, before it. Skips hidden elements: those whose cells are all of types in CellTypeFilter::hidden. The last and
/// the first element are neighbors. If no element of this kind is highlighted, begins with the first visible one that
/// the focus slice cuts (see slicing::elementsCutBy()) or, if it cuts none, with the first visible one. Error:
/// `out_of_range` if the object has no element of this kind, or if all of them are hidden.
Result<std::monostate> highlightNeighbor(State& state, slicing::ElementKind kind, bool forward);

/// Moves the focus to this w, in the object's coordinates: sets the focus to the slice that would be closest to w if
/// the offset were 0, and the offset to the difference. The caller must ensure |w| ≤ kMaxOffset circumradii.
void moveFocusTo(State& state, double w);

/// Moves the focus upward, or downward if `upward` is false, to the next w at which the section changes its type. For a
/// field, this is the next critical w (see slicing::findCriticalSections()); for other objects, the w of the next
/// vertex (see slicing::nextVertexHeight()). Does nothing if there is none. Error: that of `loader`, if it defers the
/// search.
Result<std::monostate> moveFocusToCritical(State& state, bool upward, ObjectLoader& loader);

}  // namespace oval4d::session
