#pragma once

#include <string>
#include <string_view>

namespace oval4d::exports {

/// Converts UTF-8 text to ASCII, because the texts in a Drawing are ASCII. Replaces the signs that units contain by
/// words or ASCII signs: "µm" becomes "um", "°C" becomes "degC", and "m⁻³" becomes "m^-3". Replaces every other
/// character that is not ASCII by "?".
std::string asciiText(std::string_view text);

}  // namespace oval4d::exports
