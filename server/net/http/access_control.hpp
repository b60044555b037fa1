#pragma once
// Access control for HTTP requests, by host, origin and token.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace oval4d::net {

/// The parts of a request that the access rules check: header fields, and the token in the query. A missing part is
/// empty. The views refer to the memory of the request.
struct AccessCheckInput {
    std::string_view host{}, origin{}, authorization{}, cookie{};
    std::string_view token{};  ///< the query parameter "token"
    /// What the browser says about the request (W3C Fetch Metadata). fetchSite is Sec-Fetch-Site, such as "cross-site";
    /// fetchMode is Sec-Fetch-Mode, such as "navigate"; fetchDestination is Sec-Fetch-Dest, such as "document".
    std::string_view fetchSite{}, fetchMode{}, fetchDestination{};
};

/// The host and port in a URL, such as "localhost:8080" or "[::1]".
struct UrlAuthority {
    std::string_view host;  ///< an IPv6 address keeps its brackets
    std::string_view port;  ///< digits, 0 to 65535; empty if none is given
};

/// Parses the host and port in a URL (RFC 3986, section 3.2). Returns an empty optional if the text is malformed, or
/// has user information, a space or a port that is not a number.
std::optional<UrlAuthority> parseAuthority(std::string_view text);

/// Decides whether requests are allowed. The server checks all requests except health probes. The check of Origin keeps
/// out pages of other sites. The check of Host prevents DNS rebinding. The token keeps out everybody on the network who
/// does not know it.
class AccessControl {
  public:
    /// `hosts` are the allowed host names. `loopback` tells whether the server listens only on loopback addresses. If
    /// `hosts` is empty, only loopback names are allowed if `loopback` is true, and all names if it is false. `origins`
    /// are the allowed foreign origins; the server's own origin is always allowed. In `hosts` and in `origins`, "*"
    /// allows all. `token` is the required token; empty if none is required.
    AccessControl(std::vector<std::string> hosts, std::vector<std::string> origins, std::string token, bool loopback);

    enum class Verdict { allowed, bad_host, bad_origin, bad_token };
    /// Checks the host, then the origin, then the token. Returns the first failure, or `allowed`.
    Verdict check(const AccessCheckInput& fields) const;

    /// Returns whether, according to the browser, a page of another site has made the request, and this site is not an
    /// allowed foreign origin. Such a request must not cause expensive work. Returns false if the user has followed a
    /// link on such a page.
    bool isUnwantedCrossSite(const AccessCheckInput& fields) const;

    /// Returns whether this origin is in the list of allowed foreign origins.
    bool isListedOrigin(std::string_view origin) const;

    /// Returns whether at least one foreign origin is allowed.
    bool allowsForeignOrigins() const { return !origins_.empty(); }

    /// Returns whether requests need a token.
    bool requiresToken() const { return !token_.empty(); }

    /// Returns whether the request contains any token, correct or wrong.
    static bool presentsToken(const AccessCheckInput& fields);

    /// Returns the value of a Set-Cookie field that stores the token in a cookie. Later requests of the page then need
    /// no token in the query. Returns an empty string unless the query contains the correct token.
    std::string tokenCookieFor(const AccessCheckInput& fields) const;

  private:
    bool isAllowedHost(std::string_view host) const;
    bool isAllowedOrigin(std::string_view origin, std::string_view host) const;
    bool hasCorrectToken(const AccessCheckInput& fields) const;

    std::vector<std::string> hosts_, origins_;
    std::string token_;
};

}  // namespace oval4d::net
