#pragma once

namespace oval4d::slicing {

/// A visitor for std::visit, made of one function per kind of object. A kind without a function does not compile.
template <typename... Functions>
struct Visitor : Functions... {
    using Functions::operator()...;
};
template <typename... Functions>
Visitor(Functions...) -> Visitor<Functions...>;  // Clang 16 has no implicit deduction guides for aggregates

}  // namespace oval4d::slicing
