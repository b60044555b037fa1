#pragma once
// The syntax tree of a formula. The parser returns the tree; toText() writes a tree as text, and buildGraph() converts
// a tree to a graph.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fields/formula/graph.hpp"

namespace oval4d::fields {

/// A named constant of a formula, such as a in "x^2+y^2-a^2; a=0.7".
struct FormulaConstant {
    std::string name;
    double value = 0;  ///< finite

    bool operator==(const FormulaConstant&) const = default;
};

/// How the two sides of a formula are compared; `none` if the formula is not a comparison.
enum class Relation : std::uint8_t { none, equal, less, less_equal, greater, greater_equal };

/// A node of a syntax tree: a number, a name, an operation or a call.
struct SyntaxNode {
    enum class NodeKind : std::uint8_t {
        number,  ///< the value is `number`, which is not negative
        pi,
        phi,
        variable,    ///< `index`: 0 … 3 for x … w; 4 for r
        constant,    ///< `index`: in ParsedFormula::constants
        expression,  ///< `index`: in SyntaxTree::expressions
        negate,
        add,
        subtract,
        multiply,
        divide,
        power,
        call,  ///< `index`: in functions()
    };
    NodeKind kind = NodeKind::number;
    std::uint32_t index = 0;
    std::uint32_t firstOperand = 0, operandCount = 0;  ///< a range of SyntaxTree::operands
    double number = 0;
};

/// A named expression of a formula, such as q in "q^2 - 1; q=x*y".
struct NamedExpression {
    std::string name;
    std::uint32_t root = 0;  ///< the node that the name stands for
};

/// A formula as a tree. Signs are normalized: an operand of a product, quotient or negation is not a negation, and
/// neither is the second operand of a sum or difference.
struct SyntaxTree {
    static constexpr std::uint32_t kR = 4;  ///< the index of the variable r

    std::vector<SyntaxNode> nodes;  ///< each follows its operands, and is an operand of at most one node
    std::vector<std::uint32_t> operands;
    /// Each expression uses only earlier ones. The nodes of all expressions precede those of the formula itself.
    std::vector<NamedExpression> expressions;
    Relation relation = Relation::none;
    std::uint32_t left = 0, right = 0;  ///< the root nodes of both sides; without a comparison, only `left` is used
    /// The number of constants and the number of expressions that the shared formula defines (see parseSyntax()). The
    /// shared constants and expressions come first in ParsedFormula::constants and in `expressions`.
    std::size_t sharedConstants = 0, sharedExpressions = 0;

    std::span<const std::uint32_t> operandsOf(const SyntaxNode& node) const {
        return std::span(operands).subspan(node.firstOperand, node.operandCount);
    }
};

/// Adds the tree to the graph, with these values of the constants. Returns the node of the formula's function: left −
/// right for a comparison, right − left if the relation is greater or greater_equal, and `left` without a comparison.
Graph::Ref buildGraph(const SyntaxTree& tree, std::span<const FormulaConstant> constants, Graph& graph);

/// Returns the tree as text, with as few parentheses as possible and, if `isSpaced`, with spaces outside of
/// parentheses. Parsing this text, with the same `shared` formula (see parseSyntax()), gives the same function. The
/// text never nests more deeply than the text from which the tree was parsed.
std::string toText(const SyntaxTree& tree, std::span<const FormulaConstant> constants, bool isSpaced);

}  // namespace oval4d::fields
