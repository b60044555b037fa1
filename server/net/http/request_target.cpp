#include "net/http/request_target.hpp"

#include <algorithm>
#include <utility>

#include "net/http/access_control.hpp"
#include "text/percent_encoding.hpp"

namespace oval4d::net {

namespace {

/// Returns the length of "http://" or "https://" at the beginning of the text, in upper or lower case; 0 if the text
/// begins with neither.
std::size_t urlSchemeLength(std::string_view text) {
    for (const std::string_view scheme : {"http://", "https://"}) {
        const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 'a' - 'A') : c; };
        if (std::ranges::equal(text.substr(0, scheme.size()), scheme, {}, lower)) return scheme.size();
    }
    return 0;
}

/// Removes the text before the first `separator` and the separator itself, and returns this text. If there is no
/// separator, removes and returns the whole text.
std::string_view takeUntil(std::string_view& text, char separator) {
    const std::size_t at = text.find(separator);
    const std::string_view head = text.substr(0, at);
    text.remove_prefix(at == std::string_view::npos ? text.size() : at + 1);
    return head;
}

}  // namespace

std::optional<RequestTarget> parseRequestTarget(std::string_view text) {
    RequestTarget target;
    if (const std::size_t scheme = urlSchemeLength(text); scheme > 0) {
        text.remove_prefix(scheme);
        const std::size_t end = std::min(text.find_first_of("/?"), text.size());
        if (!parseAuthority(text.substr(0, end))) return {};
        target.authority = text.substr(0, end);
        text.remove_prefix(end);
        if (text.empty() || text.front() == '?') target.path = "/";
    }
    if (target.path.empty() && !text.starts_with('/')) return {};
    const auto path = text::percentDecoded(takeUntil(text, '?'));
    auto query = session::parseQuery(text);
    if (!path || !query) return {};
    target.path += *path;
    target.query = std::move(*query);
    return target;
}

}  // namespace oval4d::net
