#pragma once
// One accepted socket: HTTP requests, until it ends or becomes a WebSocket.

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <memory>

#include "net/access.hpp"
#include "net/hub.hpp"
#include "net/registry.hpp"
#include "net/routes.hpp"
#include "net/services.hpp"

namespace oval4d::net {

/// What every socket is served with.
struct Front {
    Services services;
    const Access& access;
    Routes& routes;
    std::shared_ptr<Hub> hub;
    Registry& registry;
};

/// Serves a socket to its end. `full`: the server has no place for it and says so.
boost::asio::awaitable<void> serve(boost::asio::ip::tcp::socket socket, Front front, bool full);

}  // namespace oval4d::net
