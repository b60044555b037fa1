#pragma once
// Serves an accepted socket: its HTTP requests, and the WebSocket into which it may turn.

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <memory>

#include "net/clients.hpp"
#include "net/connection_registry.hpp"
#include "net/http/access_control.hpp"
#include "net/http/routes.hpp"
#include "net/live/session_manager.hpp"
#include "net/services.hpp"

namespace oval4d::net {

/// The objects that all connections share.
struct ServerContext {
    Services services;
    const AccessControl& access;
    Routes& routes;
    std::shared_ptr<SessionManager> sessions;
    ConnectionRegistry& connections;
};

/// Serves a socket until it closes. If the server has too many connections, answers each request with status 503; if
/// the client has too many, with status 429.
boost::asio::awaitable<void> serveHttp(boost::asio::ip::tcp::socket socket, ServerContext context);

}  // namespace oval4d::net
