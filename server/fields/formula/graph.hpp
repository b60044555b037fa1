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
class OperationGraph {
  public:
    using NodeIndex = std::uint32_t;  ///< the index of a node
    struct Node {
        Operation operation;
        NodeIndex a = 0, b = 0;  ///< the operands, which precede the node
        double number = 0;       ///< a constant: its value; a variable: its axis, 0 … 3; integer_power: the exponent
    };

    NodeIndex constant(double value);
    /// Returns the node of a coordinate. The axes 0, 1, 2, 3 are those of x, y, z, w.
    NodeIndex variable(int axis);
    /// Returns the node of an operation on `a`. The operation must have one operand, and must not be integer_power.
    NodeIndex unaryNode(Operation operation, NodeIndex a);
    NodeIndex binaryNode(Operation operation, NodeIndex a, NodeIndex b);

    NodeIndex negate(NodeIndex a) { return unaryNode(Operation::negate, a); }
    NodeIndex square(NodeIndex a) { return unaryNode(Operation::square, a); }
    NodeIndex sqrt(NodeIndex a) { return unaryNode(Operation::sqrt, a); }
    NodeIndex add(NodeIndex a, NodeIndex b) { return binaryNode(Operation::add, a, b); }
    NodeIndex subtract(NodeIndex a, NodeIndex b) { return binaryNode(Operation::subtract, a, b); }
    NodeIndex multiply(NodeIndex a, NodeIndex b) { return binaryNode(Operation::multiply, a, b); }
    NodeIndex divide(NodeIndex a, NodeIndex b) { return binaryNode(Operation::divide, a, b); }

    /// Returns all nodes, each after its operands. Some of them may have no effect on the value of the formula.
    const std::vector<Node>& nodes() const { return nodes_; }
    /// Returns the value of the node if it is a constant; otherwise, an empty optional.
    std::optional<double> constantAt(NodeIndex node) const;

  private:
    NodeIndex findOrAddNode(Operation operation, NodeIndex a, NodeIndex b, double number);
    NodeIndex power(NodeIndex a, double exponent);
    std::optional<NodeIndex> simplified(Operation operation, NodeIndex a, NodeIndex b);
    bool isNegated(NodeIndex a) const { return nodes_[a].operation == Operation::negate; }

    std::vector<Node> nodes_;
    std::map<std::tuple<Operation, NodeIndex, NodeIndex, std::uint64_t>, NodeIndex> known_;
};

}  // namespace oval4d::fields
