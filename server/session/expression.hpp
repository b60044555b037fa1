#pragma once
// Arithmetic as typed on the ':' line and in queries: "pi/sqrt(3)-pi/8".

#include <string_view>
#include <vector>

#include "geometry/rotation.hpp"
#include "protocol/cpp/error.hpp"

namespace oval4d::session {

/// Evaluates + − * / ^, brackets, numbers with exponents, `pi`, `phi`, and sqrt, sin, cos, tan, asin, acos, atan,
/// deg (degrees to radians). The result is finite, or the error says where the text went wrong.
protocol::Result<double> evaluate(std::string_view text);

/// "xw,yz" and one or two angle expressions, as the command line and the query `rotate=xw,yz:pi/8,0.2` give them.
protocol::Result<geometry::Turn> makeTurn(std::string_view planes, const std::vector<std::string_view>& angles);

/// "xw,yz:pi/8,0.2" as in a query or an option.
protocol::Result<geometry::Turn> parseTurn(std::string_view text);

}  // namespace oval4d::session
