#pragma once

#include <string>
#include <string_view>

namespace oval4d::exports {

/// Converts UTF-8 text to ASCII, because texts in a Drawing must be ASCII. Signs in units become words or ASCII signs:
/// "µm" becomes "um", "°C" becomes "degC", and "m⁻³" becomes "m^-3". All other characters outside of ASCII become "?".
std::string asciiText(std::string_view text);

}  // namespace oval4d::exports
