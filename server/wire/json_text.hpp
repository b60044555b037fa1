#pragma once
// Parses JSON text, with limits that nlohmann-json does not provide.

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace oval4d::wire {

/// The result of readJson.
struct JsonText {
    nlohmann::json value;   ///< valid if `fault` is empty or `repaired` is true
    std::string fault;      ///< the error message; empty if there is no error
    bool notJson = false;   ///< the text is not JSON
    bool repaired = false;  ///< the only errors are numbers that are not finite (NaN, 1e999); `value` has null for each
};

/// Parses JSON text with at most `maxDepth` levels of nesting and at most 10,000 values. Numbers with an integral
/// value, such as 21.0, become integers, as in JSON Schema.
JsonText readJson(std::string_view text, int maxDepth);

}  // namespace oval4d::wire
