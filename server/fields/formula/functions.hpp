#pragma once
// The functions that formulas may call.

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "fields/formula/graph.hpp"

namespace oval4d::fields {

/// A function that formulas may call, such as sqrt: a row of the table that builtinFunctions() returns.
struct BuiltinFunction {
    std::string_view name;
    std::string_view arguments;  ///< the arguments as shown in help, such as "a, b"
    std::string_view meaning;    ///< the explanation shown in help
    std::size_t minArguments, maxArguments;
    /// Adds the operations of a call of the function to the graph. Returns the node of the result.
    OperationGraph::NodeIndex (*build)(OperationGraph& graph, std::span<const OperationGraph::NodeIndex> arguments);
};

/// Returns all functions that formulas may call.
std::span<const BuiltinFunction> builtinFunctions();

/// Returns the index in builtinFunctions() of the function with this name; an empty optional if there is none.
std::optional<std::size_t> functionNamed(std::string_view name);

}  // namespace oval4d::fields
