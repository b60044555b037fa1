#pragma once
// A session with connected clients.

#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/strand.hpp>
#include <cassert>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "net/live/field_refinement.hpp"
#include "net/live/metered_session.hpp"
#include "net/live/object_loading.hpp"
#include "net/live/peer.hpp"
#include "net/live/request_answers.hpp"
#include "net/live/session_publisher.hpp"
#include "net/live/session_saver.hpp"
#include "net/services.hpp"
#include "session/session.hpp"
#include "store/write_behind_store.hpp"
#include "wire/request.hpp"

namespace oval4d::net {

/// A session in use. Holds the value of the session, and applies each command when it arrives. Its parts do the rest:
/// - SessionPublisher sends changed states and pictures to the clients.
/// - SessionSaver saves the session in the store.
/// - FieldRefinement replaces a coarse level of an image by finer ones.
/// - RequestAnswerer answers questions.
///
/// The members of a session are used only on its strand. Public functions may be called from any thread.
class LiveSession : public std::enable_shared_from_this<LiveSession> {
  public:
    using Strand = SessionPublisher::Strand;
    using RequestId = RequestAnswerer::RequestId;

    /// `client` opened the session; the session's memory counts as bytes held for this client (ByteBudget::Account).
    /// `value` is the session's value, new or read from the store. `fence` is the number with which the session was
    /// created in the store or fetched from it (see store::FencingToken).
    LiveSession(Services services, store::WriteBehindStore& writeBehind, store::SessionCredentials credentials,
                store::FencingToken fence, ClientAccountPtr client, session::Session value);

    const store::SessionCredentials& credentials() const { return credentials_; }

    /// Adds a client to the session. If the client was added before, changes the pictures that it receives. Sends the
    /// client the message `welcome`, then the state and a picture. If another server has taken over the session, closes
    /// the client's connection instead.
    boost::asio::awaitable<void> addAndWelcome(std::shared_ptr<Peer> peer, wire::Hello hello, RequestId id);

    /// Executes a request of a client that addAndWelcome() has added. Returns when the request is answered. A request
    /// for critical values of w is an exception: the function returns at once, and the answer follows later.
    boost::asio::awaitable<void> execute(std::shared_ptr<Peer> peer, wire::Request request);

    /// The result of a command.
    struct CommandResult {
        std::uint64_t revision = 0;
        std::vector<std::string> warnings;  ///< warnings about a loaded file
        bool owned = true;                  ///< false if another server has meanwhile taken over the session
    };
    /// Applies a command for a client that need not be connected to the session. Connected clients see the change.
    /// Errors: those of session::apply(); `too_many` if a limit on bytes or jobs is reached; `internal` if another
    /// server has taken over the session. The awaited optional is never empty; Asio requires a default-constructible
    /// result.
    boost::asio::awaitable<std::optional<Result<CommandResult>>> apply(ClientAccountPtr client,
                                                                       session::Command command);

    /// Removes the client `peer`, or nobody if `peer` is null. Then calls `left` with the session's value. Both happen
    /// on the session's strand. `left` must return whether the session has no clients left; if so, this object never
    /// writes the session to the store again. Must be called after the client's requests have been executed, so that
    /// the value contains their results.
    void leave(std::shared_ptr<Peer> peer, std::function<bool(const session::Session&)> left);

    /// Stops the searches for critical values of w that `peer` has requested. Their requests fail with `canceled`.
    void stopSearches(std::shared_ptr<Peer> peer);

    /// Writes the whole session to the store. Holds `completion` until the session is written or the store is found to
    /// be unavailable. A caller that keeps a std::weak_ptr to `completion` can wait until the weak_ptr expires.
    void save(std::shared_ptr<void> completion = {});

    /// Closes the connections of all clients, and never writes the session to the store again. Must be called when
    /// another server has taken over the session.
    void detachAndDisconnectAll();

  private:
    using Clock = SessionPublisher::Clock;

    // The functions of this group run on the session's strand.
    void assertOnStrand() const {
        assert(strand_.running_in_this_thread() && "the session is used outside its strand");
    }
    boost::asio::awaitable<void> executeOnStrand(std::shared_ptr<Peer> peer, wire::Request request);
    /// Executes a request and answers it. Each alternative of wire::Request::body has a specialization; if one is
    /// missing, the program does not link.
    template <typename RequestBody>
    boost::asio::awaitable<void> executeAndAnswer(std::shared_ptr<Peer> peer, RequestBody /*body*/, RequestId id);
    boost::asio::awaitable<std::optional<Result<CommandResult>>> applyOnStrand(ClientAccountPtr by,
                                                                               session::Command command);
    boost::asio::awaitable<Result<CommandResult>> applyCommand(ClientAccountPtr by, std::shared_ptr<Peer> peer,
                                                               const session::Command& command, bool awaitStore);

    std::uint64_t revision() const { return session_.revision; }

    // The members of this group do not change after construction.
    const Services services_;  // declared first, because other members are initialized from it
    const store::SessionCredentials credentials_;
    Strand strand_;  // runs all code that uses the members of the next group

    // Only code on the strand uses the members of this group.
    const std::shared_ptr<MeteredSession> metered_;
    session::Session& session_;  // the value of metered_
    const std::shared_ptr<SessionPublisher> publisher_;
    const std::shared_ptr<ObjectLoading> loading_;
    const std::shared_ptr<RequestAnswerer> answers_;
    const std::shared_ptr<SessionSaver> saver_;
    const std::shared_ptr<FieldRefinement> refinement_;
};

}  // namespace oval4d::net
