#pragma once

#include <string>
#include <string_view>

namespace oval4d::exports {

/// Returns UTF-8 text in ASCII, of which the texts in a Drawing consist: signs that units contain become words or signs
/// of ASCII, such as "um" for "µm", "degC" for "°C" and "m^-3" for "m⁻³"; "?" replaces every other character.
std::string asciiText(std::string_view text);

}  // namespace oval4d::exports
