#pragma once
// Who may speak to the server.

#include <string>
#include <string_view>
#include <vector>

namespace oval4d::net {

/// The headers of a request that tell who sent it; empty where they are absent.
struct Credentials {
    std::string_view host{}, origin{}, authorization{}, cookie{};
    std::string_view token{};  ///< of the query
};

/// Rules for every request but the probes'. They keep foreign pages out (Origin), and pages that rename this machine
/// (Host); a token keeps out everybody else on the network.
class Access {
  public:
    /// Empty lists: the loopback names where `loopback`, else any host; the server's own origin. Empty token: none is
    /// asked for.
    Access(std::vector<std::string> hosts, std::vector<std::string> origins, std::string token, bool loopback);

    enum class Verdict { allowed, bad_host, bad_origin, bad_token };
    Verdict judge(const Credentials& credentials) const;

    /// The Set-Cookie value that spares a page the token from then on; empty unless the query carries the right token.
    std::string cookieFor(const Credentials& credentials) const;

  private:
    bool knowsHost(std::string_view host) const;
    bool knowsOrigin(std::string_view origin, std::string_view host) const;
    bool knowsToken(const Credentials& credentials) const;

    std::vector<std::string> hosts_, origins_;
    std::string token_;
};

}  // namespace oval4d::net
