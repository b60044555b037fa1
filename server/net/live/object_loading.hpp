#pragma once
// Loads the objects that the commands and questions of a session need.

#include <boost/asio/awaitable.hpp>
#include <memory>
#include <optional>
#include <stop_token>
#include <utility>

#include "errors/error.hpp"
#include "net/clients.hpp"
#include "net/live/critical_searches.hpp"
#include "net/live/metered_session.hpp"
#include "net/live/peer.hpp"
#include "net/live/session_publisher.hpp"
#include "net/services.hpp"
#include "session/object_loader.hpp"

namespace oval4d::net {

/// Builds and reads objects that commands need, and searches for critical values of w. The work runs on workers. Every
/// function runs on the session's strand.
class ObjectLoading {
  public:
    ObjectLoading(Services services, std::shared_ptr<MeteredSession> metered,
                  std::shared_ptr<SessionPublisher> publisher)
        : services_(services), metered_(std::move(metered)), publisher_(std::move(publisher)) {}

    /// Returns a loader that defers slow work (ObjectLoader::LoadingMode::deferred). Allocates no memory, because most
    /// commands load nothing.
    session::ObjectLoader makeLoader() const;

    /// Does the work that `loader` has deferred, on a worker: builds or reads an object, or searches for critical
    /// values of w (see slicing/critical/). A search runs on an export worker, and criticalSearches() can stop it. `by`
    /// is the client in whose job queue the job waits, unless a file is read: that job waits in the queue of the client
    /// that opened the session. `peer` is the connection that needs the result; it may be null. `stop` ends the reading
    /// of a file early, with parallel::Canceled. The caller must keep `loader` until the function returns.
    ///
    /// Returns the error `too_many` if the byte account of the session's client has no room for the result, else an
    /// empty optional. Throws parallel::QueueFull if too many jobs are waiting, and the exceptions of the job. After an
    /// exception, the caller must not use `loader`.
    boost::asio::awaitable<std::optional<Error>> completePending(ClientAccountPtr by, std::shared_ptr<Peer> peer,
                                                                 session::ObjectLoader& loader,
                                                                 std::stop_token stop = {});

    /// Reads an array of the data folder on a worker, for the client that opened the session. Errors and exceptions:
    /// those of session::ObjectLoader::objectFrom() and completePending().
    boost::asio::awaitable<Result<slicing::Object>> readArrayInBackground(session::LoadObject load,
                                                                          std::stop_token stop);

    /// Returns the searches for critical values of w that completePending() runs.
    CriticalValueSearches& criticalSearches() { return searches_; }

  private:
    const Services services_;
    const std::shared_ptr<MeteredSession> metered_;
    const std::shared_ptr<SessionPublisher> publisher_;
    CriticalValueSearches searches_;
};

}  // namespace oval4d::net
