#include "net/http/request_target.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <vector>

#include <nlohmann/json.hpp>

#include "net/http/access_control.hpp"
#include "protocol_data/embedded_files.hpp"
#include "text/ascii.hpp"

namespace oval4d::net {

namespace {

/// A text without percent escapes, and the positions of the characters that were written "+".
struct Decoded {
    std::string text;
    std::vector<std::size_t> pluses;
};

/// Decodes percent escapes; returns nothing if a "%" is not followed by two hexadecimal digits.
std::optional<Decoded> percentDecoded(std::string_view text) {
    Decoded out;
    out.text.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '+') out.pluses.push_back(out.text.size());
        if (text[i] != '%') {
            out.text += text[i];
            continue;
        }
        const std::string_view digits = text.substr(i + 1, 2);
        unsigned char byte = 0;
        const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
        if (fault != std::errc{} || end != digits.data() + 2) return {};
        out.text += static_cast<char>(byte);
        i += 2;
    }
    return out;
}

/// Returns a query as it was before a mailer or a forum wrote its "&" as "&amp;", or encoded its percent signs again
/// (%252C).
std::string repaired(std::string_view query) {
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

/// The rules of protocol/address.json.
struct AddressRules {
    std::vector<std::string> ignored, texts;
};

const AddressRules& rules() {
    static const AddressRules read = [] {
        const auto table = nlohmann::json::parse(protocol_data::embeddedFile("address.json"));
        return AddressRules{table.at("ignored"), table.at("texts")};
    }();
    return read;
}

/// Returns whether a parameter was appended to the address by another site.
bool isIgnored(std::string_view name) {
    return std::ranges::any_of(rules().ignored, [&](std::string_view rule) {
        return rule.ends_with('*') ? name.starts_with(rule.substr(0, rule.size() - 1)) : name == rule;
    });
}

/// Returns the value of a query's parameter. As in a form (application/x-www-form-urlencoded), "+" is a blank; but in
/// arithmetic that a person has typed, such as 0.1+pi/8, it is a plus sign: between two operands, where a blank has no
/// meaning.
std::string valueOf(Decoded decoded, const std::string& name) {
    std::string& text = decoded.text;
    const bool isArithmetic = std::ranges::find(rules().texts, name) == rules().texts.end();
    const auto isOperand = [&](std::size_t at, char parenthesis) {
        if (at >= text.size()) return false;
        const char c = text[at];
        const bool isAscii = static_cast<unsigned char>(c) < 0x80;
        return text::isLetter(c) || text::isDigit(c) || c == '.' || c == parenthesis || !isAscii;
    };
    for (const std::size_t at : decoded.pluses) {
        const bool adds = isArithmetic && at > 0 && isOperand(at - 1, ')') && isOperand(at + 1, '(');
        text[at] = adds ? '+' : ' ';
    }
    return std::move(text);
}

/// Returns the length of "http://" or "https://", in upper or lower case, at the beginning of the text; 0 if there is
/// neither.
std::size_t schemeLength(std::string_view text) {
    for (const std::string_view scheme : {"http://", "https://"}) {
        const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 'a' - 'A') : c; };
        if (std::ranges::equal(text.substr(0, scheme.size()), scheme, {}, lower)) return scheme.size();
    }
    return 0;
}

/// Removes the text up to and including the first separator, and returns the removed text without the separator.
/// Without a separator, removes and returns all of the text.
std::string_view takeUntil(std::string_view& text, char separator) {
    const std::size_t at = text.find(separator);
    const std::string_view head = text.substr(0, at);
    text.remove_prefix(at == std::string_view::npos ? text.size() : at + 1);
    return head;
}

}  // namespace

std::optional<RequestTarget> parseRequestTarget(std::string_view text) {
    RequestTarget target;
    if (const std::size_t scheme = schemeLength(text); scheme > 0) {
        text.remove_prefix(scheme);
        const std::size_t end = std::min(text.find_first_of("/?"), text.size());
        if (!parseAuthority(text.substr(0, end))) return {};
        target.authority = text.substr(0, end);
        text.remove_prefix(end);
        if (text.empty() || text.front() == '?') target.path = "/";
    }
    if (target.path.empty() && !text.starts_with('/')) return {};
    auto path = percentDecoded(takeUntil(text, '?'));
    if (!path) return {};
    target.path += path->text;
    const std::string query = repaired(text);
    text = query;
    while (!text.empty()) {
        std::string_view pair = takeUntil(text, '&');
        if (pair.empty()) continue;
        auto name = percentDecoded(takeUntil(pair, '='));
        auto value = percentDecoded(pair);
        if (!name || !value) return {};
        if (isIgnored(name->text)) continue;
        std::string decoded = valueOf(std::move(*value), name->text);
        target.query.emplace_back(std::move(name->text), std::move(decoded));
    }
    return target;
}

}  // namespace oval4d::net
