#pragma once
// Serves the HTTP requests of an accepted socket until the connection ends or becomes a WebSocket.

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <memory>

#include "net/clients.hpp"
#include "net/connection_registry.hpp"
#include "net/http/access.hpp"
#include "net/http/routes.hpp"
#include "net/live/session_manager.hpp"
#include "net/services.hpp"

namespace oval4d::net {

/// The objects that all connections share.
struct ServerContext {
    Services services;
    const Access& access;
    Routes& routes;
    std::shared_ptr<SessionManager> sessions;
    ConnectionRegistry& connections;
};

/// Serves a socket until it closes. Beyond a connection limit, replies to requests with status 503 (limit of the
/// server) or 429 (limit of the client).
boost::asio::awaitable<void> serve(boost::asio::ip::tcp::socket socket, ServerContext context);

}  // namespace oval4d::net
