#pragma once
// The syntax of formulas.

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "fields/formula/syntax_tree.hpp"

namespace oval4d::fields {

/// The limits on the size of a formula. Each member is a maximum.
struct FormulaLimits {
    std::size_t bytes = 2000;         ///< the length of the text in bytes
    int nesting = 64;                 ///< the depth of nested parentheses, calls and exponents
    std::size_t constants = 16;       ///< the number of named constants
    std::size_t expressions = 100;    ///< the number of named expressions
    std::size_t instructions = 1000;  ///< the number of instructions of the compiled formula
};

/// A mistake in the text of a formula: its position, and a message.
struct FormulaMistake {
    std::size_t position = 1;  ///< the number of a character, counted from 1; one more than the last for the end of the
                               ///< text
    std::string what;
};

/// A parsed formula: its syntax tree, and its named constants with their values.
struct ParsedFormula {
    SyntaxTree tree;
    std::vector<FormulaConstant> constants;
};

/// Parses a formula. If `shared` is not null, the formula may use the names that `shared` defines, but not define them
/// again. A formula consists of
///
/// - the operators + − * / ^, parentheses, decimal numbers with or without exponent, `pi`, `phi`, and the units °, deg
///   and rad after a number, name or parenthesis;
/// - the variables x, y, z, w (also called t) and r = sqrt(x² + y² + z²), and the functions in builtinFunctions();
/// - at most one comparison =, <, <=, > or >=, outside of parentheses: a = b, a < b and a <= b mean the function a − b;
///   a > b and a >= b mean b − a, so that the inequality holds where the function is negative;
/// - names, which consist of letters, digits and underscores, begin with a letter, and are defined after the formula:
///   "a*x^2 + p < b; a=0.7, b=pi/2, p=y^2" (";" and "," mean the same).
///
/// A name is a constant if its definition contains neither variables nor defined names. Otherwise, it is a named
/// expression, whose definition may use variables and names that are defined before it.
std::variant<ParsedFormula, FormulaMistake> parseSyntax(std::string_view text, const FormulaLimits& limits,
                                                        const ParsedFormula* shared = nullptr);

}  // namespace oval4d::fields
