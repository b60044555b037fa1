#pragma once
// Formulas of x, y, z and w, such as "(sqrt(x^2+y^2)-1)^2 + (sqrt(z^2+w^2)-a)^2 - 0.09; a=0.7".

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "errors/error.hpp"
#include "fields/formula/parser.hpp"
#include "fields/formula/syntax_tree.hpp"
#include "fields/formula/tape.hpp"

namespace oval4d::fields {

/// A formula with the values of its named constants. Copies are cheap.
class Formula {
  public:
    /// The named constants. Those of a shared formula (see parseFormula()) come first, then those that the text
    /// defines, in the order of the text.
    const std::vector<FormulaConstant>& constants() const { return parsed_->constants; }

    /// Returns this formula with other values of the constants that `values` names. Errors: `bad_expression` if the
    /// formula has no constant with such a name; `out_of_range` if a value is not finite, or if the result exceeds a
    /// limit (see FormulaLimits).
    Result<Formula> withConstants(std::span<const FormulaConstant> values) const;

    /// Returns the formula as normalized text, with the values of its constants. From this text, parseFormula() makes
    /// the same function. Formulas that differ only in spaces, superfluous parentheses or the spelling of symbols have
    /// the same text.
    const std::string& text() const { return text_; }

    /// Returns the parsed formula. Another formula that uses the names of this formula passes it to parseSyntax() as
    /// `shared`.
    const ParsedFormula& parsed() const { return *parsed_; }

    const Tape& tape() const { return *tape_; }

    /// Returns the memory used, in bytes, including the memory that copies share.
    std::size_t memoryBytes() const;

  private:
    friend Result<Formula> parseFormula(std::string_view, FormulaMistake*, const FormulaLimits&, const Formula*);

    Formula(ParsedFormula parsed, const FormulaLimits& limits);
    // Returns a message if the formula exceeds a limit of FormulaLimits, else an empty string.
    std::string exceededLimitMessage() const;

    std::shared_ptr<const ParsedFormula> parsed_;
    FormulaLimits limits_;
    std::string text_;
    std::shared_ptr<const Tape> tape_;
};

/// Parses a formula (see parseSyntax() for the syntax). If `shared` is not null, the formula may use the names that
/// `shared` defines; the text() of the result does not repeat their definitions. Error: `bad_expression`, with the
/// position of the mistake in characters. Also writes the mistake to `mistake` unless this pointer is null.
Result<Formula> parseFormula(std::string_view text, FormulaMistake* mistake = nullptr, const FormulaLimits& limits = {},
                             const Formula* shared = nullptr);

}  // namespace oval4d::fields
