#pragma once
// Changes the settings of a state within their bounds.

#include "session/object_loader.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// Bounds that do not depend on the server's options.
inline constexpr double kMaxAngle = 1e6;     ///< of one rotation, radians; beyond it, a double is too imprecise
inline constexpr int kMaxFocus = 1'000'000;  ///< of the absolute value of the focus index
inline constexpr double kMinSpacing = 1e-6;  ///< in circumradii
inline constexpr double kMaxSpacing = 10;    ///< in circumradii
inline constexpr double kMaxOrbit = 1000;    ///< of azimuth and elevation, radians
inline constexpr double kMinZoom = 0.05, kMaxZoom = 20;

/// Replaces the object, unless it is the same. The orientation stays, the spacing keeps its ratio to the circumradius,
/// the focus becomes 0, and all cell types become fully visible.
void show(State& state, slicing::Object object);

/// Changes the number of slices. Keeps the span (count − 1) · spacing if both counts are greater than 1 and the new
/// spacing is within its bounds.
void setCount(State& state, int count);

/// Applies the settings that are present in `set`. On an error, some of them may already be applied, so callers pass a
/// copy of the state.
Result<std::monostate> applySet(State& state, const Set& set, const Loaded& loaded, const Limits& limits,
                                ObjectLoader& loader);

/// Returns the error `out_of_range` unless the angles are finite and within ±kMaxAngle.
Result<std::monostate> checkTurn(const geometry::Turn& turn);

/// Rotates the object, and remembers the rotation as the last one.
void rotate(State& state, const geometry::Turn& turn);

}  // namespace oval4d::session
