#pragma once
// Where sessions are kept while nobody looks at them.

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>
#include <variant>

#include "protocol/cpp/error.hpp"
#include "session/session.hpp"

namespace oval4d::store {

/// Wall-clock time: a store may outlive the process.
using Time = std::chrono::system_clock::time_point;

/// What opens a session: its public name, and the secret that goes with it.
struct Ticket {
    std::string id, token;
};

/// Sessions by id. Between `create` or `open` and `close` a session is in use, and its value is the caller's.
/// Every function may be called from any thread.
class Store {
  public:
    virtual ~Store() = default;

    /// Makes room for a new session, in use from now on; `too_many` when the store is full.
    virtual protocol::Result<Ticket> create() = 0;

    /// Whether this ticket opens a session: `not_found` or `bad_token` if it does not.
    virtual protocol::Result<std::monostate> admit(const Ticket& ticket) const = 0;

    /// The value of a session that is not in use; in use from now on. `not_found` if it has expired.
    virtual protocol::Result<session::Session> open(std::string_view id) = 0;

    /// Keeps the value of a session in use, until it is opened again or expires.
    virtual void close(std::string_view id, session::Session value, Time now) = 0;

    /// Forgets the sessions closed before `limit`, and returns how many they were.
    virtual std::size_t expire(Time limit) = 0;

    /// All sessions, in use or not.
    virtual std::size_t size() const = 0;
};

}  // namespace oval4d::store
