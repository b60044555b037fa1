#pragma once
// Parses JSON text with limits on nesting and size, which nlohmann-json does not have.

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace oval4d::wire {

/// Parsed JSON text, or the reason why the text is refused. The result of parseJson().
struct ParsedJson {
    nlohmann::json value;  ///< the parsed value; valid if `fault` is empty or `repaired` is true
    std::string fault;     ///< the error message; empty if there is no error
    bool notJson = false;  ///< whether the text is not JSON, and could not be repaired
    /// Whether all errors could be repaired in `value`: numbers such as NaN and 1e999 became null, and lone surrogates
    /// in strings became U+FFFD.
    bool repaired = false;
};

/// Parses JSON text with at most `maxDepth` levels of nesting and at most 10,000 values. A number with an integral
/// value within ±2^53, such as 21.0, becomes an integer, because it is one in JSON Schema.
ParsedJson parseJson(std::string_view text, int maxDepth);

}  // namespace oval4d::wire
