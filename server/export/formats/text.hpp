#pragma once
// Writes numbers and names as text.

#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "geometry/hyperplanes.hpp"

namespace oval4d::exports {

/// Appends the shortest decimal text from which exactly this number is read back, such as "0.1" or "1e+30".
void appendDecimal(std::string& out, double number);
void appendDecimal(std::string& out, float number);
/// Appends the three coordinates, separated by spaces.
void appendDecimal(std::string& out, const glm::dvec3& point);

/// Returns the label of hyperplane i (from 0), such as "w = −0.25". The label has enough decimals (2 to 9) to
/// distinguish the hyperplanes. `origin` is the w of ObjectInfo::originInFile, and is added to w.
std::string labelOfW(const geometry::Hyperplanes& planes, int i, double origin = 0);

/// Returns the UTF-8 text without the characters that XML 1.0 forbids (section 2.2): control characters below U+0020,
/// U+FFFE and U+FFFF. Also removes tabs and line ends, which XML allows, so that the result is one line in any text
/// format.
std::string removeNonXmlCharacters(std::string_view text);

/// Returns the result of removeNonXmlCharacters(), escaped for XML content and attributes: &, <, > and quotes become
/// entities.
std::string xmlEscaped(std::string_view text);

}  // namespace oval4d::exports
