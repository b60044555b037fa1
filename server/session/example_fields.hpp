#pragma once
// The fields that are known by name, like the polytopes of the catalogue.

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "fields/field.hpp"

namespace oval4d::session {

/// A field of protocol/fields.json.
struct ExampleField {
    std::string name, formula;
    fields::Box box;
    std::shared_ptr<const fields::Field> field;  ///< shared by all sessions
};

/// Returns the fields of protocol/fields.json. The first call compiles their formulas, which takes a few milliseconds.
std::span<const ExampleField> exampleFields();

/// Returns the example with this name, ignoring case; nullptr if there is none.
const ExampleField* exampleNamed(std::string_view name);

}  // namespace oval4d::session
