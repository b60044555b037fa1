#pragma once

#include <utility>
#include <variant>

#include "fields/field.hpp"
#include "slicing/object.hpp"

namespace oval4d::slicing {

/// A visitor for std::visit, made of one function for each kind of object. If a kind has no function, the code does not
/// compile.
template <typename... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <typename... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;  // Clang 16 has no implicit deduction guides for aggregates

/// Calls `visitor` with the PolytopePtr or CloudPtr in an object or, for a field, with the PolytopePtr of its domain.
/// Returns the result of this call.
template <typename V>
decltype(auto) visitPolytopeOrCloud(const V& visitor, const Object& object) {
    return std::visit(Overloaded{[&](const PolytopePtr& p) -> decltype(auto) { return visitor(p); },
                                 [&](const CloudPtr& cloud) -> decltype(auto) { return visitor(cloud); },
                                 [&](const FieldPtr& field) -> decltype(auto) { return visitor(field->domain); }},
                      object);
}

}  // namespace oval4d::slicing
