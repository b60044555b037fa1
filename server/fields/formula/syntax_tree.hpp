#pragma once
// The syntax tree of a formula. The parser returns the tree, formulaText() writes the tree as text, and buildGraph()
// converts the tree to a graph.

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
    double value = 0;  ///< a finite number

    bool operator==(const FormulaConstant&) const = default;
};

/// The comparison of the two sides of a formula; `none` if the formula is not a comparison.
enum class ComparisonRelation : std::uint8_t { none, equal, less, less_equal, greater, greater_equal };

/// A node of a syntax tree: a number, a name, an operation or a call.
struct SyntaxNode {
    enum class NodeKind : std::uint8_t {
        number,  ///< the value is `number`, which is not negative
        pi,
        phi,
        variable,    ///< `index` is 0 … 3 for x … w, and 4 for r
        constant,    ///< `index` is an index into ParsedFormula::constants
        expression,  ///< `index` is an index into SyntaxTree::expressions
        negate,
        add,
        subtract,
        multiply,
        divide,
        power,
        call,  ///< `index` is an index into builtinFunctions()
    };
    NodeKind kind = NodeKind::number;
    std::uint32_t index = 0;
    std::uint32_t firstOperand = 0, operandCount = 0;  ///< the operands: a range of SyntaxTree::operands
    double number = 0;
};

/// A named expression of a formula, such as q in "q^2 - 1; q=x*y".
struct NamedExpression {
    std::string name;
    std::uint32_t root = 0;  ///< the node that the name stands for
};

/// A formula as a tree. Signs are normalized: no operand of a product, quotient or negation is a negation, nor is the
/// second operand of a sum or difference.
struct SyntaxTree {
    static constexpr std::uint32_t kR = 4;  ///< the index of the variable r

    std::vector<SyntaxNode> nodes;  ///< each node follows its operands, and is an operand of at most one node
    std::vector<std::uint32_t> operands;
    /// The named expressions; an expression uses only earlier expressions. The nodes of all expressions precede those
    /// of the formula itself.
    std::vector<NamedExpression> expressions;
    ComparisonRelation relation = ComparisonRelation::none;
    std::uint32_t left = 0, right = 0;  ///< the root nodes of the two sides of a comparison; `left` only, without a
                                        ///< comparison
    /// The numbers of constants and of expressions that the shared formula defines (see parseSyntax()). These constants
    /// come first in ParsedFormula::constants, and these expressions in `expressions`.
    std::size_t sharedConstants = 0, sharedExpressions = 0;

    std::span<const std::uint32_t> operandsOf(const SyntaxNode& node) const {
        return std::span(operands).subspan(node.firstOperand, node.operandCount);
    }
};

/// Adds the tree to the graph, with these values of the constants. Returns the graph's node of the formula's function:
/// left without a comparison, right − left if the relation is greater or greater_equal, and left − right for other
/// comparisons.
OperationGraph::NodeIndex buildGraph(const SyntaxTree& tree, std::span<const FormulaConstant> constants,
                                     OperationGraph& graph);

/// Returns the tree as text with as few parentheses as possible. If `isSpaced`, writes spaces outside of parentheses.
/// Parsing this text, with the same `shared` formula (see parseSyntax()), gives the same function. The text never nests
/// more deeply than the text from which the tree was parsed.
std::string formulaText(const SyntaxTree& tree, std::span<const FormulaConstant> constants, bool isSpaced);

}  // namespace oval4d::fields
