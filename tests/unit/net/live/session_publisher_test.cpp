// When a session's pictures are made and sent, in virtual time.

#include "net/live/session_publisher.hpp"

#include <boost/asio/post.hpp>
#include <boost/asio/strand.hpp>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "pipeline/focus_section.hpp"
#include "session/picture.hpp"
#include "unit/net/live/recording_peer.hpp"
#include "unit/net/virtual_server.hpp"
#include "unit/session/support.hpp"

namespace oval4d::net {
namespace {

namespace asio = boost::asio;
using namespace std::chrono_literals;
using Revisions = std::vector<std::uint64_t>;

const session::Rotate kRotation{{geometry::Plane::xw, 0.1}};

session::ChangeSettings turning(bool on) {
    session::ChangeSettings set;
    set.turning = on;
    return set;
}

class SessionPublisherTest : public testing::Test {
  protected:
    explicit SessionPublisherTest(const ServerOptions& options = {}) : server(options) {
        publisher->setMotionListener([this] { ++steps; });
    }

    /// Calls `work` on the session's strand.
    void post(const std::function<void()>& work) { asio::post(strand, work); }
    /// Adds a client on the strand. The client receives `slices` messages. `acknowledges` tells whether it acknowledges
    /// pictures.
    std::shared_ptr<RecordingPeer> add(bool acknowledges) {
        auto peer = std::make_shared<RecordingPeer>(server.account);
        if (acknowledges) {
            peer->whenPictureArrives = [this, raw = peer.get()](std::uint64_t revision) {
                post([this, raw, revision] { publisher->recordPictureShown(*raw, revision); });
            };
        }
        post([this, peer] {
            publisher->addSubscriber(peer, {wire::StreamKind::geometry, wire::Encoding::json, {640, 480}});
            publisher->sendAndRequestPictures();
        });
        return peer;
    }
    /// Adds a client as add() does, then runs all handlers and jobs (see VirtualServer::settle()).
    std::shared_ptr<RecordingPeer> connect(bool acknowledges) {
        auto peer = add(acknowledges);
        server.settle();
        return peer;
    }
    /// Applies a command as LiveSession does, then runs all handlers and jobs.
    void change(const session::Command& command) {
        post([this, command] {
            session::must(value, command);
            publisher->recordSessionChange(server.clock.now());
            publisher->sendAndRequestPictures();
        });
        server.settle();
    }
    /// Makes the session show one slice of a field. Must be called before a client is added.
    void showField() {
        session::must(value, session::LoadObject{"ball", "formula", "x^2 + y^2 + z^2 + 0.5*w^2 < 1"});
        session::ChangeSettings set;
        set.count = 1;
        session::must(value, set);
    }

    VirtualServer server;
    const std::shared_ptr<MeteredSession> metered =
        std::make_shared<MeteredSession>(server.account, session::Session{});
    session::Session& value = metered->value;
    const SessionPublisher::Strand strand = asio::make_strand(server.io);
    const std::shared_ptr<SessionPublisher> publisher =
        std::make_shared<SessionPublisher>(server.services, strand, "test", metered);
    int steps = 0;  // how many steps the motion has made
};

TEST_F(SessionPublisherTest, UnacknowledgedPicturesCountAsShownAfterATime) {
    const auto peer = connect(false);
    for (int i = 0; i < 5; ++i) change(kRotation);
    EXPECT_EQ(peer->pictures(), (Revisions{0, 1}));
    server.advance(1s - 1ns);
    EXPECT_EQ(peer->pictures(), (Revisions{0, 1}));
    server.advance(1ns);
    EXPECT_EQ(peer->pictures(), (Revisions{0, 1, 5})) << "the newest one, and not those between";
    change(kRotation);
    change(kRotation);
    EXPECT_EQ(peer->pictures(), (Revisions{0, 1, 5, 6}));
    server.advance(1s);
    EXPECT_EQ(peer->pictures(), (Revisions{0, 1, 5, 6, 7}));
}

TEST_F(SessionPublisherTest, AClientThatAcknowledgesWaitsForNobody) {
    const auto silent = connect(false), quick = connect(true);
    for (int i = 0; i < 5; ++i) change(kRotation);
    EXPECT_EQ(silent->pictures(), (Revisions{0, 1}));
    EXPECT_EQ(quick->pictures(), (Revisions{0, 1, 2, 3, 4, 5}));
}

TEST_F(SessionPublisherTest, TheObjectTurnsAsFarInASecondAsItsSpeedSays) {
    const auto peer = connect(true);
    change(kRotation);
    change(turning(true));
    EXPECT_EQ(steps, 1);
    server.advance(1s);
    EXPECT_EQ(steps, 61);
    EXPECT_EQ(value.revision, 63U);
    EXPECT_EQ(peer->pictures().size(), 64U) << "each step has a picture";
    EXPECT_EQ(peer->pictures().back(), 63U);
    const double turns = 1 + session::kRotationRepeatsPerSecond * 61 / 60;
    const glm::dmat4 expected = (geometry::Rotation(geometry::RotationAngles(geometry::Plane::xw, 0.1 * turns)) *
                                 session::Session{}.current.orientation)
                                    .matrix();
    const glm::dmat4 reached = value.current.orientation.matrix();
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) EXPECT_NEAR(reached[column][row], expected[column][row], 1e-6);
    }
    change(turning(false));
    server.advance(1s);
    EXPECT_EQ(steps, 61);
}

TEST_F(SessionPublisherTest, TheFocusPlaysAsFarInASecondAsItsSpeedSays) {
    const auto peer = connect(true);
    change(session::CommandLine{"play"});
    EXPECT_EQ(steps, 1);
    server.advance(1s);
    EXPECT_EQ(steps, 61);
    EXPECT_EQ(peer->pictures().back(), 62U) << "each step has a picture";
    const auto [least, most] = slicing::rangeOfW(value.current.object, value.current.orientation);
    EXPECT_NEAR(value.current.focusW(), (most - least) / session::kSecondsFromEndToEnd * 61 / 60, 1e-6);
    change(session::CommandLine{"pause"});
    server.advance(1s);
    EXPECT_EQ(steps, 61);
}

TEST_F(SessionPublisherTest, TheObjectWaitsForAcknowledgmentsAndDoesNotJump) {
    const auto peer = connect(false);
    change(kRotation);
    change(turning(true));
    server.advance(1s - 1ns);
    EXPECT_EQ(steps, 0);
    EXPECT_EQ(peer->pictures(), (Revisions{0, 1}));
    server.advance(1ns);
    EXPECT_EQ(steps, 1);
    EXPECT_EQ(peer->pictures(), (Revisions{0, 1, 2, 3}));
    server.advance(1s - 1ns);
    EXPECT_EQ(steps, 1);
    const glm::dmat4 before = value.current.orientation.matrix();
    server.advance(1ns);
    EXPECT_EQ(steps, 2);
    EXPECT_EQ(peer->pictures(), (Revisions{0, 1, 2, 3, 4}));
    const double most = 0.1 * session::kRotationRepeatsPerSecond / 4;  // the angle of the longest step
    const glm::dmat4 after = value.current.orientation.matrix();
    for (int column = 0; column < 4; ++column)
        EXPECT_LE(glm::distance(after[column], before[column]), 1.001 * most) << column;
}

TEST_F(SessionPublisherTest, ASingleChangeOfAFieldHasNoDraft) {
    showField();
    const auto peer = connect(true);
    for (int i = 0; i < 3; ++i) {
        change(kRotation);
        EXPECT_EQ(peer->drafts(value.revision), std::vector{false});
        server.advance(300ms);
    }
    EXPECT_EQ(peer->drafts(value.revision), std::vector{false});
}

TEST_F(SessionPublisherTest, QuickChangesOfAFieldHaveDraftsUntilItRests) {
    showField();
    const auto peer = connect(true);
    change(kRotation);
    EXPECT_EQ(peer->drafts(value.revision), std::vector{false});
    server.advance(299ms);
    change(kRotation);
    EXPECT_EQ(peer->drafts(value.revision), std::vector{true});
    server.advance(150ms);
    change(kRotation);
    server.advance(199ms);
    EXPECT_EQ(peer->drafts(value.revision), std::vector{true}) << "it has not rested since the last change";
    server.advance(1ms);
    EXPECT_EQ(peer->drafts(value.revision), (std::vector{true, false}));
    server.advance(1h);
    EXPECT_EQ(peer->drafts(value.revision), (std::vector{true, false}));
    EXPECT_EQ(peer->drafts(value.revision - 1), std::vector{true});
}

TEST_F(SessionPublisherTest, AFieldThatTurnsHasDraftsUntilItStops) {
    showField();
    const auto peer = connect(true);
    change(kRotation);
    server.advance(1h);
    change(turning(true));
    const std::uint64_t started = value.revision;
    server.advance(100ms);
    EXPECT_GE(value.revision, started + 5);
    for (std::uint64_t revision = started; revision <= value.revision; ++revision)
        EXPECT_EQ(peer->drafts(revision), std::vector{true}) << revision;
    change(turning(false));
    server.advance(199ms);
    EXPECT_EQ(peer->drafts(value.revision), std::vector{true});
    server.advance(1ms);
    EXPECT_EQ(peer->drafts(value.revision), (std::vector{true, false}));
}

TEST_F(SessionPublisherTest, QuickChangesOfAPolytopeHaveNoDrafts) {
    const auto peer = connect(true);
    for (int i = 0; i < 5; ++i) change(kRotation);
    server.advance(1h);
    EXPECT_EQ(peer->pictures(), (Revisions{0, 1, 2, 3, 4, 5}));
    for (std::uint64_t revision = 0; revision <= 5; ++revision)
        EXPECT_EQ(peer->drafts(revision), std::vector{false}) << revision;
}

TEST_F(SessionPublisherTest, TheSectionOfALargeObjectIsNamedOnceForAllLooks) {
    session::must(value, session::CommandLine{"set polytope=600-cell slices=1"});
    ASSERT_FALSE(pipeline::FocusSectionNamer::isFast(value.current.object));
    const auto peer = connect(true);
    // Applies a command. Returns the state if it is known without work by a worker, else null.
    const auto stateAfter = [this](const session::Command& command) {
        SessionSnapshotPtr state;
        post([&] {
            session::must(value, command);
            state = publisher->currentState();
        });
        server.runHandlers();
        return state;
    };
    for (const char* look : {"set background=white", "set opacity=0.5", "set labels=off"}) {
        const SessionSnapshotPtr state = stateAfter(session::CommandLine{look});
        ASSERT_TRUE(state) << look;
        EXPECT_EQ(state->revision, value.revision) << look;
        const scene::PictureRequest picture = session::pictureRequestOf(value.current);
        EXPECT_EQ(state->section.names, pipeline::FocusSectionNamer().name(picture).names) << look;
    }
    EXPECT_FALSE(stateAfter(session::CommandLine{"set focus=1"})) << "another section";
    EXPECT_FALSE(stateAfter(kRotation)) << "another section";
}

ServerOptions optionsWithOneWaitingJob() {
    ServerOptions options;
    options.jobs.total = 1;
    return options;
}

class FullPool : public SessionPublisherTest {
  protected:
    FullPool() : SessionPublisherTest(optionsWithOneWaitingJob()) {}
};

TEST_F(FullPool, APictureThatThePoolRejectsIsTriedAgain) {
    parallel::WorkerPool& workers = server.pictureWorkers.workers();
    std::promise<void> started, release;
    const std::shared_future<void> released = release.get_future().share();
    ASSERT_TRUE(workers.post(
        [&started, released](std::size_t) {
            started.set_value();
            released.wait();
        },
        nullptr, {}));
    started.get_future().wait();
    ASSERT_TRUE(workers.post([](std::size_t) {}, nullptr, {}));
    const auto peer = add(true);
    server.runHandlers();
    release.set_value();
    server.advance(100ms - 1ns);
    EXPECT_EQ(peer->pictures(), Revisions{});
    server.advance(1ns);
    EXPECT_EQ(peer->pictures(), Revisions{0});
}

}  // namespace
}  // namespace oval4d::net
