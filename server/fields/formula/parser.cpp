#include "fields/formula/parser.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <utility>

#include "fields/formula/functions.hpp"
#include "text/ascii.hpp"
#include "text/message_text.hpp"

namespace oval4d::fields {

namespace {

using NodeKind = SyntaxNode::NodeKind;
using Index = std::uint32_t;

constexpr auto kVariablesAndConstants = std::to_array<std::string_view>({"x", "y", "z", "w", "t", "r", "pi", "phi"});
constexpr auto kUnits = std::to_array<std::string_view>({"deg", "rad"});
// Unicode characters that are accepted in place of pi, phi and -.
constexpr std::string_view kPiLetter = "π", kPhiLetter = "φ", kMinusSign = "−";
constexpr std::size_t kMaxNameLength = 32;

struct ComparisonSymbol {
    std::string_view symbol;
    ComparisonRelation relation;
};
constexpr auto kComparisons = std::to_array<ComparisonSymbol>({{"<=", ComparisonRelation::less_equal},
                                                               {"≤", ComparisonRelation::less_equal},
                                                               {">=", ComparisonRelation::greater_equal},
                                                               {"≥", ComparisonRelation::greater_equal},
                                                               {"<", ComparisonRelation::less},
                                                               {">", ComparisonRelation::greater},
                                                               {"=", ComparisonRelation::equal}});

using text::isDigit;
using text::isLetter;
bool isNamePart(char c) { return isLetter(c) || isDigit(c) || c == '_'; }

template <typename Names>
bool contains(const Names& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

bool isReservedName(std::string_view name) {
    return contains(kVariablesAndConstants, name) || contains(kUnits, name) || functionNamed(name).has_value();
}

// Converts the index of a byte of `text` to the position that users see: the number of the character, counted from 1.
std::size_t characterPosition(std::string_view text, std::size_t byte) {
    const auto startsCharacter = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
    return 1 + static_cast<std::size_t>(
                   std::count_if(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(byte), startsCharacter));
}

// A recursive-descent parser of formulas. Throws SyntaxError, which parseSyntax() catches. The grammar:
//   formula = sum [comparison sum] {(;|,) name = sum}   sum = product {(+|−) product}
//   product = signed {(*|/) signed}   signed = {+|−} power   power = angle [^ signed]   angle = atom [unit]
// The formula and each definition are parsed to separate trees, whose nodes are then collected in one tree.
class FormulaParser {
  public:
    FormulaParser(std::string_view text, const FormulaLimits& limits, const ParsedFormula* shared)
        : text_(text), limits_(limits) {
        if (shared == nullptr) return;
        constants_ = shared->constants;
        const SyntaxTree& tree = shared->tree;
        const auto nodes = static_cast<std::ptrdiff_t>(tree.expressions.empty() ? 0 : tree.expressions.back().root + 1);
        expressions_.nodes.assign(tree.nodes.begin(), tree.nodes.begin() + nodes);
        expressions_.operands = tree.operands;
        expressions_.expressions = tree.expressions;
        expressions_.sharedConstants = constants_.size();
        expressions_.sharedExpressions = tree.expressions.size();
    }

    struct SyntaxError {
        std::size_t byte;
        std::string what;
    };

    ParsedFormula parse() {
        tree_.left = sum();
        tree_.relation = takeComparison();
        if (tree_.relation != ComparisonRelation::none) {
            tree_.right = sum();
            if (isAtComparison()) fail("only one comparison is allowed");
        }
        SyntaxTree formula = std::exchange(tree_, {});
        while (take(";") || take(",")) definition();
        skipBlanks();
        if (at_ != text_.size()) failAfterOperand();
        resolveNames(formula);
        const std::uint32_t nodeOffset = appendToExpressions(formula);
        expressions_.relation = formula.relation;
        expressions_.left = formula.left + nodeOffset;
        expressions_.right = formula.right + nodeOffset;
        return {std::move(expressions_), std::move(constants_)};
    }

  private:
    // An operand whose sign is not yet in the tree. The parser moves signs out of products, and turns a + −b into a − b
    // and a − −b into a + b. Therefore formulaText() never needs to write "--".
    struct SignedOperand {
        Index node;
        bool isNegative;
    };
    Index withSign(SignedOperand term) { return term.isNegative ? add(NodeKind::negate, {term.node}) : term.node; }

    Index sum() {
        Index value = withSign(product());
        while (true) {
            const bool plus = take("+");
            if (!plus && !takeMinus()) return value;
            const SignedOperand term = product();
            value = add(plus == term.isNegative ? NodeKind::subtract : NodeKind::add, {value, term.node});
        }
    }
    SignedOperand product() {
        SignedOperand value = signedPower();
        while (true) {
            const bool times = take("*");
            if (!times && !take("/")) return value;
            const SignedOperand factor = signedPower();
            value.node = add(times ? NodeKind::multiply : NodeKind::divide, {value.node, factor.node});
            value.isNegative = value.isNegative != factor.isNegative;
        }
    }
    SignedOperand signedPower() {
        bool isNegative = false;
        while (true) {
            if (takeMinus()) {
                isNegative = !isNegative;
            } else if (!take("+")) {
                break;
            }
        }
        const Index value = angle();
        if (take("^")) {
            const NestingGuard deeper(*this);
            const Index exponent = withSign(signedPower());
            return {add(NodeKind::power, {value, exponent}), isNegative};
        }
        if (tree_.nodes[value].kind != NodeKind::negate) return {value, isNegative};
        // The value is a negation in parentheses. Its node is the last node of the tree. The node is removed, because
        // the returned SignedOperand holds the sign.
        const Index operand = tree_.operands.back();
        tree_.operands.pop_back();
        tree_.nodes.pop_back();
        return {operand, !isNegative};
    }
    Index angle() {
        const Index value = atom();
        if (take("°") || takeWord("deg")) return addCall(*functionNamed("deg"), {value});
        takeWord("rad");
        return value;
    }
    Index atom() {
        skipBlanks();
        if (take("(")) {
            const NestingGuard deeper(*this);
            const Index value = sum();
            expectClosingParenthesis();
            return value;
        }
        if (take(kPiLetter)) return add(NodeKind::pi, {});
        if (take(kPhiLetter)) return add(NodeKind::phi, {});
        if (at_ < text_.size() && (isDigit(text_[at_]) || text_[at_] == '.')) return number();
        if (at_ < text_.size() && isLetter(text_[at_])) return functionOrConstant();
        fail("a number, a name or '(' is expected");
    }
    Index number() {
        double value = 0;
        const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        if (error == std::errc::result_out_of_range) fail("the number is too large or too small");
        if (error != std::errc{}) fail("a number is expected");
        at_ = static_cast<std::size_t>(end - text_.data());
        const Index node = add(NodeKind::number, {});
        tree_.nodes[node].number = value;
        return node;
    }
    Index functionOrConstant() {
        const std::size_t start = at_;
        const std::string_view name = takeName();
        if (const auto function = functionNamed(name)) return call(*function, start);
        if (name == "pi") return add(NodeKind::pi, {});
        if (name == "phi") return add(NodeKind::phi, {});
        constexpr std::string_view kVariables = "xyzwr";
        const std::size_t variable = name == "t" ? 3 : (name.size() == 1 ? kVariables.find(name) : kVariables.npos);
        if (variable != kVariables.npos) {
            isConstantDefinition_ = false;
            return add(NodeKind::variable, {}, static_cast<Index>(variable));
        }
        if (contains(kUnits, name)) failAt(start, text::inQuotes(name) + " is expected after a number");
        if (take("(")) {
            failAt(start, "no function is called " + text::inQuotes(name) + suggestion(name) +
                              "; known functions are " + functionNames());
        }
        return isInDefinition_ ? addEarlierNameNode(name, start) : addReferenceNode(name, start);
    }
    Index call(std::size_t function, std::size_t start) {
        const BuiltinFunction& entry = builtinFunctions()[function];
        if (!take("(")) fail("'(' is expected after " + std::string(entry.name));
        const NestingGuard deeper(*this);
        std::vector<Index> arguments{sum()};
        while (take(",")) arguments.push_back(sum());
        expectClosingParenthesis();
        if (arguments.size() < entry.minArguments || arguments.size() > entry.maxArguments) {
            const bool isExact = entry.minArguments == entry.maxArguments;
            failAt(start, std::string(entry.name) + " needs " + (isExact ? "" : "at least ") +
                              std::to_string(entry.minArguments) +
                              (entry.maxArguments == 1 ? " argument" : " arguments") + ", not " +
                              std::to_string(arguments.size()) + ": " + std::string(entry.name) + "(" +
                              std::string(entry.arguments) + ")");
        }
        return addCall(function, arguments);
    }
    // Takes the ')' that closes a parenthesis or a call.
    void expectClosingParenthesis() {
        if (take(")")) return;
        if (isAtComparison()) fail("a comparison is allowed only outside of parentheses");
        skipBlanks();
        if (at_ == text_.size() || text_[at_] == ';' || text_[at_] == ',') fail("a ')' is missing");
        fail("an operator or ')' is expected" + productHint());
    }

    // A name in the formula. The formula is parsed before the definitions of its names. Until resolveNames() is called,
    // after the last definition, SyntaxNode::index of the name's node is the index of this NameUse in uses_.
    struct NameUse {
        std::string_view name;
        std::size_t byte;
    };
    Index addReferenceNode(std::string_view name, std::size_t byte) {
        const auto found =
            std::find_if(uses_.begin(), uses_.end(), [name](const auto& use) { return use.name == name; });
        const auto index = static_cast<Index>(found - uses_.begin());
        if (found == uses_.end()) uses_.push_back({name, byte});
        return add(NodeKind::constant, {}, index);
    }
    // Adds a node for `name`, which occurs in the definition of another name. `name` must be defined before this
    // definition; otherwise, throws SyntaxError.
    Index addEarlierNameNode(std::string_view name, std::size_t byte) {
        isConstantDefinition_ = false;
        if (const auto found = resolve(name)) return add(found->kind, {}, found->index);
        failAt(byte, "nothing before this is called " + text::inQuotes(name) + suggestion(name) +
                         "; a definition may use only names that are defined before it");
    }
    void definition() {
        skipBlanks();
        const std::size_t start = at_;
        if (at_ == text_.size() || !isLetter(text_[at_])) fail("the name of a constant is expected, as in a=0.7");
        std::string name(takeName());
        if (isReservedName(name))
            failAt(start, text::inQuotes(name) + " has a meaning already, so no constant can be called so");
        if (name.size() > kMaxNameLength)
            failAt(start, "a name may have at most " + std::to_string(kMaxNameLength) + " characters");
        if (resolve(name)) failAt(start, text::inQuotes(name) + " has a value already");
        if (!take("=")) fail("'=' is expected after " + name);
        skipBlanks();
        const std::size_t valueStart = at_;
        isInDefinition_ = isConstantDefinition_ = true;
        tree_ = {};
        tree_.left = sum();
        isInDefinition_ = false;
        if (isAtComparison()) fail("the value of a name may not contain a comparison");
        if (isConstantDefinition_) {
            defineConstant(std::move(name), start, valueStart);
        } else {
            if (expressions_.expressions.size() - expressions_.sharedExpressions == limits_.expressions)
                failAt(start, "a formula may have at most " + std::to_string(limits_.expressions) + " expressions");
            const std::uint32_t nodeOffset = appendToExpressions(tree_);
            expressions_.expressions.push_back({std::move(name), tree_.left + nodeOffset});
        }
    }
    // Defines a constant by the expression in tree_, which must not contain variables or defined names.
    void defineConstant(std::string name, std::size_t start, std::size_t valueStart) {
        if (constants_.size() - expressions_.sharedConstants == limits_.constants)
            failAt(start, "a formula may have at most " + std::to_string(limits_.constants) + " constants");
        OperationGraph graph;
        const double value = *graph.constantAt(buildGraph(tree_, {}, graph));  // buildGraph() folds constants
        if (!std::isfinite(value)) failAt(valueStart, "the value of " + name + " is not a finite number");
        constants_.push_back({std::move(name), value});
    }
    // Appends the nodes of a tree to those of expressions_. Returns the number of nodes before them, nodeOffset: node i
    // of the tree becomes node i + nodeOffset of expressions_.
    std::uint32_t appendToExpressions(const SyntaxTree& tree) {
        const auto nodeOffset = static_cast<std::uint32_t>(expressions_.nodes.size());
        const auto firstOperand = static_cast<Index>(expressions_.operands.size());
        for (SyntaxNode node : tree.nodes) {
            node.firstOperand += firstOperand;
            expressions_.nodes.push_back(node);
        }
        for (const Index operand : tree.operands) expressions_.operands.push_back(operand + nodeOffset);
        return nodeOffset;
    }
    struct ResolvedName {
        NodeKind kind;  // NodeKind::constant or NodeKind::expression
        Index index;
    };
    void resolveNames(SyntaxTree& formula) const {
        std::vector<ResolvedName> definitions;
        for (const auto& [name, byte] : uses_) {
            const auto found = resolve(name);
            if (!found) failAt(byte, "nothing is called " + text::inQuotes(name) + undefinedNameHint(name));
            definitions.push_back(*found);
        }
        for (SyntaxNode& node : formula.nodes) {
            if (node.kind != NodeKind::constant) continue;
            const auto& [kind, index] = definitions[node.index];
            node.kind = kind;
            node.index = index;
        }
    }
    std::optional<ResolvedName> resolve(std::string_view name) const {
        for (std::size_t i = 0; i < constants_.size(); ++i)
            if (constants_[i].name == name) return ResolvedName{NodeKind::constant, static_cast<Index>(i)};
        const auto& expressions = expressions_.expressions;
        for (std::size_t i = 0; i < expressions.size(); ++i)
            if (expressions[i].name == name) return ResolvedName{NodeKind::expression, static_cast<Index>(i)};
        return {};
    }

    Index add(NodeKind kind, std::initializer_list<Index> operands, Index index = 0) {
        return add(kind, std::span(operands.begin(), operands.size()), index);
    }
    Index add(NodeKind kind, std::span<const Index> operands, Index index) {
        tree_.nodes.push_back(
            {kind, index, static_cast<Index>(tree_.operands.size()), static_cast<Index>(operands.size()), 0});
        tree_.operands.insert(tree_.operands.end(), operands.begin(), operands.end());
        return static_cast<Index>(tree_.nodes.size() - 1);
    }
    Index addCall(std::size_t function, const std::vector<Index>& arguments) {
        return add(NodeKind::call, arguments, static_cast<Index>(function));
    }

    bool take(std::string_view token) {
        skipBlanks();
        if (!text_.substr(at_).starts_with(token)) return false;
        at_ += token.size();
        return true;
    }
    bool takeMinus() { return take("-") || take(kMinusSign); }
    // Takes a word like take(), but not if another character of a name follows: "deg" is not taken from "degree".
    bool takeWord(std::string_view word) {
        skipBlanks();
        const std::string_view rest = text_.substr(at_);
        if (!rest.starts_with(word) || (rest.size() > word.size() && isNamePart(rest[word.size()]))) return false;
        at_ += word.size();
        return true;
    }
    std::string_view takeName() {
        const std::size_t start = at_;
        while (at_ < text_.size() && isNamePart(text_[at_])) ++at_;
        return text_.substr(start, at_ - start);
    }
    ComparisonRelation takeComparison() {
        for (const auto& [symbol, relation] : kComparisons)
            if (take(symbol)) return relation;
        return ComparisonRelation::none;
    }
    bool isAtComparison() {
        skipBlanks();
        const std::string_view rest = text_.substr(at_);
        return std::any_of(kComparisons.begin(), kComparisons.end(),
                           [rest](const ComparisonSymbol& comparison) { return rest.starts_with(comparison.symbol); });
    }
    void skipBlanks() {
        while (at_ < text_.size() &&
               (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r'))
            ++at_;
    }

    std::string productHint() const {
        const bool isOperand = at_ < text_.size() && (isNamePart(text_[at_]) || text_[at_] == '(');
        return isOperand ? " (a product is written 2*x)" : "";
    }
    static std::string suggestion(std::string_view name) {
        if (name.size() == 1) return "";  // there is no suggestion, because all other letters are equally similar
        std::vector<std::string_view> known(kVariablesAndConstants.begin(), kVariablesAndConstants.end());
        for (const auto& function : builtinFunctions()) known.push_back(function.name);
        return text::didYouMean(name, known);
    }
    static std::string functionNames() {
        std::vector<std::string_view> known;
        for (const auto& function : builtinFunctions()) known.push_back(function.name);
        return text::commaSeparated(known);
    }
    // Returns the last part of the message about a name that is not defined: a hint how to correct the mistake.
    static std::string undefinedNameHint(std::string_view name) {
        if (name.size() > 1 && name.find_first_not_of("xyzwtr") == std::string_view::npos) {
            std::string product(1, name[0]);
            for (const char c : name.substr(1)) product += {'*', c};
            if (name.size() <= 4) return " (a product is written " + product + ")";
        }
        const std::string shown = name.size() <= kMaxNameLength ? std::string(name) : "a";
        return suggestion(name) + "; a constant needs a value after the formula, as in ; " + shown + "=1";
    }
    [[noreturn]] void failAfterOperand() const {
        if (text_[at_] == ')') fail("a '(' is missing for this ')'");
        fail("an operator is expected" + productHint());
    }
    [[noreturn]] void fail(std::string what) const { throw SyntaxError{at_, std::move(what)}; }
    [[noreturn]] static void failAt(std::size_t byte, std::string what) { throw SyntaxError{byte, std::move(what)}; }

    struct NestingGuard {
        explicit NestingGuard(FormulaParser& owner) : parser(owner) {
            if (++parser.depth_ > parser.limits_.nesting) parser.fail("the formula nests too deeply");
        }
        ~NestingGuard() { --parser.depth_; }
        NestingGuard(const NestingGuard&) = delete;
        NestingGuard& operator=(const NestingGuard&) = delete;
        FormulaParser& parser;
    };

    std::string_view text_;
    FormulaLimits limits_;
    std::size_t at_ = 0;
    int depth_ = 0;
    bool isInDefinition_ = false;
    bool isConstantDefinition_ = false;  // whether the current definition has used no variable or defined name so far
    SyntaxTree tree_;                    // the tree of the formula or of the current definition
    SyntaxTree expressions_;             // the trees of the shared definitions and of earlier definitions
    std::vector<NameUse> uses_;
    std::vector<FormulaConstant> constants_;
};

}  // namespace

std::variant<ParsedFormula, FormulaMistake> parseSyntax(std::string_view text, const FormulaLimits& limits,
                                                        const ParsedFormula* shared) {
    if (text.size() > limits.bytes) {
        return FormulaMistake{characterPosition(text, limits.bytes),
                              "a formula may have at most " + std::to_string(limits.bytes) + " bytes"};
    }
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
        return FormulaMistake{1, "a formula is expected, such as x^2+y^2+z^2+w^2-1"};
    try {
        return FormulaParser(text, limits, shared).parse();
    } catch (const FormulaParser::SyntaxError& error) {
        return FormulaMistake{characterPosition(text, error.byte), error.what};
    }
}

}  // namespace oval4d::fields
