#pragma once
// Access control for HTTP requests: Host, Origin and token.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace oval4d::net {

/// The parts of a request that the access rules check: the values of header fields, and the token in the query. Empty
/// if absent. They refer to the memory of the request.
struct Credentials {
    std::string_view host{}, origin{}, authorization{}, cookie{};
    std::string_view fetchSite{};  ///< Sec-Fetch-Site: whether, according to the browser, another site made the request
    std::string_view token{};      ///< the query parameter "token"
};

/// The host and port of a URL: "localhost:8080", "[::1]".
struct Authority {
    std::string_view host;  ///< an IPv6 address keeps its brackets
    std::string_view port;  ///< digits, 0 to 65535; empty if none is given
};

/// Parses the host and port of a URL (RFC 3986, section 3.2). Returns nothing if the text is malformed or contains user
/// information, a space or a port that is not a number.
std::optional<Authority> parseAuthority(std::string_view text);

/// Checks whether requests are allowed, for all requests except health probes. The Origin check keeps out pages of
/// other sites, the Host check prevents DNS rebinding, and the token keeps out everybody else on the network.
class Access {
  public:
    /// `hosts`: the allowed host names; if empty, the loopback names are allowed if `loopback`, else any. `origins`:
    /// the allowed foreign origins; the server's own is always allowed. In both lists, "*" allows any. `token`: the
    /// required token; empty if none is required. `loopback`: whether the server listens only on loopback addresses.
    Access(std::vector<std::string> hosts, std::vector<std::string> origins, std::string token, bool loopback);

    enum class Verdict { allowed, bad_host, bad_origin, bad_token };
    /// Checks the host, then the origin, then the token, and returns the first failure.
    Verdict judge(const Credentials& credentials) const;

    /// Returns whether a browser sent the request for a page of another site (W3C Fetch Metadata) whose origin is not
    /// in the list of allowed foreign origins. Such requests must not cause expensive work.
    bool isCrossSite(const Credentials& credentials) const;

    /// Returns whether this origin is in the list of allowed foreign origins.
    bool isListedOrigin(std::string_view origin) const;

    /// Returns whether any foreign origin is allowed.
    bool allowsForeignOrigins() const { return !origins_.empty(); }

    /// Returns whether requests need a token.
    bool requiresToken() const { return !token_.empty(); }

    /// Returns whether the request contains a token, correct or not.
    static bool hasToken(const Credentials& credentials);

    /// Returns the Set-Cookie value with which later requests of a page need no token in the query. Returns an empty
    /// text unless the query contains the correct token.
    std::string cookieFor(const Credentials& credentials) const;

  private:
    bool isAllowedHost(std::string_view host) const;
    bool isAllowedOrigin(std::string_view origin, std::string_view host) const;
    bool hasCorrectToken(const Credentials& credentials) const;

    std::vector<std::string> hosts_, origins_;
    std::string token_;
};

}  // namespace oval4d::net
