#pragma once
// The HTTP routes of the server: pictures, files, metadata, health probes, metrics and the web client.

#include <boost/asio/awaitable.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "export/export_request.hpp"
#include "net/clients.hpp"
#include "net/http/reply.hpp"
#include "net/http/request_target.hpp"
#include "net/http/web_files.hpp"
#include "net/live/session_manager.hpp"
#include "net/readiness.hpp"
#include "net/services.hpp"

namespace oval4d::net {

/// Answers HTTP requests. Every function may be called from any thread.
class Routes {
  public:
    Routes(Services services, const WebFiles& files, const Readiness& readiness, const SessionManager& sessions)
        : services_(services), files_(files), readiness_(readiness), sessions_(sessions) {}

    /// The parts of a request that the routes use. A header field that the request lacks is an empty string.
    struct ParsedRequest {
        std::string method;
        RequestTarget target;
        std::string ifNoneMatch, acceptEncoding, range, ifRange;
        ClientAccountPtr client;
    };
    /// Returns the reply to a request. The status is 405 for methods other than GET and HEAD, and 404 for unknown
    /// paths.
    boost::asio::awaitable<HttpReply> answer(ParsedRequest request);

  private:
    boost::asio::awaitable<HttpReply> catalogue(ClientAccountPtr client);
    boost::asio::awaitable<HttpReply> frame(session::QueryParameters query, ClientAccountPtr client);
    boost::asio::awaitable<HttpReply> file(session::QueryParameters query, const exports::Format& format,
                                           ClientAccountPtr client);
    boost::asio::awaitable<Result<session::State>> stateFromQueryOnWorker(session::QueryParameters query,
                                                                          std::span<const std::string_view> others,
                                                                          ClientAccountPtr client);
    HttpReply countedErrorReply(const Error& error);
    HttpReply readiness() const;
    HttpReply metrics();

    const Services services_;
    const WebFiles& files_;
    const Readiness& readiness_;
    const SessionManager& sessions_;
};

}  // namespace oval4d::net
