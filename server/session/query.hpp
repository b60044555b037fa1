#pragma once
// Converts parameters, which are pairs of names and values, to a state, and back. Parameters come from the query of an
// address, or from the options of `oval4d render` and `oval4d export`.

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

/// The names of parameters that do not describe the state: in the query of a picture, and in the query of an exported
/// file. The callers of stateFromQuery() read and remove these parameters before the call.
inline constexpr auto kPictureParameters = std::to_array<std::string_view>({"width", "height"});
inline constexpr auto kFileParameters =
    std::to_array<std::string_view>({"of", "body", "size", "label", "at", "fit", "exact"});

/// The parameter that means the same as kPolytope, for those who look for a field.
inline constexpr std::string_view kField = "field";

/// Parses the ranges of x, y, z and w: eight numbers or expressions, separated by commas. `name` is what errors call
/// the box. Errors: `bad_expression` and those of evaluate().
Result<fields::Box> parseBox(std::string_view text, std::string_view name = "box");

/// Parses the point about which an object turns: "object", "origin", or four numbers or expressions, separated by
/// commas. Errors: `bad_expression` and those of evaluate().
Result<geometry::Centering> parseCenter(std::string_view written);

/// Returns the state that a query describes. The names in the query are those that parseSetting() accepts; "field",
/// which is another name of "polytope"; "formula", "box" and "values", which describe a field; "rotate", which may
/// occur any number of times; and "toward", such as "cell" or "cell:3". Rotations are applied in the order given, and
/// "toward" after everything else. Settings that the query does not contain are those of `state`. `loader` provides the
/// polytopes. `others` are the names of further parameters, which the caller has read and removed. Errors:
/// `unknown_command` for an unknown name, with a list of the allowed names and of `others`; `bad_expression`; those of
/// parseSetting(), parseTurn(), checkTurn(), parseBox(), readFormula(), replaceObject(), parseElementKind(),
/// parseElementIndex(), turnToward() and applySet().
Result<State> stateFromQuery(const QueryParameters& query, const Limits& limits, ObjectLoader& loader,
                             State state = initialState(), std::span<const std::string_view> others = {});

/// Returns a query for the view that a state shows: from this query, stateFromQuery() makes a state that shows the
/// same, with the same settings. The query omits the last rotation, a motion that is under way, and the settings that
/// still have their initial values. Error: `unknown_polytope` if the object was read from a file or uploaded, because
/// an address cannot contain it.
Result<QueryParameters> queryFromState(const State& state, ObjectLoader& loader);

}  // namespace oval4d::session
