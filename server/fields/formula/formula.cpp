#include "fields/formula/formula.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "text/message_text.hpp"

namespace oval4d::fields {

namespace {

Error formulaError(std::string_view text, FormulaMistake mistake, FormulaMistake* copy) {
    Error result{ErrorCode::bad_expression,
                 text::inQuotes(text) + ", position " + std::to_string(mistake.position) + ": " + mistake.what};
    if (copy != nullptr) *copy = std::move(mistake);
    return result;
}

}  // namespace

Formula::Formula(ParsedFormula parsed, const FormulaLimits& limits)
    : parsed_(std::make_shared<const ParsedFormula>(std::move(parsed))), limits_(limits) {
    const auto& [tree, constants] = *parsed_;
    text_ = formulaText(tree, constants, true);
    if (text_.size() > limits_.bytes) text_ = formulaText(tree, constants, false);
    OperationGraph graph;
    const OperationGraph::NodeIndex result = buildGraph(tree, constants, graph);
    tape_ = std::make_shared<const Tape>(compileTape(graph, result));
}

std::string Formula::exceededLimitMessage() const {
    if (tape_->instructions.size() > limits_.instructions) {
        return "the formula needs " + std::to_string(tape_->instructions.size()) +
               " instructions; the most allowed are " + std::to_string(limits_.instructions);
    }
    if (text_.size() > limits_.bytes) {
        return "written out with the values of its constants, the formula has " + std::to_string(text_.size()) +
               " bytes; the most allowed are " + std::to_string(limits_.bytes);
    }
    return {};
}

Result<Formula> Formula::withConstants(std::span<const FormulaConstant> values) const {
    std::vector<FormulaConstant> constants = parsed_->constants;
    for (const auto& [name, value] : values) {
        const auto named = [&name = name](const FormulaConstant& constant) { return constant.name == name; };
        const auto found = std::find_if(constants.begin(), constants.end(), named);
        if (found == constants.end()) {
            std::vector<std::string_view> names;
            for (const FormulaConstant& constant : constants) names.push_back(constant.name);
            return Error{ErrorCode::bad_expression,
                         "the formula has no constant called " + text::inQuotes(name) + text::didYouMean(name, names)};
        }
        if (!std::isfinite(value)) return Error{ErrorCode::out_of_range, "the value of " + name + " must be finite"};
        found->value = value;
    }
    Formula changed({parsed_->tree, std::move(constants)}, limits_);
    if (std::string message = changed.exceededLimitMessage(); !message.empty())
        return Error{ErrorCode::out_of_range, std::move(message)};
    return changed;
}

std::size_t Formula::memoryBytes() const {
    const auto& [tree, constants] = *parsed_;
    return sizeof(*this) + text_.capacity() + sizeof(ParsedFormula) + constants.capacity() * sizeof(FormulaConstant) +
           tree.nodes.capacity() * sizeof(SyntaxNode) + tree.operands.capacity() * sizeof(std::uint32_t) +
           tree.expressions.capacity() * sizeof(NamedExpression) + sizeof(Tape) +
           tape_->instructions.capacity() * sizeof(Instruction);
}

Result<Formula> parseFormula(std::string_view text, FormulaMistake* mistake, const FormulaLimits& limits,
                             const Formula* shared) {
    auto parsed = parseSyntax(text, limits, shared == nullptr ? nullptr : &shared->parsed());
    if (auto* wrong = std::get_if<FormulaMistake>(&parsed)) return formulaError(text, std::move(*wrong), mistake);
    Formula formula(std::move(std::get<ParsedFormula>(parsed)), limits);
    if (std::string message = formula.exceededLimitMessage(); !message.empty())
        return formulaError(text, {1, std::move(message)}, mistake);
    return formula;
}

}  // namespace oval4d::fields
