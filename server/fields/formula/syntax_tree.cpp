#include "fields/formula/syntax_tree.hpp"

#include <numbers>
#include <string_view>
#include <utility>

#include "fields/formula/functions.hpp"
#include "text/message_text.hpp"

namespace oval4d::fields {

namespace {

using NodeKind = SyntaxNode::NodeKind;
using NodeIndex = OperationGraph::NodeIndex;

NodeIndex buildVariable(std::uint32_t index, OperationGraph& graph) {
    if (index != SyntaxTree::kR) return graph.variable(static_cast<int>(index));
    NodeIndex sum = graph.square(graph.variable(0));
    for (const int axis : {1, 2}) sum = graph.add(sum, graph.square(graph.variable(axis)));
    return graph.sqrt(sum);
}

// Adds the operation of `node`, a node of the tree, to the graph. Returns the new node of the graph. `operands` are the
// nodes of the graph for the operands of `node`.
NodeIndex buildNode(const SyntaxNode& node, std::span<const NodeIndex> operands,
                    std::span<const FormulaConstant> constants, OperationGraph& graph) {
    switch (node.kind) {
        case NodeKind::number:
            return graph.constant(node.number);
        case NodeKind::pi:
            return graph.constant(std::numbers::pi);
        case NodeKind::phi:
            return graph.constant(std::numbers::phi);
        case NodeKind::variable:
            return buildVariable(node.index, graph);
        case NodeKind::constant:
            return graph.constant(constants[node.index].value);
        case NodeKind::expression:
            break;  // does not occur: buildGraph() handles this kind
        case NodeKind::negate:
            return graph.negate(operands[0]);
        case NodeKind::add:
            return graph.add(operands[0], operands[1]);
        case NodeKind::subtract:
            return graph.subtract(operands[0], operands[1]);
        case NodeKind::multiply:
            return graph.multiply(operands[0], operands[1]);
        case NodeKind::divide:
            return graph.divide(operands[0], operands[1]);
        case NodeKind::power:
            return graph.binaryNode(Operation::power, operands[0], operands[1]);
        case NodeKind::call:
            return builtinFunctions()[node.index].build(graph, operands);
    }
    return 0;
}

std::string_view symbolOf(ComparisonRelation relation) {
    switch (relation) {
        case ComparisonRelation::none:
            return "";
        case ComparisonRelation::equal:
            return "=";
        case ComparisonRelation::less:
            return "<";
        case ComparisonRelation::less_equal:
            return "<=";
        case ComparisonRelation::greater:
            return ">";
        case ComparisonRelation::greater_equal:
            return ">=";
    }
    return "";
}

// The precedence of the outermost operation of an expression, from the operation that binds least to that which binds
// most.
enum class Precedence { sum, product, negation, power, unit, atom };

struct TextWithPrecedence {
    std::string text;
    Precedence precedence;

    // Returns the text; adds parentheses if its precedence is lower than `least`.
    std::string parenthesizedIfLooserThan(Precedence least) && {
        return precedence < least ? "(" + text + ")" : std::move(text);
    }
};

// A placeholder for a space that is written only outside of parentheses.
constexpr char kOuterSpace = '\1';

class FormulaWriter {
  public:
    FormulaWriter(const SyntaxTree& tree, std::span<const FormulaConstant> constants)
        : tree_(tree), constants_(constants) {
        written_.reserve(tree.nodes.size());
        for (const SyntaxNode& node : tree.nodes) written_.push_back(write(node));
    }

    std::string sideText(std::uint32_t node) { return std::move(written_[node].text); }

  private:
    TextWithPrecedence write(const SyntaxNode& node) {
        switch (node.kind) {
            case NodeKind::number:
                return {text::shortestDecimal(node.number), Precedence::atom};
            case NodeKind::pi:
                return {"pi", Precedence::atom};
            case NodeKind::phi:
                return {"phi", Precedence::atom};
            case NodeKind::variable:
                return {std::string(1, "xyzwr"[node.index]), Precedence::atom};
            case NodeKind::constant:
                return {constants_[node.index].name, Precedence::atom};
            case NodeKind::expression:
                return {tree_.expressions[node.index].name, Precedence::atom};
            case NodeKind::negate:
                return writeNegation(node);
            case NodeKind::add:
                return writeBinary(node, "\1+\1", Precedence::sum, Precedence::sum, Precedence::product);
            case NodeKind::subtract:
                return writeBinary(node, "\1-\1", Precedence::sum, Precedence::sum, Precedence::product);
            case NodeKind::multiply:
                return writeBinary(node, "*", Precedence::product, Precedence::product, Precedence::negation);
            case NodeKind::divide:
                return writeBinary(node, "/", Precedence::product, Precedence::product, Precedence::negation);
            case NodeKind::power:
                return writeBinary(node, "^", Precedence::power, Precedence::unit, Precedence::negation);
            case NodeKind::call:
                return writeCall(node);
        }
        return {};
    }
    std::string operandText(const SyntaxNode& node, std::size_t i, Precedence least) {
        return std::move(written_[tree_.operandsOf(node)[i]]).parenthesizedIfLooserThan(least);
    }
    // Writes a negation. The negation of a product is −a·b, without parentheses: the parser moves the sign of a factor
    // out of the product, so it makes the same tree of −a·b.
    TextWithPrecedence writeNegation(const SyntaxNode& node) {
        const bool isProduct = written_[tree_.operandsOf(node)[0]].precedence == Precedence::product;
        return {"-" + operandText(node, 0, Precedence::product),
                isProduct ? Precedence::product : Precedence::negation};
    }
    TextWithPrecedence writeBinary(const SyntaxNode& node, std::string_view symbol, Precedence own, Precedence left,
                                   Precedence right) {
        std::string text = operandText(node, 0, left);
        text += symbol;
        text += operandText(node, 1, right);
        return {std::move(text), own};
    }
    TextWithPrecedence writeCall(const SyntaxNode& node) {
        const std::string_view name = builtinFunctions()[node.index].name;
        if (name == "deg") return {operandText(node, 0, Precedence::atom) + "°", Precedence::unit};
        std::string text(name);
        for (std::size_t i = 0; i < node.operandCount; ++i) {
            text += i == 0 ? "(" : ",";
            text += operandText(node, i, Precedence::sum);
        }
        return {text + ")", Precedence::atom};
    }

    const SyntaxTree& tree_;
    std::span<const FormulaConstant> constants_;
    std::vector<TextWithPrecedence> written_;
};

std::string replaceOuterSpaceMarks(std::string_view text, bool isSpaced) {
    std::string spaced;
    int depth = 0;
    for (const char c : text) {
        if (c == '(') ++depth;
        if (c == ')') --depth;
        if (c != kOuterSpace) {
            spaced += c;
        } else if (isSpaced && depth == 0) {
            spaced += ' ';
        }
    }
    return spaced;
}

}  // namespace

OperationGraph::NodeIndex buildGraph(const SyntaxTree& tree, std::span<const FormulaConstant> constants,
                                     OperationGraph& graph) {
    std::vector<NodeIndex> built, operands;
    built.reserve(tree.nodes.size());
    for (const SyntaxNode& node : tree.nodes) {
        if (node.kind == NodeKind::expression) {
            built.push_back(built[tree.expressions[node.index].root]);
            continue;
        }
        operands.clear();
        for (const std::uint32_t operand : tree.operandsOf(node)) operands.push_back(built[operand]);
        built.push_back(buildNode(node, operands, constants, graph));
    }
    switch (tree.relation) {
        case ComparisonRelation::none:
            return built[tree.left];
        case ComparisonRelation::equal:
        case ComparisonRelation::less:
        case ComparisonRelation::less_equal:
            return graph.subtract(built[tree.left], built[tree.right]);
        case ComparisonRelation::greater:
        case ComparisonRelation::greater_equal:
            return graph.subtract(built[tree.right], built[tree.left]);
    }
    return built[tree.left];
}

std::string formulaText(const SyntaxTree& tree, std::span<const FormulaConstant> constants, bool isSpaced) {
    const std::string space(isSpaced ? 1 : 0, ' ');
    FormulaWriter writer(tree, constants);
    std::string text = replaceOuterSpaceMarks(writer.sideText(tree.left), isSpaced);
    if (tree.relation != ComparisonRelation::none) {
        text += space + std::string(symbolOf(tree.relation)) + space;
        text += replaceOuterSpaceMarks(writer.sideText(tree.right), isSpaced);
    }
    std::string_view separator = ";";
    const auto define = [&](const std::string& name, const std::string& value) {
        text += std::exchange(separator, ",");
        text += space + name + "=" + value;
    };
    for (const FormulaConstant& constant : constants.subspan(tree.sharedConstants))
        define(constant.name, text::shortestDecimal(constant.value));
    for (std::size_t i = tree.sharedExpressions; i < tree.expressions.size(); ++i)
        define(tree.expressions[i].name, replaceOuterSpaceMarks(writer.sideText(tree.expressions[i].root), false));
    return text;
}

}  // namespace oval4d::fields
