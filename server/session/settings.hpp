#pragma once
// Setting the members of a state, each within its bounds.

#include <map>
#include <string>
#include <string_view>

#include "session/session.hpp"
#include "session/workshop.hpp"

namespace oval4d::session {

using Loaded = std::map<std::string, PolytopePtr, std::less<>>;

/// Bounds that do not depend on the server.
inline constexpr double kMaxAngle = 1e6;     ///< of one rotation, radians: beyond, a double loses the direction
inline constexpr int kMaxFocus = 1'000'000;  ///< of the focus index, either way
inline constexpr double kMinSpacing = 1e-6;  ///< in circumradii
inline constexpr double kMaxSpacing = 10;    ///< in circumradii
inline constexpr double kMaxOrbit = 1000;    ///< azimuth and elevation, radians
inline constexpr double kMinZoom = 0.05, kMaxZoom = 20;

/// The loaded polytope of this name, or the one that geometry::designNamed finds; else `unknown_polytope` with the
/// nearest names or what is wrong, or `too_large`; or what `workshop` says.
protocol::Result<PolytopePtr> findPolytope(std::string_view name, const Loaded& loaded, const Limits& limits,
                                           Workshop& workshop);

/// Shows another polytope: the orientation stays, the spacing keeps its ratio to the circumradius, the focus is 0, and
/// all kinds of cells are seen.
void show(State& state, PolytopePtr polytope);

/// Changes the number of slices and keeps their span.
void setCount(State& state, int count);

/// Sets what `set` holds. On an error `state` is half set: work on a copy.
protocol::Result<std::monostate> applySet(State& state, const protocol::Set& set, const Loaded& loaded,
                                          const Limits& limits, Workshop& workshop);

/// `out_of_range` unless the angles are finite and at most kMaxAngle.
protocol::Result<std::monostate> checkTurn(const geometry::Turn& turn);

/// Turns the polytope.
void rotate(State& state, const geometry::Turn& turn);

}  // namespace oval4d::session
