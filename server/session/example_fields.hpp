#pragma once
// The fields that are known by name, like the polytopes of the catalogue.

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fields/field.hpp"

namespace oval4d::session {

/// A field of protocol/fields.json.
struct ExampleField {
    std::string name, formula;
    std::vector<std::string> aliases;  ///< other names
    fields::Box box;
    std::shared_ptr<const fields::Field> field;  ///< shared by all sessions
};

/// Returns the fields of protocol/fields.json. The first call compiles their formulas, which takes a few milliseconds.
std::span<const ExampleField> exampleFields();

/// Returns the example with this name or alias, ignoring case, blanks and hyphens; nullptr if there is none.
const ExampleField* exampleNamed(std::string_view name);

}  // namespace oval4d::session
