#pragma once
// Arithmetic expressions on the page's command line and in queries, such as "pi/sqrt(3)-pi/8".

#include <string_view>
#include <vector>

#include "errors/error.hpp"
#include "geometry/rotation.hpp"

namespace oval4d::session {

/// Evaluates an expression that is not an angle. It may contain + − * / ^, parentheses, decimal numbers with or without
/// exponent, `pi`, `phi`, and the functions sqrt, sin, cos, tan, asin, acos, atan and deg (degrees to radians). The
/// arguments of these functions may be angles with units. Error: `bad_expression` if the value is not finite, or if
/// there is a syntax error or a unit outside the argument of a function; for a syntax error and for a unit, the message
/// states the position.
Result<double> evaluate(std::string_view text);

/// Evaluates one or more expressions that are not angles, with commas between them. Errors: those of evaluate().
Result<std::vector<double>> evaluateList(std::string_view text);

/// Returns whether a word is a unit of evaluateAngle().
bool isAngleUnit(std::string_view word);

/// Evaluates an expression that is an angle, and returns it in radians. The units ° and deg (both degrees) and rad
/// (radians) may follow a number, a name or a parenthesis; º and ˚, which look like °, are read as °. A unit applies to
/// the whole product in which it stands: 45/2° is 22.5°. Error `bad_expression`: for a syntax error or a value that is
/// not finite; for a product with two units; and for an angle that is in radians already, but has a unit of degrees,
/// such as pi/8°. Error `out_of_range`: if the sum of those terms that are numbers without a unit is more than a full
/// turn, because degrees are probably meant.
Result<double> evaluateAngle(std::string_view text);

/// Returns the rotation in these planes by these angles. `planes` is a list of planes such as "xw" or "xw,yz" (see
/// geometry::Turn), and `angles` has one expression for each plane; see evaluateAngle(). `examples` shows how rotations
/// are written; error messages quote it. Errors: `bad_expression` if a name is no plane or occurs twice, or if the
/// numbers of planes and angles differ; those of evaluateAngle().
Result<geometry::Turn> parsePlanesAndAngles(std::string_view planes, const std::vector<std::string_view>& angles,
                                            std::string_view examples);

/// Parses a rotation given in a query or a command-line option, such as "xw,yz:pi/8,0.2". Errors: `bad_expression` if
/// the text has no colon; those of parsePlanesAndAngles().
Result<geometry::Turn> parseTurn(std::string_view text);

}  // namespace oval4d::session
