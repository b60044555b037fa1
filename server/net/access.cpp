#include "net/access.hpp"

#include <algorithm>

#include "store/secret.hpp"

namespace oval4d::net {

namespace {

constexpr std::string_view kCookie = "oval4d_token";

bool sameText(std::string_view a, std::string_view b) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 'a' - 'A') : c; };
    return std::ranges::equal(a, b, {}, lower, lower);
}

/// "localhost:8080" → "localhost", "[::1]:8080" → "[::1]"
std::string_view withoutPort(std::string_view host) {
    const std::size_t colon = host.rfind(':');
    const std::size_t bracket = host.rfind(']');
    if (colon == std::string_view::npos || (bracket != std::string_view::npos && colon < bracket)) return host;
    return host.substr(0, colon);
}

bool listed(const std::vector<std::string>& list, std::string_view text) {
    return std::ranges::any_of(list,
                               [text](const std::string& entry) { return entry == "*" || sameText(entry, text); });
}

/// The value of our cookie in a Cookie header.
std::string_view cookieIn(std::string_view header) {
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

}  // namespace

Access::Access(std::vector<std::string> hosts, std::vector<std::string> origins, std::string token, bool loopback)
    : hosts_(std::move(hosts)), origins_(std::move(origins)), token_(std::move(token)) {
    if (hosts_.empty())
        hosts_ = loopback ? std::vector<std::string>{"localhost", "127.0.0.1", "[::1]"} : std::vector<std::string>{"*"};
}

Access::Verdict Access::judge(const Credentials& credentials) const {
    if (!knowsHost(credentials.host)) return Verdict::bad_host;
    if (!knowsOrigin(credentials.origin, credentials.host)) return Verdict::bad_origin;
    if (!knowsToken(credentials)) return Verdict::bad_token;
    return Verdict::allowed;
}

std::string Access::cookieFor(const Credentials& credentials) const {
    if (token_.empty() || !store::sameSecret(credentials.token, token_)) return {};
    // Without a Path it holds for the page's own folder, and so under any path prefix.
    return std::string(kCookie) + "=" + token_ + "; HttpOnly; SameSite=Strict";
}

bool Access::knowsHost(std::string_view host) const {
    return listed(hosts_, host) || (!host.empty() && listed(hosts_, withoutPort(host)));
}

/// Scripts send no Origin. A page of this server comes from the host that it calls, whatever the scheme: a proxy may
/// stand between.
bool Access::knowsOrigin(std::string_view origin, std::string_view host) const {
    if (origin.empty() || listed(origins_, origin)) return true;
    const std::size_t scheme = origin.find("://");
    return scheme != std::string_view::npos && sameText(origin.substr(scheme + 3), host);
}

bool Access::knowsToken(const Credentials& credentials) const {
    if (token_.empty()) return true;
    constexpr std::string_view kBearer = "Bearer ";
    std::string_view bearer = credentials.authorization;
    if (sameText(bearer.substr(0, kBearer.size()), kBearer)) bearer.remove_prefix(kBearer.size());
    return store::sameSecret(credentials.token, token_) || store::sameSecret(bearer, token_) ||
           store::sameSecret(cookieIn(credentials.cookie), token_);
}

}  // namespace oval4d::net
