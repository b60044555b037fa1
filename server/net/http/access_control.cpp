#include "net/http/access_control.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "store/secret.hpp"
#include "text/ascii.hpp"

namespace oval4d::net {

namespace {

constexpr std::string_view kCookie = "oval4d_token";

bool equalsIgnoringCase(std::string_view a, std::string_view b) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 'a' - 'A') : c; };
    return std::ranges::equal(a, b, {}, lower, lower);
}

bool isHexadecimal(char c) { return text::isDigit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); }
bool isHostNameCharacter(char c) { return text::isDigit(c) || text::isLetter(c) || c == '-' || c == '.' || c == '_'; }

/// Returns the port of `authority`. If `authority` has no port, returns `defaultPort`, because browsers omit the
/// default port of a scheme.
std::string_view portOrDefault(const UrlAuthority& authority, std::string_view defaultPort) {
    return authority.port.empty() ? defaultPort : authority.port;
}

/// Returns the host name without a final dot. The dot marks a name as fully qualified: "localhost." means "localhost".
std::string_view withoutFinalDot(std::string_view host) {
    return host.size() > 1 && host.ends_with('.') ? host.substr(0, host.size() - 1) : host;
}

bool isListed(const std::vector<std::string>& list, std::string_view text) {
    return std::ranges::any_of(
        list, [text](const std::string& entry) { return entry == "*" || equalsIgnoringCase(entry, text); });
}

/// Returns the value of the token cookie in `header`, the value of the field Cookie. Returns an empty string if there
/// is no such cookie.
std::string_view tokenCookieIn(std::string_view header) {
    while (!header.empty()) {
        const std::size_t end = std::min(header.find(';'), header.size());
        std::string_view pair = header.substr(0, end);
        header.remove_prefix(std::min(end + 1, header.size()));
        pair.remove_prefix(std::min(pair.find_first_not_of(' '), pair.size()));
        if (pair.starts_with(kCookie) && pair.substr(kCookie.size()).starts_with('=')) {
            return pair.substr(kCookie.size() + 1);
        }
    }
    return {};
}

/// Returns the token after "Bearer " in the value of the field Authorization. If the value does not begin with "Bearer
/// ", returns the whole value.
std::string_view bearerTokenIn(std::string_view authorization) {
    constexpr std::string_view kBearer = "Bearer ";
    if (equalsIgnoringCase(authorization.substr(0, kBearer.size()), kBearer))
        authorization.remove_prefix(kBearer.size());
    return authorization;
}

}  // namespace

std::optional<UrlAuthority> parseAuthority(std::string_view text) {
    UrlAuthority authority;
    if (text.starts_with('[')) {
        const std::size_t bracket = text.find(']');
        if (bracket == std::string_view::npos) return {};
        authority.host = text.substr(0, bracket + 1);
        const std::string_view address = authority.host.substr(1, bracket - 1);
        const auto isAddressCharacter = [](char c) { return isHexadecimal(c) || c == ':' || c == '.'; };
        if (address.find(':') == std::string_view::npos || !std::ranges::all_of(address, isAddressCharacter)) return {};
    } else {
        authority.host = text.substr(0, text.find(':'));
        if (authority.host.empty() || !std::ranges::all_of(authority.host, isHostNameCharacter)) return {};
    }
    std::string_view rest = text.substr(authority.host.size());
    if (rest.empty()) return authority;
    rest.remove_prefix(1);
    unsigned port = 0;
    const auto [end, fault] = std::from_chars(rest.data(), rest.data() + rest.size(), port);
    constexpr unsigned kLastPort = 65535;
    if (fault != std::errc{} || end != rest.data() + rest.size() || port > kLastPort) return {};
    if (text[authority.host.size()] != ':') return {};
    authority.port = rest;
    return authority;
}

AccessControl::AccessControl(std::vector<std::string> hosts, std::vector<std::string> origins, std::string token,
                             bool loopback)
    : hosts_(std::move(hosts)), origins_(std::move(origins)), token_(std::move(token)) {
    if (hosts_.empty())
        hosts_ = loopback ? std::vector<std::string>{"localhost", "127.0.0.1", "[::1]"} : std::vector<std::string>{"*"};
}

AccessControl::Verdict AccessControl::check(const AccessCheckInput& fields) const {
    if (!isAllowedHost(fields.host)) return Verdict::bad_host;
    if (!isAllowedOrigin(fields.origin, fields.host)) return Verdict::bad_origin;
    if (!hasCorrectToken(fields)) return Verdict::bad_token;
    return Verdict::allowed;
}

std::string AccessControl::tokenCookieFor(const AccessCheckInput& fields) const {
    if (token_.empty() || !store::equalInConstantTime(fields.token, token_)) return {};
    // The cookie has no attribute Path, so browsers send it for the folder of the page, whatever path prefix a proxy
    // adds.
    return std::string(kCookie) + "=" + token_ + "; HttpOnly; SameSite=Strict";
}

bool AccessControl::isAllowedHost(std::string_view host) const {
    const auto authority = parseAuthority(host);
    return authority ? isListed(hosts_, host) || isListed(hosts_, withoutFinalDot(authority->host))
                     : host.empty() && isListed(hosts_, "*");
}

bool AccessControl::isListedOrigin(std::string_view origin) const {
    return !origin.empty() && isListed(origins_, origin);
}

/// Returns whether a request with these values of the fields Origin and Host is allowed. A request without Origin is
/// allowed, because the server's own page or a program other than a browser has sent it. An origin with the same host
/// and port as `host` is allowed, because it is the origin of the server's own page. The scheme may differ, because a
/// proxy may terminate TLS.
bool AccessControl::isAllowedOrigin(std::string_view origin, std::string_view host) const {
    if (origin.empty() || isListedOrigin(origin)) return true;
    for (const auto& [scheme, port] : {std::pair("http://", "80"), std::pair("https://", "443")}) {
        const std::string_view prefix = scheme;
        if (!equalsIgnoringCase(origin.substr(0, prefix.size()), prefix)) continue;
        const auto from = parseAuthority(origin.substr(prefix.size())), called = parseAuthority(host);
        return from && called && equalsIgnoringCase(withoutFinalDot(from->host), withoutFinalDot(called->host)) &&
               portOrDefault(*from, port) == portOrDefault(*called, port);
    }
    return false;
}

bool AccessControl::isUnwantedCrossSite(const AccessCheckInput& fields) const {
    const bool isLink =
        equalsIgnoringCase(fields.fetchMode, "navigate") && equalsIgnoringCase(fields.fetchDestination, "document");
    return equalsIgnoringCase(fields.fetchSite, "cross-site") && !isLink && !isListedOrigin(fields.origin);
}

bool AccessControl::presentsToken(const AccessCheckInput& fields) {
    return !fields.token.empty() || !fields.authorization.empty() || !tokenCookieIn(fields.cookie).empty();
}

bool AccessControl::hasCorrectToken(const AccessCheckInput& fields) const {
    if (token_.empty()) return true;
    return store::equalInConstantTime(fields.token, token_) ||
           store::equalInConstantTime(bearerTokenIn(fields.authorization), token_) ||
           store::equalInConstantTime(tokenCookieIn(fields.cookie), token_);
}

}  // namespace oval4d::net
