#pragma once
// Numbers as text.

#include <string>
#include <string_view>

#include <glm/vec3.hpp>

namespace oval4d::exports {

/// The shortest decimals that read back as the same number.
void append(std::string& out, double number);
void append(std::string& out, float number);
/// Three of them, with blanks between.
void append(std::string& out, const glm::dvec3& point);

/// "w = −0.25": for people, with as many decimals as tell neighbouring slices apart.
std::string labelOfW(double w, double spacing);

}  // namespace oval4d::exports
