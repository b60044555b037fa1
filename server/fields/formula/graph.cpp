#include "fields/formula/graph.hpp"

#include <bit>
#include <cmath>
#include <utility>

namespace oval4d::fields {

namespace {

// The greatest absolute value of an exponent of integer_power. For greater exponents, pow is more accurate than the
// many multiplications of integer_power.
constexpr double kMaxIntegerExponent = 64;

bool isPowerOfTwo(double value) {
    int exponent = 0;
    return std::isfinite(value) && std::abs(std::frexp(value, &exponent)) == 0.5 && std::abs(exponent) < 100;
}

}  // namespace

OperationGraph::NodeIndex OperationGraph::findOrAddNode(Operation operation, NodeIndex a, NodeIndex b, double number) {
    const auto [found, isNew] = known_.try_emplace({operation, a, b, std::bit_cast<std::uint64_t>(number)},
                                                   static_cast<NodeIndex>(nodes_.size()));
    if (isNew) nodes_.push_back({operation, a, b, number});
    return found->second;
}

OperationGraph::NodeIndex OperationGraph::constant(double value) {
    return findOrAddNode(Operation::constant, 0, 0, value);
}

OperationGraph::NodeIndex OperationGraph::variable(int axis) { return findOrAddNode(Operation::variable, 0, 0, axis); }

std::optional<double> OperationGraph::constantAt(NodeIndex node) const {
    if (nodes_[node].operation != Operation::constant) return {};
    return nodes_[node].number;
}

OperationGraph::NodeIndex OperationGraph::unaryNode(Operation operation, NodeIndex a) {
    if (const auto value = constantAt(a)) return constant(applyOperation(operation, *value, 0));
    const Operation inner = nodes_[a].operation;
    if (inner == Operation::negate) {
        if (operation == Operation::negate) return nodes_[a].a;
        const bool isEven =
            operation == Operation::abs || operation == Operation::square || operation == Operation::cos;
        if (isEven) return unaryNode(operation, nodes_[a].a);
    }
    if (operation == Operation::abs && (inner == Operation::abs || inner == Operation::square)) return a;
    return findOrAddNode(operation, a, 0, 0);
}

OperationGraph::NodeIndex OperationGraph::binaryNode(Operation operation, NodeIndex a, NodeIndex b) {
    const auto left = constantAt(a), right = constantAt(b);
    if (left && right) return constant(applyOperation(operation, *left, *right));
    if (operation == Operation::power && right) return power(a, *right);
    const bool commutes = operation == Operation::add || operation == Operation::multiply ||
                          operation == Operation::min || operation == Operation::max;
    if (commutes && (left || (!right && a > b))) std::swap(a, b);  // a constant becomes the right operand
    if (const auto simple = simplified(operation, a, b)) return *simple;
    return findOrAddNode(operation, a, b, 0);
}

// Returns the node of a power. First rounds the exponent to a float, so that the kernels (in floats) and interval
// arithmetic (in doubles) agree on whether it is an integer.
OperationGraph::NodeIndex OperationGraph::power(NodeIndex a, double exponent) {
    exponent = static_cast<float>(exponent);
    const bool isInteger = std::floor(exponent) == exponent && std::abs(exponent) <= kMaxIntegerExponent;
    if (exponent == 0) return constant(1);
    if (exponent == 1) return a;
    if (exponent == -1) return divide(constant(1), a);
    if (exponent == 2) return square(a);
    if (isInteger) return findOrAddNode(Operation::integer_power, a, 0, exponent);
    if (exponent == 0.5) return sqrt(a);
    if (exponent == -0.5) return divide(constant(1), sqrt(a));
    return findOrAddNode(Operation::power, a, constant(exponent), 0);
}

// Returns the node of a simpler expression with the same values. Returns an empty optional if the operation cannot be
// simplified. If the operation is commutative, `a` must not be a constant.
std::optional<OperationGraph::NodeIndex> OperationGraph::simplified(Operation operation, NodeIndex a, NodeIndex b) {
    const auto left = constantAt(a), right = constantAt(b);
    switch (operation) {
        case Operation::add:
            if (right == 0) return a;
            if (isNegated(b)) return subtract(a, nodes_[b].a);
            if (isNegated(a)) return subtract(b, nodes_[a].a);
            return {};
        case Operation::subtract:
            if (right == 0) return a;
            if (left == 0) return negate(b);
            if (isNegated(b)) return add(a, nodes_[b].a);
            return {};
        case Operation::multiply:
            if (a == b) return square(a);
            if (right == 1) return a;
            if (right == -1) return negate(a);
            if (isNegated(a) && right) return multiply(nodes_[a].a, constant(-*right));
            if (isNegated(a) && isNegated(b)) return multiply(nodes_[a].a, nodes_[b].a);
            return {};
        case Operation::divide:
            if (right && isPowerOfTwo(*right)) return multiply(a, constant(1 / *right));
            return {};
        case Operation::min:
        case Operation::max:
            if (a == b) return a;
            return {};
        default:
            return {};
    }
}

}  // namespace oval4d::fields
