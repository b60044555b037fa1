#include "session/expression.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "text/ascii.hpp"
#include "text/message_text.hpp"
#include "text/words.hpp"

namespace oval4d::session {

namespace {

struct NamedFunction {
    std::string_view name;
    double (*call)(double);
    bool givesAngle = false;  // whether the value of the function is an angle in radians
};
constexpr auto kFunctions =
    std::to_array<NamedFunction>({{"sqrt", [](double x) { return std::sqrt(x); }},
                                  {"sin", [](double x) { return std::sin(x); }},
                                  {"cos", [](double x) { return std::cos(x); }},
                                  {"tan", [](double x) { return std::tan(x); }},
                                  {"asin", [](double x) { return std::asin(x); }, true},
                                  {"acos", [](double x) { return std::acos(x); }, true},
                                  {"atan", [](double x) { return std::atan(x); }, true},
                                  {"deg", [](double x) { return x * std::numbers::pi / 180; }, true}});
constexpr auto kNames =
    std::to_array<std::string_view>({"pi", "phi", "sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "deg"});
// Unicode characters that are accepted in place of pi, phi and -.
constexpr std::string_view kPiLetter = "π", kPhiLetter = "φ", kMinusSign = "−";
// The degree sign, and two similar characters: Spanish and Portuguese keyboards have the ordinal indicator º.
constexpr auto kDegreeSigns = std::to_array<std::string_view>({"°", "º", "˚"});

constexpr std::size_t kMaxLength = 1000;
constexpr int kMaxDepth = 64;

using text::isDigit;
using text::isLetter;

// The value of a part of an expression, with information about units in this part.
struct ValueWithUnit {
    double value = 0;               // in degrees if isInDegrees is true; otherwise in radians if it is an angle
    double plain = 0;               // the sum of those terms of the part that are numbers without units
    bool isPlain = false;           // whether `plain` is the whole value, so that all terms are numbers without units
    bool hasUnit = false;           // whether this part contains a unit
    bool isInDegrees = false;       // whether the unit is degrees and `value` is still in degrees
    bool hasUnitlessAngle = false;  // whether this part contains an angle without a unit, such as pi or atan(2)
    bool isGroup = false;           // whether parentheses enclose this part of the expression
    std::size_t unitAt = 0;         // the position of the unit in the text
};

// A recursive-descent parser that evaluates an expression while parsing it. Throws SyntaxError, which
// evaluateExpression() catches. The grammar is:
//    sum = product {(+|−) product}   product = signed {(*|/) signed}   signed = {+|−} power
//    power = angle [^ signed]   angle = atom [unit]   atom = number | constant | function ( sum ) | ( sum )
// A product has at most one unit, after any of its factors, and this unit applies to the whole product: people read
// 45/2° as 22.5°. If `units` is false, a unit is an error, except in the argument of a function.
class ExpressionParser {
  public:
    ExpressionParser(std::string_view text, bool units) : text_(text), units_(units) {}

    struct SyntaxError {
        std::size_t position;
        std::string what;
    };

    ValueWithUnit parse() {
        const ValueWithUnit term = sum();
        if (at_ != text_.size()) fail("an operator is expected" + productHint());
        return term;
    }

  private:
    // Parses a sum and returns its value, in radians if the sum has a unit.
    ValueWithUnit sum() {
        const NestingGuard deeper(*this);
        ValueWithUnit total = convertToRadians(product());
        while (true) {
            const bool isDifference = take("-") || take(kMinusSign);
            if (!isDifference && !take("+")) return total;
            const ValueWithUnit term = convertToRadians(product());
            const double sign = isDifference ? -1 : 1;
            total.value += sign * term.value;
            total.plain += sign * term.plain;
            total.isPlain = total.isPlain && term.isPlain;
            total.hasUnit = total.hasUnit || term.hasUnit;
            total.hasUnitlessAngle = total.hasUnitlessAngle || term.hasUnitlessAngle;
        }
    }
    ValueWithUnit product() {
        ValueWithUnit total = signedPower();
        while (true) {
            const bool isQuotient = take("/");
            if (!isQuotient && !take("*")) return total;
            const ValueWithUnit factor = signedPower();
            if (isQuotient && factor.hasUnit && factor.isGroup)
                failAt(factor.unitAt, "an angle cannot be divided by an angle, and neither can a number");
            total = productOf(total, factor, isQuotient ? total.value / factor.value : total.value * factor.value);
        }
    }
    ValueWithUnit signedPower() {
        const NestingGuard deeper(*this);
        if (take("-") || take(kMinusSign)) {
            ValueWithUnit term = signedPower();
            term.value = -term.value;
            term.plain = -term.plain;
            return term;
        }
        if (take("+")) return signedPower();
        const ValueWithUnit base = angle();
        if (!take("^")) return base;
        if (base.hasUnit) failAt(base.unitAt, "the power of an angle is no angle; write the unit after the exponent");
        const ValueWithUnit exponent = signedPower();
        return productOf(base, exponent, std::pow(base.value, exponent.value));
    }
    // Returns the product, quotient or power of the terms `a` and `b`, with the unit that one of them has. `value` is
    // the number that the caller has computed for it. Throws SyntaxError if both terms have a unit.
    ValueWithUnit productOf(const ValueWithUnit& a, const ValueWithUnit& b, double value) {
        if (a.hasUnit && b.hasUnit)
            failAt(std::max(a.unitAt, b.unitAt), "a product has one unit, which is that of all of it");
        ValueWithUnit result = a.hasUnit ? a : b;
        result.value = value;
        result.isPlain = a.isPlain && b.isPlain;
        result.plain = result.isPlain ? value : 0;
        result.hasUnitlessAngle = a.hasUnitlessAngle || b.hasUnitlessAngle;
        result.isGroup = false;
        return result;
    }
    // Converts `term`, a product, to radians if its unit is degrees. Throws SyntaxError if the product in degrees also
    // contains an angle without a unit, such as pi.
    ValueWithUnit convertToRadians(ValueWithUnit term) {
        if (!term.isInDegrees) return term;
        if (term.hasUnitlessAngle) failAt(term.unitAt, "the angle is in radians already, as pi is; leave out its unit");
        term.value *= std::numbers::pi / 180;
        term.isInDegrees = false;
        return term;
    }
    ValueWithUnit angle() {
        ValueWithUnit term = atom();
        skipBlanks();
        const std::size_t start = at_;
        const bool isInDegrees =
            std::ranges::any_of(kDegreeSigns, [this](std::string_view sign) { return take(sign); }) || takeWord("deg");
        if (!isInDegrees && !takeWord("rad")) return term;
        if (!units_) failAt(start, "a number without a unit is expected, because it is not an angle");
        if (term.hasUnit) failAt(start, "the angle has a unit already");
        term.unitAt = start;
        term.plain = 0;
        term.isPlain = false;
        term.hasUnit = true;
        term.isInDegrees = isInDegrees;
        term.isGroup = false;
        return term;
    }
    ValueWithUnit atom() {
        if (take("(")) {
            ValueWithUnit term = sum();
            if (!take(")")) fail("a ')' is missing");
            term.isGroup = true;
            return term;
        }
        if (take(kPiLetter)) return pi();
        if (take(kPhiLetter)) return {.value = std::numbers::phi};
        skipBlanks();
        if (at_ < text_.size() && (isDigit(text_[at_]) || text_[at_] == '.')) return number();
        if (at_ < text_.size() && isLetter(text_[at_])) return functionOrConstant();
        fail("a number, a name or '(' is expected");
    }
    static ValueWithUnit pi() { return {.value = std::numbers::pi, .hasUnitlessAngle = true}; }
    ValueWithUnit number() {
        double value = 0;
        const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        if (error == std::errc::result_out_of_range) fail("the number is too large or too small");
        if (error != std::errc{}) fail("a number is expected");
        at_ = static_cast<std::size_t>(end - text_.data());
        return {.value = value, .plain = value, .isPlain = true};
    }
    ValueWithUnit functionOrConstant() {
        const std::size_t start = at_;
        while (at_ < text_.size() && isLetter(text_[at_])) ++at_;
        const std::string_view name = text_.substr(start, at_ - start);
        if (name == "pi") return pi();
        if (name == "phi") return {.value = std::numbers::phi};
        for (const NamedFunction& function : kFunctions) {
            if (function.name != name) continue;
            if (!take("(")) fail("'(' is expected after " + std::string(name));
            const bool outside = std::exchange(units_, true);
            const double value = function.call(sum().value);
            units_ = outside;
            if (!take(")")) fail("a ')' is missing");
            return {.value = value, .hasUnitlessAngle = function.givesAngle};
        }
        at_ = start;
        fail("nothing is called " + text::inQuotes(name) + text::didYouMean(name, kNames) + "; known names are " +
             text::commaSeparated(kNames));
    }

    bool take(std::string_view token) {
        skipBlanks();
        if (!text_.substr(at_).starts_with(token)) return false;
        at_ += token.size();
        return true;
    }
    // Skips `word` and returns true, if the remaining text begins with `word` and no letter follows. Otherwise returns
    // false.
    bool takeWord(std::string_view word) {
        skipBlanks();
        const std::string_view rest = text_.substr(at_);
        if (!rest.starts_with(word) || (rest.size() > word.size() && isLetter(rest[word.size()]))) return false;
        at_ += word.size();
        return true;
    }
    void skipBlanks() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    }
    std::string productHint() const {
        return isLetter(text_[at_]) || text_[at_] == '(' ? " (a product is written 2*pi)" : "";
    }
    [[noreturn]] void fail(std::string what) const { failAt(at_, std::move(what)); }
    [[noreturn]] static void failAt(std::size_t position, std::string what) {
        throw SyntaxError{position, std::move(what)};
    }

    struct NestingGuard {
        explicit NestingGuard(ExpressionParser& owner) : parser(owner) {
            if (++parser.depth_ > kMaxDepth) parser.fail("the expression nests too deeply");
        }
        ~NestingGuard() { --parser.depth_; }
        NestingGuard(const NestingGuard&) = delete;
        NestingGuard& operator=(const NestingGuard&) = delete;
        ExpressionParser& parser;
    };

    std::string_view text_;
    std::size_t at_ = 0;
    int depth_ = 0;
    bool units_;
};

Error badExpressionError(std::string message) { return {ErrorCode::bad_expression, std::move(message)}; }

Result<ValueWithUnit> evaluateExpression(std::string_view given, bool units) {
    const std::string text = text::withPlainBlanks(given);
    if (text.find_first_not_of(" \t") == std::string_view::npos)
        return badExpressionError("a number is expected, such as 0.2 or pi/8");
    if (text.size() > kMaxLength)
        return badExpressionError("an expression may have at most " + std::to_string(kMaxLength) + " characters");
    try {
        const ValueWithUnit term = ExpressionParser(text, units).parse();
        if (!std::isfinite(term.value)) return badExpressionError(text::inQuotes(text) + " is not a finite number");
        return term;
    } catch (const ExpressionParser::SyntaxError& error) {
        return badExpressionError(text::inQuotes(text) + ", position " + std::to_string(error.position + 1) + ": " +
                                  error.what);
    }
}

}  // namespace

bool isAngleUnit(std::string_view word) {
    return word == "deg" || word == "rad" || std::ranges::find(kDegreeSigns, word) != kDegreeSigns.end();
}

Result<double> evaluateNumber(std::string_view text) {
    const auto term = evaluateExpression(text, false);
    if (!term) return term.error();
    return term->value;
}

Result<std::vector<double>> evaluateList(std::string_view text) {
    std::vector<double> list;
    while (true) {
        const std::size_t comma = text.find(',');
        const auto value = evaluateNumber(text.substr(0, comma));
        if (!value) return value.error();
        list.push_back(*value);
        if (comma == std::string_view::npos) return list;
        text.remove_prefix(comma + 1);
    }
}

Result<double> evaluateAngle(std::string_view text) {
    const auto term = evaluateExpression(text, true);
    if (!term) return term.error();
    if (std::abs(term->plain) > 2 * std::numbers::pi) {
        const std::string number = text::roundedDecimal(term->plain);
        return Error{ErrorCode::out_of_range,
                     number + " radians are more than a full turn; did you mean " + number + "°?"};
    }
    return term->value;
}

Result<geometry::RotationAngles> parsePlanesAndAngles(std::string_view planes,
                                                      const std::vector<std::string_view>& angles,
                                                      std::string_view examples) {
    std::vector<std::string_view> names = text::splitAtCommas(planes);
    // An empty name is refused below, because it is not a plane.
    if (planes.empty() || planes.ends_with(',')) names.emplace_back();
    std::vector<geometry::Plane> named;
    for (const std::string_view written : names) {
        const std::string_view name = text::trimmed(written);
        const auto plane = geometry::planeNamed(name);
        if (!plane)
            return badExpressionError("no plane is called " + text::inQuotes(name) +
                                      "; the planes are xy, xz, xw, yz, yw, zw");
        if (std::ranges::find(named, *plane) != named.end())
            return badExpressionError("the plane " + std::string(name) + " is named twice");
        named.push_back(*plane);
    }
    if (angles.size() != named.size()) {
        const std::string count = std::to_string(named.size());
        return badExpressionError(
            (named.size() == 1 ? "one plane needs one angle" : count + " planes need " + count + " angles") + ", not " +
            std::to_string(angles.size()) + "; write " + std::string(examples));
    }
    geometry::RotationAngles turn;
    for (std::size_t i = 0; i < named.size(); ++i) {
        const Result<double> angle = evaluateAngle(angles[i]);
        if (!angle) return angle.error();
        turn[named[i]] = *angle;
    }
    return turn;
}

Result<geometry::RotationAngles> parseTurn(std::string_view text) {
    constexpr std::string_view kExamples = "xw:pi/8 or xw,yz:pi/8,pi/5";
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) {
        return badExpressionError(text::inQuotes(text) + " is not a rotation; write " + std::string(kExamples));
    }
    std::vector<std::string_view> angles;
    std::string_view rest = text.substr(colon + 1);
    while (true) {
        const std::size_t comma = rest.find(',');
        angles.push_back(rest.substr(0, comma));
        if (comma == std::string_view::npos) break;
        rest.remove_prefix(comma + 1);
    }
    return parsePlanesAndAngles(text.substr(0, colon), angles, kExamples);
}

}  // namespace oval4d::session
