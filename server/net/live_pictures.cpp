// The other half of LiveSession: from a change to the pictures of it.

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/post.hpp>

#include "net/live_session.hpp"
#include "protocol/cpp/codec.hpp"

namespace oval4d::net {

namespace asio = boost::asio;
using protocol::Stream;

namespace {

using namespace std::chrono_literals;

constexpr auto kTurnInterval = std::chrono::duration_cast<Pacing::Clock::duration>(1s) / 60;
// After a pause, as of a client that shows a picture a second, a turn goes on from where it was, not with a leap.
constexpr auto kLongestTurn = 250ms;

const protocol::Error kNoPicture{protocol::ErrorCode::internal, "this picture could not be made; the session goes on"};

}  // namespace

/// Brings every client nearer to the newest revision: hands out what there is, orders what is missing. To be called
/// after whatever may have changed the session, or made a client or a worker free.
void LiveSession::update() {
    turn();
    std::vector<Want> missing;
    bool allServed = true;
    for (auto& [key, client] : clients_) {
        if (client.pacing.newest() == revision()) continue;
        if (client.want.stream == Stream::none) {
            if (!client.stateUnderWay) deliverState(client);
            continue;
        }
        allServed = false;
        if (!client.pacing.free()) continue;
        if (const Message* body = bodyOf(client.want, revision())) {
            deliver(client, *body);
        } else if (!comes(client.want, revision()) && client.pacing.free(coming(client.want)) &&
                   std::ranges::find(missing, client.want) == missing.end()) {
            missing.push_back(client.want);
        }
    }
    if (!missing.empty()) order(std::move(missing));
    if (allServed) {
        cut_.reset();
        bodies_ = {};
    }
}

/// Continues a continuous turn, when its time has come and some client has had the present and can take more.
void LiveSession::turn() {
    if (!session_.now.turning) {
        lastTurn_.reset();
        return;
    }
    if (drawing_ != 0 || std::ranges::none_of(clients_, [this](const auto& entry) { return ready(entry.second); }))
        return;
    const auto now = Clock::now();
    if (lastTurn_ && now - *lastTurn_ < kTurnInterval) {
        if (turnTimerSet_) return;
        turnTimerSet_ = true;
        turnTimer_.expires_at(*lastTurn_ + kTurnInterval);
        turnTimer_.async_wait([weak = weak_from_this()](boost::system::error_code) {
            if (const auto self = weak.lock()) {
                self->turnTimerSet_ = false;
                self->update();
            }
        });
        return;
    }
    const auto passed = lastTurn_ ? std::min<Clock::duration>(now - *lastTurn_, kLongestTurn) : kTurnInterval;
    lastTurn_ = now;
    changed_ = now;
    session::advance(session_, Seconds(passed).count());
    saveSoon();
}

bool LiveSession::ready(const Client& client) const {
    if (client.pacing.newest() != revision() && !comes(client.want, revision())) return false;
    return client.want.stream == Stream::none ? !client.stateUnderWay : client.pacing.free(coming(client.want));
}

std::size_t LiveSession::coming(const Want& want) const {
    return static_cast<std::size_t>(std::ranges::count(coming_, want, &Coming::want));
}

bool LiveSession::comes(const Want& want, std::uint64_t ofRevision) const {
    return std::ranges::any_of(coming_,
                               [&](const Coming& each) { return each.want == want && each.revision == ofRevision; });
}

/// Replaces the waiting job, or posts one. One that is being drawn is let be: when it is drawn, `update` looks again.
void LiveSession::order(std::vector<Want> wants) {
    const CutPtr known = cut_ && cut_->revision == revision() ? cut_ : nullptr;
    const bool first = drawing_ == 0;
    Order next{first ? jobs_ + 1 : drawing_, session_.now, revision(), changed_, known, std::move(wants)};
    {
        const std::lock_guard lock(orderMutex_);
        if (!first && !order_) return;
        order_ = std::move(next);
    }
    if (!first) return;
    drawing_ = ++jobs_;
    services_.pool.post([self = shared_from_this()](picture::Painter& painter) { self->work(painter); }, lane_);
}

void LiveSession::work(picture::Painter& painter) {
    Order job;
    {
        const std::lock_guard lock(orderMutex_);
        job = std::move(*order_);
        order_.reset();
    }
    Outcome outcome{job.job, job.revision, job.cut, {}, {}};
    for (const Want& want : job.wants) {
        try {
            if (!serves(outcome.cut, want)) outcome.cut = cut(painter, job.state, job.revision, job.changed, want);
            std::function<void()> whenDrawn;
            if (&want == &job.wants.back()) whenDrawn = [this, &job, &want] { tellDrawn(job, want); };
            outcome.bodies.emplace_back(want, draw(painter, *outcome.cut, want, {}, whenDrawn));
            services_.metrics.observe(painter.times());
        } catch (const std::exception& fault) {
            spdlog::error("picture failed session={} revision={} fault=\"{}\"", ticket_.id, job.revision, fault.what());
            outcome.failed.push_back(want);
        }
    }
    asio::post(strand_, [self = shared_from_this(), outcome = std::move(outcome)]() mutable {
        self->finish(std::move(outcome));
    });
}

/// On a worker: all that is left of this job is to encode its last picture.
void LiveSession::tellDrawn(const Order& job, const Want& want) {
    asio::post(strand_, [self = shared_from_this(), done = Coming{job.job, job.revision, want}] {
        if (self->drawing_ == done.job) self->drawing_ = 0;
        self->coming_.push_back(done);
        self->update();
    });
}

/// Takes what a worker made. Though the session may have moved on, it is newer than what its clients have: under a
/// flood of changes they see every picture that there is time to make.
void LiveSession::finish(Outcome outcome) {
    if (drawing_ == outcome.job) drawing_ = 0;
    std::erase_if(coming_, [&](const Coming& each) { return each.job == outcome.job; });
    const bool late = outcome.cut && cut_ && outcome.cut->revision < cut_->revision;
    if (outcome.cut && outcome.cut != cut_ && !late) {
        cut_ = outcome.cut;
        bodies_.clear();
    }
    if (!late) std::ranges::move(outcome.bodies, std::back_inserter(bodies_));
    for (auto& [key, client] : clients_) {
        if (client.want.stream == Stream::none || !client.pacing.free()) continue;
        if (client.pacing.newest() && *client.pacing.newest() >= outcome.revision) continue;
        if (const Message* body = bodyOf(client.want, outcome.revision)) {
            deliver(client, *body);
        } else if (std::ranges::find(outcome.failed, client.want) != outcome.failed.end()) {
            client.pacing.skipped(outcome.revision);
            if (const auto peer = client.peer.lock()) tell(*peer, kNoPicture, {});
        }
    }
    update();
}

const Message* LiveSession::bodyOf(const Want& want, std::uint64_t ofRevision) const {
    if (!cut_ || cut_->revision != ofRevision) return nullptr;
    const auto found = std::ranges::find(bodies_, want, &Bodies::value_type::first);
    return found == bodies_.end() ? nullptr : &found->second;
}

/// Sends the picture of `cut_`, and its state before it.
void LiveSession::deliver(Client& client, const Message& body) {
    const auto peer = client.peer.lock();
    if (!peer) return;
    client.pacing.sent(cut_->revision);
    services_.metrics.countPicture(client.want.stream);
    peer->send({cut_->stateText, false});
    peer->send(body, [weak = weak_from_this(), to = client.peer, sent = cut_->revision, since = cut_->changed] {
        const auto now = Clock::now();
        const auto session = weak.lock();
        if (!session) return;
        session->services_.metrics.latency.Observe(Seconds(now - since).count());
        asio::post(session->strand_, [session, to, sent, now] {
            const auto written = session->clients_.find(to.lock().get());
            if (written == session->clients_.end()) return;
            written->second.pacing.written(sent, now);
            session->watchPacing();
        });
    });
}

/// A client without a stream has each state as soon as its socket takes it; of those in between, the newest.
void LiveSession::deliverState(Client& client) {
    const auto peer = client.peer.lock();
    if (!peer) return;
    if (stateRevision_ != revision()) {
        stateText_ = Bytes(protocol::stateMessage(session_.now, revision()));
        stateRevision_ = revision();
    }
    client.pacing.skipped(revision());
    client.stateUnderWay = true;
    peer->send({stateText_, false}, [weak = weak_from_this(), to = client.peer] {
        const auto session = weak.lock();
        if (!session) return;
        asio::post(session->strand_, [session, to] {
            const auto written = session->clients_.find(to.lock().get());
            if (written == session->clients_.end()) return;
            written->second.stateUnderWay = false;
            session->update();
        });
    });
}

/// Sees to it that pictures which a client does not acknowledge count as shown in time.
void LiveSession::watchPacing() {
    if (paceTimerSet_) return;
    const auto timeout = std::chrono::duration_cast<Clock::duration>(services_.options.shownTimeout);
    std::optional<Clock::time_point> first;
    for (const auto& [key, client] : clients_) {
        const auto deadline = client.pacing.deadline(timeout);
        if (deadline && (!first || *deadline < *first)) first = deadline;
    }
    if (!first) return;
    paceTimerSet_ = true;
    paceTimer_.expires_at(*first);
    paceTimer_.async_wait([weak = weak_from_this(), timeout](boost::system::error_code) {
        const auto self = weak.lock();
        if (!self) return;
        self->paceTimerSet_ = false;
        for (auto& [key, client] : self->clients_) client.pacing.expire(Clock::now(), timeout);
        self->update();
        self->watchPacing();
    });
}

LiveSession::CutPtr LiveSession::cut(picture::Painter& painter, const session::State& state, std::uint64_t revision,
                                     Clock::time_point changed, const Want& want) {
    auto made = std::make_shared<Cut>();
    made->state = state;
    made->revision = revision;
    made->changed = changed;
    made->stateText = Bytes(protocol::stateMessage(state, revision));
    made->sliced = want.stream != Stream::frames;
    if (made->sliced) painter.cut(state, made->slices);
    return made;
}

Message LiveSession::draw(picture::Painter& painter, const Cut& cut, const Want& want, Id id,
                          const std::function<void()>& drawn) {
    if (want.stream == Stream::frames) {
        std::vector<std::uint8_t> png;
        painter.frame(cut.state, cut.stateText.view(), want.viewport, png, drawn);
        return {Bytes(std::move(png)), true};
    }
    std::string text;
    painter.message(cut.state, cut.slices, cut.revision, id, want.viewport, want.encoding, text);
    return {Bytes(std::move(text)), want.encoding == protocol::Encoding::cbor};
}

}  // namespace oval4d::net
