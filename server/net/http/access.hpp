#pragma once
// Access control for HTTP requests: Host, Origin and token.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace oval4d::net {

/// The parts of a request that identify its sender; empty if absent.
struct Credentials {
    std::string_view host{}, origin{}, authorization{}, cookie{};
    std::string_view fetchSite{};  ///< Sec-Fetch-Site: the browser's statement of where the request comes from
    std::string_view token{};      ///< from the query
};

/// The host and port of a URL: "localhost:8080", "[::1]".
struct Authority {
    std::string_view host;  ///< an IPv6 address keeps its brackets
    std::string_view port;  ///< digits, 0 to 65535; empty if none is given
};

/// Parses the host and port of a URL (RFC 3986, section 3.2). Returns nothing if the text is not one; user information,
/// blanks and non-numeric ports are rejected.
std::optional<Authority> parseAuthority(std::string_view text);

/// The access rules for all requests except health probes. The Origin check keeps out foreign pages, the Host check
/// keeps out DNS rebinding, and the token keeps out everybody else on the network.
class Access {
  public:
    /// `hosts`: allowed host names; if empty, the loopback names if `loopback`, else any. `origins`: allowed foreign
    /// origins; the server's own is always allowed. "*" stands for any. `token`: the required token; empty for none.
    Access(std::vector<std::string> hosts, std::vector<std::string> origins, std::string token, bool loopback);

    enum class Verdict { allowed, bad_host, bad_origin, bad_token };
    /// Checks the host, then the origin, then the token; returns the first failure.
    Verdict judge(const Credentials& credentials) const;

    /// Whether a browser sent the request for a page of another site whose origin is not allowed by name (W3C Fetch
    /// Metadata). Expensive work is refused for such requests.
    bool isCrossSite(const Credentials& credentials) const;

    /// Whether this origin is in the list of allowed foreign origins.
    bool isListedOrigin(std::string_view origin) const;

    /// Whether any foreign origin is allowed.
    bool allowsForeignOrigins() const { return !origins_.empty(); }

    /// Whether requests need a token.
    bool requiresToken() const { return !token_.empty(); }

    /// Whether the request carries a token, correct or not.
    static bool hasToken(const Credentials& credentials);

    /// The Set-Cookie value with which later requests of a page need no token in the query; empty unless the query has
    /// the correct token.
    std::string cookieFor(const Credentials& credentials) const;

  private:
    bool isAllowedHost(std::string_view host) const;
    bool isAllowedOrigin(std::string_view origin, std::string_view host) const;
    bool hasCorrectToken(const Credentials& credentials) const;

    std::vector<std::string> hosts_, origins_;
    std::string token_;
};

}  // namespace oval4d::net
