#pragma once
// Arithmetic expressions on the page's command line and in queries, such as "pi/sqrt(3)-pi/8".

#include <string_view>
#include <vector>

#include "errors/error.hpp"
#include "geometry/rotation.hpp"

namespace oval4d::session {

/// Evaluates an arithmetic expression that is not an angle. The expression may contain + − * / ^, parentheses, decimal
/// numbers with or without exponent, `pi`, `phi`, and the functions sqrt, sin, cos, tan, asin, acos, atan and deg
/// (which converts degrees to radians). Only the arguments of functions may have units of angles. Error:
/// `bad_expression` for a syntax error, for a unit elsewhere, or if the value is not finite. The message states the
/// position of the syntax error or the unit.
Result<double> evaluateNumber(std::string_view text);

/// Evaluates one or more expressions that are not angles, separated by commas. Errors: the errors of evaluateNumber().
Result<std::vector<double>> evaluateList(std::string_view text);

/// Returns whether a word is a unit that evaluateAngle() reads, such as "deg" or "°".
bool isAngleUnit(std::string_view word);

/// Evaluates an arithmetic expression that is an angle, and returns the angle in radians. The units ° and deg (both
/// degrees) and rad (radians) may follow a number, a name or a parenthesis. The characters º and ˚, which look like °,
/// are read as °. A unit applies to the whole product that contains it: 45/2° is 22.5°. Error `bad_expression`: for a
/// syntax error; for a value that is not finite; for a product with two units; for a unit of degrees after an angle in
/// radians, such as pi/8°. Error `out_of_range`: if the numbers without a unit sum up to more than a full turn, because
/// the user probably means degrees.
Result<double> evaluateAngle(std::string_view text);

/// Returns the rotation in the given planes by the given angles. `planes` lists one plane or two, such as "xw" or
/// "xw,yz". `angles` has one expression for evaluateAngle() for each plane. Error messages quote `examples`, which
/// shows how to write a rotation. Errors: `bad_expression` if a name is not a plane or occurs twice, or if the numbers
/// of planes and angles differ; the errors of evaluateAngle().
Result<geometry::RotationAngles> parsePlanesAndAngles(std::string_view planes,
                                                      const std::vector<std::string_view>& angles,
                                                      std::string_view examples);

/// Parses a rotation from a query or a command-line option, such as "xw,yz:pi/8,0.2". Errors: `bad_expression` if the
/// text has no colon; the errors of parsePlanesAndAngles().
Result<geometry::RotationAngles> parseTurn(std::string_view text);

}  // namespace oval4d::session
