#pragma once
// JSON text into a value, with limits that nlohmann-json does not have of its own.

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace oval4d::protocol {

struct JsonText {
    nlohmann::json value;   ///< usable where `fault` is empty or `repaired`
    std::string fault;      ///< a sentence on what is wrong, or empty
    bool notJson = false;   ///< not JSON at all
    bool repaired = false;  ///< only some numbers were wrong (NaN, Infinity, 1e999): each reads as null in `value`
};

/// Reads JSON text that nests at most `maxDepth` deep and holds at most 10,000 values. Numbers that are whole are
/// integers, however they are written (21.0), as JSON Schema has it.
JsonText readJson(std::string_view text, int maxDepth);

}  // namespace oval4d::protocol
