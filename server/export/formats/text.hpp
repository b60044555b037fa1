#pragma once
// Text formatting of numbers and names.

#include <string>
#include <string_view>

#include <glm/vec3.hpp>

namespace oval4d::exports {

/// Appends the shortest decimal text that reads back as the same number.
void append(std::string& out, double number);
void append(std::string& out, float number);
/// Appends three numbers separated by spaces.
void append(std::string& out, const glm::dvec3& point);

/// A label such as "w = −0.25", with enough decimals to distinguish neighboring slices.
std::string labelOfW(double w, double spacing);

/// Escapes text for XML content and attributes: & < > and quotes become entities, and control characters are dropped.
std::string xmlEscaped(std::string_view text);

}  // namespace oval4d::exports
