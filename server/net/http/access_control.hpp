#pragma once
// Access control for HTTP requests: Host, Origin and token.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace oval4d::net {

/// The parts of a request that the access rules check: the values of header fields, and the token in the query. A part
/// that is absent is empty. The views refer to the memory of the request.
struct AccessCheckInput {
    std::string_view host{}, origin{}, authorization{}, cookie{};
    std::string_view token{};  ///< the query parameter "token"
    /// What the browser says about the request (W3C Fetch Metadata): Sec-Fetch-Site, such as "same-origin" or
    /// "cross-site"; Sec-Fetch-Mode, such as "navigate"; Sec-Fetch-Dest, such as "document" or "image".
    std::string_view fetchSite{}, fetchMode{}, fetchDestination{};
};

/// The host and port of a URL: "localhost:8080", "[::1]".
struct Authority {
    std::string_view host;  ///< an IPv6 address keeps its brackets
    std::string_view port;  ///< digits, 0 to 65535; empty if none is given
};

/// Parses the host and port of a URL (RFC 3986, section 3.2). Returns an empty optional if the text is malformed or
/// contains user information, a space or a port that is not a number.
std::optional<Authority> parseAuthority(std::string_view text);

/// Decides whether requests are allowed. The server checks all requests except health probes. The Origin check keeps
/// out pages of other sites, the Host check prevents DNS rebinding, and the token keeps out everybody on the network
/// who does not have it.
class AccessControl {
  public:
    /// `loopback`: whether the server listens only on loopback addresses. `hosts`: the allowed host names. If this list
    /// is empty, only loopback names are allowed if `loopback` is true, and all names if it is false. `origins`: the
    /// allowed foreign origins; the server's own origin is always allowed. In both lists, "*" allows all. `token`: the
    /// required token; empty if none is required.
    AccessControl(std::vector<std::string> hosts, std::vector<std::string> origins, std::string token, bool loopback);

    enum class Verdict { allowed, bad_host, bad_origin, bad_token };
    /// Checks the host, then the origin, then the token, and returns the first failure.
    Verdict check(const AccessCheckInput& fields) const;

    /// Returns whether the browser says that a page of another site makes the request, and the origin of that page is
    /// not an allowed foreign origin. Such a request must not cause expensive work. Returns false if a person has
    /// followed a link on a page of another site.
    bool isUnwantedCrossSite(const AccessCheckInput& fields) const;

    /// Returns whether this origin is in the list of allowed foreign origins.
    bool isListedOrigin(std::string_view origin) const;

    /// Returns whether at least one foreign origin is allowed.
    bool allowsForeignOrigins() const { return !origins_.empty(); }

    /// Returns whether requests need a token.
    bool requiresToken() const { return !token_.empty(); }

    /// Returns whether the request contains a token, correct or not.
    static bool presentsToken(const AccessCheckInput& fields);

    /// Returns the value of a Set-Cookie field that stores the token in a cookie, so that later requests of the page
    /// need no token in the query. Returns an empty string unless the query contains the correct token.
    std::string cookieFor(const AccessCheckInput& fields) const;

  private:
    bool isAllowedHost(std::string_view host) const;
    bool isAllowedOrigin(std::string_view origin, std::string_view host) const;
    bool hasCorrectToken(const AccessCheckInput& fields) const;

    std::vector<std::string> hosts_, origins_;
    std::string token_;
};

}  // namespace oval4d::net
