#pragma once
// Parses JSON text, with limits on nesting and size that nlohmann-json does not provide.

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace oval4d::wire {

/// The result of parseJson().
struct ParsedJson {
    nlohmann::json value;   ///< valid if `fault` is empty or `repaired` is true
    std::string fault;      ///< the error message; empty if there is no error
    bool notJson = false;   ///< whether the text is not JSON
    bool repaired = false;  ///< whether the only errors are numbers like NaN and 1e999, which became null in `value`,
                            ///< and lone surrogates in strings, which became U+FFFD
};

/// Parses JSON text. Allows at most `maxDepth` levels of nesting and at most 10,000 values. A number with an integral
/// value, such as 21.0, becomes an integer, as in JSON Schema.
ParsedJson parseJson(std::string_view text, int maxDepth);

}  // namespace oval4d::wire
