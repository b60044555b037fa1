#pragma once
// Percent-encoding in the addresses of the web (RFC 3986, section 2.1).

#include <optional>
#include <string>
#include <string_view>

namespace oval4d::text {

/// Decodes percent escapes. Returns nothing if a "%" is not followed by two hexadecimal digits.
std::optional<std::string> percentDecoded(std::string_view text);

/// Encodes all bytes but unreserved characters (letters, digits and -._~) and those in `plain`, which must not contain
/// "%".
std::string percentEncoded(std::string_view text, std::string_view plain = {});

}  // namespace oval4d::text
