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

struct Function {
    std::string_view name;
    double (*call)(double);
};
constexpr auto kFunctions = std::to_array<Function>({{"sqrt", [](double x) { return std::sqrt(x); }},
                                                     {"sin", [](double x) { return std::sin(x); }},
                                                     {"cos", [](double x) { return std::cos(x); }},
                                                     {"tan", [](double x) { return std::tan(x); }},
                                                     {"asin", [](double x) { return std::asin(x); }},
                                                     {"acos", [](double x) { return std::acos(x); }},
                                                     {"atan", [](double x) { return std::atan(x); }},
                                                     {"deg", [](double x) { return x * std::numbers::pi / 180; }}});
constexpr auto kNames =
    std::to_array<std::string_view>({"pi", "phi", "sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "deg"});
// Unicode characters that are accepted in place of pi, phi and -.
constexpr std::string_view kPiLetter = "π", kPhiLetter = "φ", kMinusSign = "−";

constexpr std::size_t kMaxLength = 1000;
constexpr int kMaxDepth = 64;

using text::isDigit;
using text::isLetter;

// A recursive-descent parser that evaluates the expression while it parses. Throws SyntaxError, which evaluate()
// catches.
//   sum = product {(+|−) product}   product = signed {(*|/) signed}   signed = {+|−} power   power = angle [^ signed]
//   angle = atom [unit]
// A unit is an error where `units` is false, but for the argument of a function.
class Parser {
  public:
    Parser(std::string_view text, bool units) : text_(text), units_(units) {}

    struct SyntaxError {
        std::size_t position;
        std::string what;
    };

    double parse() {
        const double value = sum();
        if (at_ != text_.size()) fail("an operator is expected" + hint());
        return value;
    }

  private:
    double sum() {
        const Depth deeper(*this);
        double value = product();
        while (true) {
            if (take("+")) {
                value += product();
            } else if (take("-") || take(kMinusSign)) {
                value -= product();
            } else {
                return value;
            }
        }
    }
    double product() {
        double value = signedPower();
        while (true) {
            if (take("*")) {
                value *= signedPower();
            } else if (take("/")) {
                value /= signedPower();
            } else {
                return value;
            }
        }
    }
    double signedPower() {
        const Depth deeper(*this);
        if (take("-") || take(kMinusSign)) return -signedPower();
        if (take("+")) return signedPower();
        const double base = angle();
        return take("^") ? std::pow(base, signedPower()) : base;
    }
    double angle() {
        const double value = atom();
        const std::size_t end = at_;
        const bool isInDegrees = take("°") || takeWord("deg");
        if (!isInDegrees && !takeWord("rad")) return value;
        if (!units_) {
            at_ = end;
            fail("a number without a unit is expected, because it is not an angle");
        }
        return isInDegrees ? value * std::numbers::pi / 180 : value;
    }
    double atom() {
        if (take("(")) {
            const double value = sum();
            if (!take(")")) fail("a ')' is missing");
            return value;
        }
        if (take(kPiLetter)) return std::numbers::pi;
        if (take(kPhiLetter)) return std::numbers::phi;
        skipBlanks();
        if (at_ < text_.size() && (isDigit(text_[at_]) || text_[at_] == '.')) return number();
        if (at_ < text_.size() && isLetter(text_[at_])) return named();
        fail("a number, a name or '(' is expected");
    }
    double number() {
        double value = 0;
        const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        if (error == std::errc::result_out_of_range) fail("the number is too large or too small");
        if (error != std::errc{}) fail("a number is expected");
        at_ = static_cast<std::size_t>(end - text_.data());
        return value;
    }
    double named() {
        const std::size_t start = at_;
        while (at_ < text_.size() && isLetter(text_[at_])) ++at_;
        const std::string_view name = text_.substr(start, at_ - start);
        if (name == "pi") return std::numbers::pi;
        if (name == "phi") return std::numbers::phi;
        for (const Function& function : kFunctions) {
            if (function.name != name) continue;
            if (!take("(")) fail("'(' is expected after " + std::string(name));
            const bool outside = std::exchange(units_, true);
            const double value = function.call(sum());
            units_ = outside;
            if (!take(")")) fail("a ')' is missing");
            return value;
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
    // Like take(), but not if further letters follow.
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
    std::string hint() const { return isLetter(text_[at_]) || text_[at_] == '(' ? " (a product is written 2*pi)" : ""; }
    [[noreturn]] void fail(std::string what) const { throw SyntaxError{at_, std::move(what)}; }

    struct Depth {
        explicit Depth(Parser& owner) : parser(owner) {
            if (++parser.depth_ > kMaxDepth) parser.fail("the expression nests too deeply");
        }
        ~Depth() { --parser.depth_; }
        Depth(const Depth&) = delete;
        Depth& operator=(const Depth&) = delete;
        Parser& parser;
    };

    std::string_view text_;
    std::size_t at_ = 0;
    int depth_ = 0;
    bool units_;
};

Error bad(std::string message) { return {ErrorCode::bad_expression, std::move(message)}; }

Result<double> evaluated(std::string_view text, bool units) {
    if (text.find_first_not_of(" \t") == std::string_view::npos)
        return bad("a number is expected, such as 0.2 or pi/8");
    if (text.size() > kMaxLength)
        return bad("an expression may have at most " + std::to_string(kMaxLength) + " characters");
    try {
        const double value = Parser(text, units).parse();
        if (!std::isfinite(value)) return bad(text::inQuotes(text) + " is not a finite number");
        return value;
    } catch (const Parser::SyntaxError& error) {
        return bad(text::inQuotes(text) + ", position " + std::to_string(error.position + 1) + ": " + error.what);
    }
}

}  // namespace

Result<double> evaluate(std::string_view text) { return evaluated(text, false); }

Result<std::vector<double>> evaluateList(std::string_view text) {
    std::vector<double> list;
    while (true) {
        const std::size_t comma = text.find(',');
        const auto value = evaluate(text.substr(0, comma));
        if (!value) return value.error();
        list.push_back(*value);
        if (comma == std::string_view::npos) return list;
        text.remove_prefix(comma + 1);
    }
}

Result<double> evaluateAngle(std::string_view text) {
    auto value = evaluated(text, true);
    const bool isBareNumber = text.find_first_not_of(" \t+-.0123456789") == std::string_view::npos;
    if (value && isBareNumber && std::abs(*value) > 2 * std::numbers::pi) {
        const std::size_t first = text.find_first_not_of(" \t");
        const std::string number(text.substr(first, text.find_last_not_of(" \t") + 1 - first));
        return Error{ErrorCode::out_of_range,
                     number + " radians are more than a full turn; did you mean " + number + "°?"};
    }
    return value;
}

Result<geometry::Turn> makeTurn(std::string_view planes, const std::vector<std::string_view>& angles,
                                std::string_view examples) {
    std::vector<std::string_view> names = text::splitAtCommas(planes);
    if (planes.empty() || planes.ends_with(',')) names.emplace_back();  // which is no plane
    std::vector<geometry::Plane> named;
    for (const std::string_view name : names) {
        const auto plane = geometry::planeNamed(name);
        if (!plane)
            return bad("no plane is called " + text::inQuotes(name) + "; the planes are xy, xz, xw, yz, yw, zw");
        if (std::ranges::find(named, *plane) != named.end())
            return bad("the plane " + std::string(name) + " is named twice");
        named.push_back(*plane);
    }
    if (angles.size() != named.size()) {
        const std::string count = std::to_string(named.size());
        return bad((named.size() == 1 ? "one plane needs one angle" : count + " planes need " + count + " angles") +
                   ", not " + std::to_string(angles.size()) + "; write " + std::string(examples));
    }
    geometry::Turn turn;
    for (std::size_t i = 0; i < named.size(); ++i) {
        const Result<double> angle = evaluateAngle(angles[i]);
        if (!angle) return angle.error();
        turn[named[i]] = *angle;
    }
    return turn;
}

Result<geometry::Turn> parseTurn(std::string_view text) {
    constexpr std::string_view kExamples = "xw:pi/8 or xw,yz:pi/8,pi/5";
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) {
        return bad(text::inQuotes(text) + " is not a rotation; write " + std::string(kExamples));
    }
    std::vector<std::string_view> angles;
    std::string_view rest = text.substr(colon + 1);
    while (true) {
        const std::size_t comma = rest.find(',');
        angles.push_back(rest.substr(0, comma));
        if (comma == std::string_view::npos) break;
        rest.remove_prefix(comma + 1);
    }
    return makeTurn(text.substr(0, colon), angles, kExamples);
}

}  // namespace oval4d::session
