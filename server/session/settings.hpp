#pragma once
// Changes the settings of a state, and checks their bounds.

#include "session/object_loader.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// Bounds that do not depend on the server's options.
inline constexpr double kMaxAngle = 1e6;     ///< absolute value of an angle in radians; larger doubles are imprecise
inline constexpr int kMaxFocus = 1'000'000;  ///< absolute value of the focus index
inline constexpr double kMinSpacing = 1e-6;  ///< as a multiple of the object's circumradius
inline constexpr double kMaxSpacing = 10;    ///< as a multiple of the object's circumradius
inline constexpr double kMaxOffset = 10;     ///< absolute value of the offset, as a multiple of the circumradius
inline constexpr double kMaxTurnTowardSeconds = 10;  ///< OngoingTurnToward::seconds
inline constexpr double kMaxOrbitAngle = 1000;       ///< absolute value of azimuth and elevation in radians
inline constexpr double kMinZoom = 0.05, kMaxZoom = 20;
inline constexpr double kMinEye = 1.05, kMaxEye = 1000;  ///< in circumradii

/// Replaces the object of the state; does nothing if the object is the same. Keeps the orientation, and the ratio of
/// the spacing to the circumradius. Sets focus, offset and focus point to 0, makes all cell types fully visible,
/// removes the highlight, and ends a turn toward an element.
void replaceObject(State& state, slicing::Object object);

/// Changes the number of slices. If the old and the new count are greater than 1, also changes the spacing, within its
/// bounds, so that the span (count − 1) · spacing stays the same.
void setCount(State& state, int count);

/// Applies the settings that are present in `set`. If it returns an error, some of them may be applied already, so
/// callers must pass a copy of the state. Errors: those of findObject; `not_a_rotation`; `out_of_range`;
/// `nothing_to_undo` if `set` starts continuous turning, but no rotation has been made that could be repeated.
Result<std::monostate> applySet(State& state, const Set& set, const LoadedObjects& loaded, const Limits& limits,
                                ObjectLoader& loader);

/// Returns the error `out_of_range` unless the angles are finite and within ±kMaxAngle.
Result<std::monostate> checkTurn(const geometry::Turn& turn);

/// Rotates the object, stores the rotation as State::lastTurn, and ends a turn toward an element.
void rotate(State& state, const geometry::Turn& turn);

/// Starts to turn the object toward the orientation in which the element points to +w; with TurnToward::immediately,
/// rotates it to this orientation at once. Ends continuous turning. Error: `out_of_range` if the object has no such
/// element.
Result<std::monostate> turnToward(State& state, const TurnToward& command);

/// Moves the focus to this w, in the object's units: sets the focus to the slice that would be closest to w if the
/// offset were 0, and the offset to the difference. Requires |w| ≤ kMaxOffset circumradii.
void moveFocusTo(State& state, double w);

/// Moves the focus to the w of the next vertex above the focus slice or, if `upward` is false, below it: the section
/// changes its combinatorial type there (see slicing::nextVertexHeight). Does nothing if there is no such vertex.
void moveFocusToVertex(State& state, bool upward);

}  // namespace oval4d::session
