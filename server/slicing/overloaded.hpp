#pragma once

#include <concepts>
#include <memory>
#include <variant>

#include "fields/field.hpp"
#include "geometry/cell_complex.hpp"
#include "geometry/point_cloud.hpp"
#include "polytopes/polytope.hpp"
#include "slicing/object.hpp"

namespace oval4d::slicing {

/// A visitor for std::visit, made of one function for each kind of object. If a function for one kind is missing, the
/// code does not compile.
template <typename... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <typename... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;  // Clang 16 has no implicit deduction guides for aggregates

/// Calls `visitor` with the elements of an object: as a const geometry::CellComplex& or, for a point cloud, as a const
/// geometry::PointCloud&. For a field, passes its domain. Returns what `visitor` returns.
template <typename V>
decltype(auto) visitElements(const V& visitor, const Object& object) {
    return std::visit(Overloaded{[&]<std::derived_from<geometry::CellComplex> Complex>(
                                     const std::shared_ptr<const Complex>& complex) -> decltype(auto) {
                                     return visitor(static_cast<const geometry::CellComplex&>(*complex));
                                 },
                                 [&](const CloudPtr& cloud) -> decltype(auto) { return visitor(*cloud); },
                                 [&](const FieldPtr& field) -> decltype(auto) {
                                     return visitor(static_cast<const geometry::CellComplex&>(*field->domain));
                                 }},
                      object);
}

}  // namespace oval4d::slicing
