#pragma once

namespace oval4d::slicing {

/// A visitor for std::visit that combines one function for each kind of object. A missing function is a compile error.
template <typename... Functions>
struct Visitor : Functions... {
    using Functions::operator()...;
};
template <typename... Functions>
Visitor(Functions...) -> Visitor<Functions...>;  // Clang 16 has no implicit deduction guides for aggregates

}  // namespace oval4d::slicing
