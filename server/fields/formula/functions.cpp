#include "fields/formula/functions.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

namespace oval4d::fields {

namespace {

using NodeIndex = OperationGraph::NodeIndex;
using ArgumentNodes = std::span<const NodeIndex>;
constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();

template <Operation operation>
NodeIndex unaryOperation(OperationGraph& graph, ArgumentNodes a) {
    return graph.unaryNode(operation, a[0]);
}

// Applies a binary operation to any number of arguments, from left to right.
template <Operation operation>
NodeIndex foldArguments(OperationGraph& graph, ArgumentNodes a) {
    NodeIndex result = a[0];
    for (const NodeIndex argument : a.subspan(1)) result = graph.binaryNode(operation, result, argument);
    return result;
}

NodeIndex hypot(OperationGraph& graph, ArgumentNodes a) {
    NodeIndex sum = graph.square(a[0]);
    for (const NodeIndex argument : a.subspan(1)) sum = graph.add(sum, graph.square(argument));
    return graph.sqrt(sum);
}

NodeIndex clamp(OperationGraph& graph, ArgumentNodes a) {
    return graph.binaryNode(Operation::min, graph.binaryNode(Operation::max, a[0], a[1]), a[2]);
}

NodeIndex mix(OperationGraph& graph, ArgumentNodes a) {
    return graph.add(a[0], graph.multiply(graph.subtract(a[1], a[0]), a[2]));
}

// Adds Quilez's polynomial smooth minimum: min(a, b) − k h² / 4 with h = max(1 − |a − b|/k, 0) if k > 0, otherwise
// min(a, b). `overlap` is k h = max(k − |a − b|, 0), so the correction k h² / 4 is overlap² / (4 k). For k ≤ 0,
// `overlap` is 0, and the positive divisor makes the correction 0 instead of 0/0.
NodeIndex smoothMin(OperationGraph& graph, ArgumentNodes a) {
    const NodeIndex distance = graph.unaryNode(Operation::abs, graph.subtract(a[0], a[1]));
    const NodeIndex overlap = graph.binaryNode(Operation::max, graph.subtract(a[2], distance), graph.constant(0));
    constexpr double kLeastDivisor = std::numeric_limits<float>::min();
    const NodeIndex divisor =
        graph.binaryNode(Operation::max, graph.multiply(a[2], graph.constant(4)), graph.constant(kLeastDivisor));
    const NodeIndex correction = graph.divide(graph.square(overlap), divisor);
    return graph.subtract(graph.binaryNode(Operation::min, a[0], a[1]), correction);
}

NodeIndex ceil(OperationGraph& graph, ArgumentNodes a) {
    return graph.negate(graph.unaryNode(Operation::floor, graph.negate(a[0])));
}

NodeIndex round(OperationGraph& graph, ArgumentNodes a) {
    return graph.unaryNode(Operation::floor, graph.add(a[0], graph.constant(0.5)));
}

NodeIndex radians(OperationGraph& graph, ArgumentNodes a) {
    return graph.multiply(a[0], graph.constant(std::numbers::pi / 180));
}

constexpr auto kFunctions = std::to_array<BuiltinFunction>({
    {"abs", "a", "the absolute value", 1, 1, unaryOperation<Operation::abs>},
    {"min", "a, b, ...", "the smallest value: the union of bodies", 2, kAny, foldArguments<Operation::min>},
    {"max", "a, b, ...", "the largest value: the intersection of bodies", 2, kAny, foldArguments<Operation::max>},
    {"smin", "a, b, k", "min with its edge smoothed where a and b differ by less than k", 3, 3, smoothMin},
    {"clamp", "a, low, high", "a, but not below low nor above high", 3, 3, clamp},
    {"mix", "a, b, t", "a + (b - a) t", 3, 3, mix},
    {"sqrt", "a", "the square root", 1, 1, unaryOperation<Operation::sqrt>},
    {"cbrt", "a", "the cube root, also of negative numbers", 1, 1, unaryOperation<Operation::cbrt>},
    {"hypot", "a, b, ...", "sqrt(a^2 + b^2 + ...)", 2, kAny, hypot},
    {"exp", "a", "e to the power of a", 1, 1, unaryOperation<Operation::exp>},
    {"log", "a", "the natural logarithm", 1, 1, unaryOperation<Operation::log>},
    {"sin", "a", "the sine of an angle in radians", 1, 1, unaryOperation<Operation::sin>},
    {"cos", "a", "the cosine", 1, 1, unaryOperation<Operation::cos>},
    {"tan", "a", "the tangent", 1, 1, unaryOperation<Operation::tan>},
    {"asin", "a", "the arcsine, in radians", 1, 1, unaryOperation<Operation::asin>},
    {"acos", "a", "the arccosine", 1, 1, unaryOperation<Operation::acos>},
    {"atan", "a", "the arctangent", 1, 1, unaryOperation<Operation::atan>},
    {"atan2", "b, a", "the angle of the point (a, b), from -pi to pi", 2, 2, foldArguments<Operation::atan2>},
    {"sinh", "a", "the hyperbolic sine", 1, 1, unaryOperation<Operation::sinh>},
    {"cosh", "a", "the hyperbolic cosine", 1, 1, unaryOperation<Operation::cosh>},
    {"tanh", "a", "the hyperbolic tangent", 1, 1, unaryOperation<Operation::tanh>},
    {"step", "a", "0 for negative a, otherwise 1", 1, 1, unaryOperation<Operation::step>},
    {"sign", "a", "-1, 0 or 1", 1, 1, unaryOperation<Operation::sign>},
    {"floor", "a", "the largest integer that is at most a", 1, 1, unaryOperation<Operation::floor>},
    {"ceil", "a", "the smallest integer that is at least a", 1, 1, ceil},
    {"round", "a", "the nearest integer", 1, 1, round},
    {"mod", "a, b", "a - b floor(a/b), which has the sign of b", 2, 2, foldArguments<Operation::mod>},
    {"deg", "a", "a degrees in radians", 1, 1, radians},
});

}  // namespace

std::span<const BuiltinFunction> builtinFunctions() { return kFunctions; }

std::optional<std::size_t> functionNamed(std::string_view name) {
    const auto found =
        std::find_if(kFunctions.begin(), kFunctions.end(), [name](const auto& f) { return f.name == name; });
    if (found == kFunctions.end()) return {};
    return static_cast<std::size_t>(found - kFunctions.begin());
}

}  // namespace oval4d::fields
