#pragma once
// A formula as a directed acyclic graph of operations, simplified while it is built.

#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "fields/formula/operation.hpp"

namespace oval4d::fields {

/// A graph of the operations of a formula. Operations on constants are evaluated in double precision when they are
/// added, and equal nodes are shared. Simplifications preserve all values apart from the sign of zero. For example, x·0
/// and x − x are not replaced by 0, because they are NaN for infinite x. There is one exception: x⁰ becomes 1, even
/// though it is NaN where x is NaN.
class Graph {
  public:
    using Ref = std::uint32_t;  ///< the index of a node
    struct Node {
        Operation operation;
        Ref a = 0, b = 0;   ///< the operands, which precede the node
        double number = 0;  ///< a constant: its value; a variable: its axis, 0 … 3; integer_power: the exponent
    };

    Ref constant(double value);
    /// Returns the node of a coordinate. The axes 0, 1, 2, 3 are those of x, y, z, w.
    Ref variable(int axis);
    /// Returns the node of an operation on `a`. The operation must have one operand, and must not be integer_power.
    Ref unary(Operation operation, Ref a);
    Ref binary(Operation operation, Ref a, Ref b);

    Ref negate(Ref a) { return unary(Operation::negate, a); }
    Ref square(Ref a) { return unary(Operation::square, a); }
    Ref sqrt(Ref a) { return unary(Operation::sqrt, a); }
    Ref add(Ref a, Ref b) { return binary(Operation::add, a, b); }
    Ref subtract(Ref a, Ref b) { return binary(Operation::subtract, a, b); }
    Ref multiply(Ref a, Ref b) { return binary(Operation::multiply, a, b); }
    Ref divide(Ref a, Ref b) { return binary(Operation::divide, a, b); }

    /// Returns all nodes, each after its operands. Some of them may have no effect on the value of the formula.
    const std::vector<Node>& nodes() const { return nodes_; }
    /// Returns the value of the node if it is a constant; otherwise, an empty optional.
    std::optional<double> constantAt(Ref node) const;

  private:
    Ref node(Operation operation, Ref a, Ref b, double number);
    Ref power(Ref a, double exponent);
    std::optional<Ref> simplified(Operation operation, Ref a, Ref b);
    bool isNegated(Ref a) const { return nodes_[a].operation == Operation::negate; }

    std::vector<Node> nodes_;
    std::map<std::tuple<Operation, Ref, Ref, std::uint64_t>, Ref> known_;
};

}  // namespace oval4d::fields
