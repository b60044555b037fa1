// Fuzzes the access control of HTTP requests and the parsing of their targets. The input has five lines: the target,
// Host, Origin, Authorization and Cookie.

#include <algorithm>
#include <array>
#include <string_view>

#include "net/http/access_control.hpp"
#include "net/http/request_target.hpp"
#include "pipeline/export_pipeline.hpp"
#include "session/query.hpp"
#include "support.hpp"
#include "wire/export_query.hpp"

using namespace oval4d;
using fuzz::require;

namespace {

constexpr std::string_view kToken = "s3cr3t";

std::string encoded(std::string_view text) {
    constexpr std::string_view kHex = "0123456789abcdef";
    std::string out;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        out += {'%', kHex[byte >> 4U], kHex[byte & 0xFU]};
    }
    return out;
}

void requireReadsBack(const net::RequestTarget& target) {
    std::string text = "/" + encoded(std::string_view(target.path).substr(1)) + "?";
    for (const auto& [name, value] : target.query) text += encoded(name) + "=" + encoded(value) + "&";
    const auto again = net::parseRequestTarget(text);
    require(again && again->path == target.path, "a path survives being encoded");
    require(again->query == target.query, "a query survives being encoded");
}

/// Returns whether `text` contains `part`, ignoring case.
bool contains(std::string_view text, std::string_view part) {
    const auto same = [](char a, char b) { return (a | 0x20) == (b | 0x20); };
    return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

void judge(const net::AccessCheckInput& who) {
    using Verdict = net::AccessControl::Verdict;
    const net::AccessControl loopback({}, {}, "", true);
    if (loopback.check(who) == Verdict::allowed) {
        require(contains(who.host, "localhost") || contains(who.host, "127.0.0.1") || contains(who.host, "[::1]"),
                "on loopback only its names are known:", who.host);
        std::string_view name = net::parseAuthority(who.host)->host;
        if (name.ends_with('.')) name.remove_suffix(1);
        require(who.origin.empty() || contains(who.origin, "://" + std::string(name)),
                "only the server's own pages may speak to it:", who.origin);
    }
    const net::AccessControl open({"*"}, {"https://friend.example"}, std::string(kToken), false);
    if (open.check(who) == Verdict::allowed) {
        require(who.token == kToken || who.authorization.ends_with(kToken) || contains(who.cookie, "oval4d_token="),
                "without the token nobody is let in");
    }
    const std::string cookie = open.tokenCookieFor(who);
    require(cookie.empty() || who.token == kToken, "the cookie is for who has the token");
    if (cookie.empty()) return;
    net::AccessCheckInput back = who;
    back.token = {};
    const std::string pair = cookie.substr(0, cookie.find(';'));
    back.cookie = pair;
    require(open.check(back) == open.check(who), "the cookie is as good as the token");
}

void describe(session::QueryParameters query) {
    const auto large = [](const auto& entry) { return entry.first == "polytope" && !fuzz::isSmall(entry.second); };
    if (std::any_of(query.begin(), query.end(), large)) return;
    std::erase_if(query, [](const auto& entry) { return entry.first == "token"; });
    for (const exports::Format& format : exports::formats()) {
        session::QueryParameters settings = query;
        const auto request = wire::extractExportRequest(settings, format, fuzz::kLimits.maxSlices);
        if (!request) {
            fuzz::requireSentence(request.error());
            return;
        }
        require(request->format == &format && request->size >= exports::kMinSize && request->size <= exports::kMaxSize,
                "a file is of the size that is allowed");
        constexpr auto kTaken = std::to_array<std::string_view>({"of", "body", "label", "size", "at", "fit", "exact"});
        for (const auto& [name, value] : settings)
            require(std::ranges::find(kTaken, name) == kTaken.end(), "what was taken is gone");
        if (&format != &exports::formats().back()) continue;
        session::ObjectLoader loader(fuzz::kLimits, fuzz::cache());
        const auto state = session::stateFromQuery(settings, fuzz::kLimits, loader);
        if (!state) {
            fuzz::requireSentence(state.error());
            return;
        }
        fuzz::requireSound(*state, fuzz::kLimits);
        fuzz::requireRoundTrip(*state, {});
        const std::string name = pipeline::exportFileName(state->object, *request);
        const std::string_view plain = "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ-_.";
        require(name.find_first_not_of(plain) == std::string::npos, "a file's name needs no quoting:", name);
    }
}

}  // namespace

OVAL4D_FUZZER(address) {
    std::string_view rest = fuzz::textOf(data, size);
    const auto target = net::parseRequestTarget(fuzz::takeUntil(rest, '\n'));
    net::AccessCheckInput who;
    for (std::string_view* header : {&who.host, &who.origin, &who.authorization, &who.cookie})
        *header = fuzz::takeUntil(rest, '\n');
    if (target) {
        require(target->path.starts_with('/'), "a path begins with a slash");
        requireReadsBack(*target);
        for (const auto& [name, value] : target->query) {
            if (name == "token") who.token = value;
        }
        describe(target->query);
    }
    judge(who);
    return 0;
}
