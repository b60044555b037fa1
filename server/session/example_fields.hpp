#pragma once
// The example fields: scalar fields with names, given by formulas in protocol/fields.json.

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fields/field.hpp"

namespace oval4d::session {

/// A field that protocol/fields.json lists.
struct ExampleField {
    std::string name, formula;
    std::vector<std::string> aliases;  ///< other names of the field
    fields::Box box;
    std::shared_ptr<const fields::Field> field;  ///< shared by all sessions
};

/// Returns the fields of protocol/fields.json. The first call compiles their formulas, which takes a few milliseconds.
std::span<const ExampleField> exampleFields();

/// Returns the example with this name or alias, ignoring case, blanks and hyphens; nullptr if there is none.
const ExampleField* exampleNamed(std::string_view name);

}  // namespace oval4d::session
