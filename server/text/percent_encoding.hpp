#pragma once
// Percent-encoding in URLs (RFC 3986, section 2.1).

#include <optional>
#include <string>
#include <string_view>

namespace oval4d::text {

/// Decodes percent escapes. Returns an empty optional if a "%" is not followed by two hexadecimal digits.
std::optional<std::string> percentDecoded(std::string_view text);

/// Encodes all bytes except unreserved characters (letters, digits and -._~) and the characters in `plain`. `plain`
/// must not contain "%".
std::string percentEncoded(std::string_view text, std::string_view plain = {});

}  // namespace oval4d::text
