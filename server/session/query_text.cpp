#include "session/query_text.hpp"

#include <algorithm>
#include <cctype>

#include <nlohmann/json.hpp>

#include "protocol_data/embedded_files.hpp"
#include "text/ascii.hpp"
#include "text/percent_encoding.hpp"

namespace oval4d::session {

namespace {

/// Returns a query as it was before a mailer or a forum replaced "&" by "&amp;" or encoded the percent signs again
/// (%252C).
std::string repairedQuery(std::string_view query) {
    std::string out;
    out.reserve(query.size());
    const auto isHexDigit = [&](std::size_t at) {
        return at < query.size() && std::isxdigit(static_cast<unsigned char>(query[at])) != 0;
    };
    for (std::size_t i = 0; i < query.size(); ++i) {
        out += query[i];
        if (query.substr(i).starts_with("&amp;")) i += 4;
        if (query.substr(i).starts_with("%25") && isHexDigit(i + 3) && isHexDigit(i + 4)) i += 2;
    }
    return out;
}

/// The rules of protocol/address.json: names of parameters to ignore, and names of parameters whose values are not
/// arithmetic expressions.
struct QueryParameterRules {
    std::vector<std::string> ignored, texts;
};

const QueryParameterRules& specialParameters() {
    static const QueryParameterRules read = [] {
        const auto table = nlohmann::json::parse(protocol_data::embeddedFile("address.json"));
        return QueryParameterRules{table.at("ignored"), table.at("texts")};
    }();
    return read;
}

/// Returns whether to ignore a parameter, because other sites append it to addresses ("utm_source", for example).
bool isIgnoredParameter(std::string_view name) {
    return std::ranges::any_of(specialParameters().ignored, [&](std::string_view rule) {
        return rule.ends_with('*') ? name.starts_with(rule.substr(0, rule.size() - 1)) : name == rule;
    });
}

/// Returns whether `c`, a character beside a "+", can belong to an operand of the "+". For the character on the left,
/// `parenthesis` must be ')'. For the character on the right, `parenthesis` must be '('.
bool canEndOperand(char c, char parenthesis) {
    const bool isAscii = static_cast<unsigned char>(c) < 0x80;
    return text::isLetter(c) || text::isDigit(c) || c == '.' || c == parenthesis || !isAscii;
}

/// Returns whether a text begins with a unit of an angle: "°", "deg" or "rad". The function "deg(" is not a unit.
bool startsWithUnit(std::string_view text) {
    if (text.starts_with("°")) return true;
    constexpr std::size_t kLetters = 3;
    if (!text.starts_with("deg") && !text.starts_with("rad")) return false;
    return text.size() == kLetters || (!text::isLetter(text[kLetters]) && text[kLetters] != '(');
}

/// Decodes the value of the parameter `name`. A "+" means a blank, as in HTML forms
/// (application/x-www-form-urlencoded). In arithmetic values, a "+" between two operands remains a plus sign, as in
/// 0.1+pi/8. A unit is not an operand: in 30+°, the "+" is a blank. Returns an empty optional if a percent escape is
/// malformed.
std::optional<std::string> decodedValue(std::string_view written, const std::string& name) {
    const bool isArithmetic = std::ranges::find(specialParameters().texts, name) == specialParameters().texts.end();
    std::string value;
    for (bool isFirst = true;; isFirst = false) {
        const std::size_t plus = written.find('+');
        const auto piece = text::percentDecoded(written.substr(0, plus));
        if (!piece) return {};
        if (!isFirst) {
            const bool adds = isArithmetic && !value.empty() && canEndOperand(value.back(), ')') && !piece->empty() &&
                              canEndOperand(piece->front(), '(') && !startsWithUnit(*piece);
            value += adds ? '+' : ' ';
        }
        value += *piece;
        if (plus == std::string_view::npos) return value;
        written.remove_prefix(plus + 1);
    }
}

}  // namespace

std::optional<QueryParameters> parseQuery(std::string_view text) {
    QueryParameters query;
    const std::string all = repairedQuery(text);
    for (std::string_view rest = all; !rest.empty();) {
        const std::size_t end = std::min(rest.find('&'), rest.size());
        const std::string_view pair = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        if (pair.empty()) continue;
        const std::size_t equals = std::min(pair.find('='), pair.size());
        const auto name = text::percentDecoded(pair.substr(0, equals));
        if (!name) return {};
        auto value = decodedValue(pair.substr(std::min(equals + 1, pair.size())), *name);
        if (!value) return {};
        if (!isIgnoredParameter(*name)) query.emplace_back(*name, std::move(*value));
    }
    return query;
}

std::string queryText(const QueryParameters& query) {
    // Leave these characters as they are: queries may contain them without escapes (RFC 3986, section 3.4), and are
    // easier to read then.
    constexpr std::string_view kPlain = ",:;/=*()";
    std::string text;
    for (const auto& [name, value] : query) {
        if (!text.empty()) text += '&';
        text += text::percentEncoded(name) + '=' + text::percentEncoded(value, kPlain);
    }
    return text;
}

}  // namespace oval4d::session
