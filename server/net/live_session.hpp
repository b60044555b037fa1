#pragma once
// A session that has clients.

#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "net/pacing.hpp"
#include "net/peer.hpp"
#include "net/services.hpp"
#include "protocol/cpp/request.hpp"
#include "session/session.hpp"
#include "store/keeper.hpp"

namespace oval4d::net {

/// Keeps the session's value and its clients on a strand. Every command is applied as it comes; pictures follow as
/// fast as workers make them and clients show them, always of the newest state: a session has at most one job
/// that is drawn, and one waiting whose state is replaced by each newer one; while a picture is encoded, the next may
/// be drawn. What one revision looks like is worked out once and shared by all clients that want the same.
class LiveSession : public std::enable_shared_from_this<LiveSession> {
  public:
    using Strand = boost::asio::strand<boost::asio::io_context::executor_type>;
    using Id = std::optional<double>;  ///< of a request

    LiveSession(Services services, store::Keeper& keeper, store::Ticket ticket, session::Session value);

    const store::Ticket& ticket() const { return ticket_; }

    /// Greets a client, new or one that wants another stream, with `welcome`; state and picture follow.
    boost::asio::awaitable<void> greet(std::shared_ptr<Peer> peer, protocol::Hello hello, Id id);

    /// Carries out one request of a client that was greeted, and returns once it is answered.
    boost::asio::awaitable<void> carryOut(std::shared_ptr<Peer> peer, protocol::Request request);

    /// Forgets a client, then calls `left` with the session's value on the session's strand; it says whether that was
    /// the last client, with whom the session ends here.
    void leave(std::shared_ptr<Peer> peer, std::function<bool(const session::Session&)> left);

    /// Has the whole session written; `until` is let go of when it is, or the store fails.
    void save(std::shared_ptr<void> until = {});

    /// Sends the clients away: the session goes on elsewhere.
    void dismiss();

  private:
    using Clock = Pacing::Clock;

    /// What a client is shown of each revision.
    struct Want {
        protocol::Stream stream = protocol::Stream::none;
        protocol::Encoding encoding = protocol::Encoding::json;
        scene::Viewport viewport;
        bool operator==(const Want&) const = default;
    };
    struct Client {
        std::weak_ptr<Peer> peer;
        Want want;
        Pacing pacing;
        bool stateUnderWay = false;  ///< with no stream: a `state` message is not yet written
    };
    /// One revision, cut if anybody wants slices. Never changes once made.
    struct Cut {
        session::State state;
        std::uint64_t revision = 0;
        Clock::time_point changed;  ///< when the session came to this revision
        Bytes stateText;
        bool sliced = false;
        geometry::SliceSet slices;
    };
    using CutPtr = std::shared_ptr<const Cut>;
    using Bodies = std::vector<std::pair<Want, Message>>;
    /// What a worker is to do.
    struct Order {
        std::uint64_t job = 0;  ///< its number
        session::State state;
        std::uint64_t revision = 0;
        Clock::time_point changed;
        CutPtr cut;  ///< if this revision was cut before
        std::vector<Want> wants;
    };
    /// A picture that is drawn, and not yet here.
    struct Coming {
        std::uint64_t job = 0, revision = 0;
        Want want;
    };
    struct Outcome {
        std::uint64_t job = 0;
        std::uint64_t revision = 0;
        CutPtr cut;
        Bodies bodies;
        std::vector<Want> failed;
    };

    // On the strand.
    boost::asio::awaitable<void> greetHere(std::shared_ptr<Peer> peer, protocol::Hello hello, Id id);
    boost::asio::awaitable<void> carryOutHere(std::shared_ptr<Peer> peer, protocol::Request request);
    boost::asio::awaitable<void> answer(std::shared_ptr<Peer> peer, protocol::Get get, Id id);
    boost::asio::awaitable<void> answerWithPicture(std::shared_ptr<Peer> peer, Want want, Id id);
    boost::asio::awaitable<void> answerWithFile(std::shared_ptr<Peer> peer, exports::Wish wish, Id id);
    std::function<Message(picture::Painter&)> pictureJob(const Want& want, Id id) const;
    boost::asio::awaitable<void> obey(std::shared_ptr<Peer> peer, const protocol::Command& command, Id id);
    std::function<void(std::function<void(bool)>)> keeping(store::Keeper::Part part);
    void saveSoon();
    void saveHere(store::Keeper::Written written = {});
    void tell(Peer& peer, const protocol::Error& error, Id id);

    void update();
    void turn();
    void order(std::vector<Want> wants);
    void finish(Outcome outcome);
    void deliver(Client& client, const Message& body);
    void deliverState(Client& client);
    void watchPacing();
    const Message* bodyOf(const Want& want, std::uint64_t ofRevision) const;
    bool ready(const Client& client) const;
    std::size_t coming(const Want& want) const;
    bool comes(const Want& want, std::uint64_t ofRevision) const;
    std::uint64_t revision() const { return session_.revision; }

    // On a worker.
    void work(picture::Painter& painter);
    void tellDrawn(const Order& job, const Want& want);
    static CutPtr cut(picture::Painter& painter, const session::State& state, std::uint64_t revision,
                      Clock::time_point changed, const Want& want);
    static bool serves(const CutPtr& cut, const Want& want) {
        return cut && (cut->sliced || want.stream == protocol::Stream::frames);
    }
    static Message draw(picture::Painter& painter, const Cut& cut, const Want& want, Id id,
                        const std::function<void()>& drawn = {});

    // Set once.
    const Services services_;  // first: the rest is made with it
    store::Keeper& keeper_;
    const store::Ticket ticket_;
    Strand strand_;
    const WorkerPool::LanePtr lane_ = std::make_shared<WorkerPool::Lane>();

    // The strand's.
    session::Session session_;
    std::map<const Peer*, Client> clients_;
    Clock::time_point changed_;  ///< when the session came to its revision
    CutPtr cut_;                 ///< the newest, kept while a client waits for it
    Bodies bodies_;              ///< of cut_
    Bytes stateText_;            ///< of stateRevision_, for clients without a stream
    std::optional<std::uint64_t> stateRevision_;
    std::uint64_t jobs_ = 0;      ///< how many there have been
    std::uint64_t drawing_ = 0;   ///< the one that waits or is being drawn, if any
    std::vector<Coming> coming_;  ///< what is drawn and being encoded, meanwhile
    std::optional<Clock::time_point> lastTurn_;
    boost::asio::steady_timer turnTimer_, paceTimer_, saveTimer_;
    bool turnTimerSet_ = false, paceTimerSet_ = false, saveTimerSet_ = false;
    bool over_ = false;  ///< not this object's to write any more

    // Between strand and worker.
    std::mutex orderMutex_;
    std::optional<Order> order_;  ///< the job that waits
};

}  // namespace oval4d::net
