#pragma once
// Converts parameters (pairs of a name and a value) to a state, and a state to parameters. Parameters come from the
// query of an address, or from the options of `oval4d render` and `oval4d export`.

#include <array>
#include <span>
#include <string_view>

#include "errors/error.hpp"
#include "fields/scalar_function.hpp"
#include "geometry/centering.hpp"
#include "session/object_loader.hpp"
#include "session/query_text.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// The names of parameters that do not describe the state. kPictureParameters occur in the query of a picture, and
/// kFileParameters in the query of an exported file. Callers of stateFromQuery() must remove these parameters from the
/// query first.
inline constexpr auto kPictureParameters = std::to_array<std::string_view>({"width", "height"});
inline constexpr auto kFileParameters =
    std::to_array<std::string_view>({"of", "body", "size", "label", "at", "fit", "exact"});

/// A parameter with the same meaning as kPolytope ("polytope"): users look for this name when they want a field.
inline constexpr std::string_view kField = "field";

/// Parses a box from the ranges of x, y, z and w: eight numbers or expressions, separated by commas. Error messages
/// call the box `name`. Errors: `bad_expression`, and the errors of evaluateNumber().
Result<fields::Box> parseBox(std::string_view text, std::string_view name = "box");

/// Parses the point about which an object turns: "object", "origin", or four numbers or expressions, separated by
/// commas. Errors: `bad_expression`, and the errors of evaluateNumber().
Result<geometry::Centering> parseCentering(std::string_view written);

/// Returns the state that a query describes. Names in the query may be: names that parseSetting() accepts; "field",
/// another name of "polytope"; "formula", "box" and "values", which describe a field; "rotate", any number of times;
/// "toward", with a value such as "cell" or "cell:3". Rotations are applied in the order given, and "toward" last.
/// Settings that the query does not contain come from `state`. `loader` provides the polytopes. `others` are names of
/// further parameters that the caller has already removed; an error message lists these names, too. Errors:
/// `unknown_command` for an unknown name; `bad_expression`; the errors of parseSetting(), parseTurn(), checkTurn(),
/// parseBox(), readFormula(), replaceObject(), parseElementKind(), parseElementIndex(), turnToward() and applySet().
Result<State> stateFromQuery(const QueryParameters& query, const Limits& limits, ObjectLoader& loader,
                             State state = initialState(), std::span<const std::string_view> others = {});

/// Returns a query for the view that a state shows. stateFromQuery() makes a state with the same view and the same
/// settings from this query. The query omits the last rotation, any motion in progress, and settings that have their
/// initial values. Error: `unknown_polytope` if the object was read from a file or uploaded, because an address cannot
/// contain such an object.
Result<QueryParameters> queryFromState(const State& state, ObjectLoader& loader);

}  // namespace oval4d::session
