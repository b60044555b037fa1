// How a session shows multiscale images that its clients load, in virtual time.

#include "net/live/live_session.hpp"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "hang_limit.hpp"
#include "net/live/session_manager.hpp"
#include "store/memory_store.hpp"
#include "unit/net/live/image_levels.hpp"
#include "unit/net/live/recording_peer.hpp"
#include "unit/net/virtual_server.hpp"
#include "unit/store/temporary_folder.hpp"

namespace oval4d::net {
namespace {

namespace asio = boost::asio;
using nlohmann::json;

ServerOptions optionsWithData(const store::Folder& folder) {
    std::filesystem::create_directory(folder.path / "image");
    std::ofstream(folder.path / "image" / "zarr.json") << "{}";
    ServerOptions options;
    options.data = folder.path.string();
    return options;
}

class LiveSessionTest : public testing::Test {
  protected:
    LiveSessionTest() {
        cache({}, levelOfImage(2, 2));
        cache(session::FinerImageLevel{1, 3}, levelOfImage(1, 1));
        cache(session::FinerImageLevel{0, 3}, levelOfImage(0, 0));
        manager->createSession(server.account, [this](SessionManager::JoinResult created) { live = *created; });
    }
    void TearDown() override { manager->stop(support::hangLimit()); }

    session::LoadObject load(const std::optional<session::FinerImageLevel>& finer = {}) const {
        session::LoadObject message{"run", "", {}};
        message.dataName = "image";
        message.finer = finer;
        return message;
    }
    /// Puts a level of the image into the cache of the data folder. No process then needs to read it.
    void cache(const std::optional<session::FinerImageLevel>& finer, const slicing::FieldPtr& level) {
        const DataFolder::Reader reader =
            [&](const session::LoadObject& /*file*/, const session::Limits& /*limits*/,
                const file_reading::FileAllocator& /*allocate*/) -> Result<session::ObjectWithWarnings> {
            return session::ObjectWithWarnings{level, {}};
        };
        EXPECT_TRUE(server.data.read(load(finer), {}, reader));
    }
    /// Applies a command, and waits until it is applied.
    void apply(const session::Command& command) {
        bool isDone = false;
        asio::co_spawn(server.io, live->apply(server.account, command),
                       [&](const std::exception_ptr& fault, std::optional<Result<LiveSession::CommandResult>> result) {
                           isDone = !fault && result && *result;
                       });
        EXPECT_TRUE(server.eventually([&] { return isDone; }));
    }
    std::shared_ptr<RecordingPeer> connect() {
        auto peer = std::make_shared<RecordingPeer>(server.account);
        asio::co_spawn(server.io, live->addAndWelcome(peer, wire::Hello{}, {}), asio::detached);
        server.settle();
        return peer;
    }
    /// Waits until the newest state that the client has received satisfies the condition. Returns false if this takes
    /// too long.
    [[nodiscard]] bool eventually(const RecordingPeer& peer, const std::function<bool(const json& state)>& holds) {
        return server.eventually([&] {
            const auto states = peer.messages("state");
            return !states.empty() && holds(states.back());
        });
    }
    static json resolution(const json& state) {
        return state.value("field", json::object()).value("resolution", json::object());
    }

    const store::Folder folder;
    VirtualServer server{optionsWithData(folder)};
    const std::shared_ptr<SessionManager> manager = std::make_shared<SessionManager>(
        server.services,
        std::make_unique<store::MemoryStore>(store::kDefaultQuota, [this] { return server.clock.now(); }));
    std::shared_ptr<LiveSession> live;
};

TEST_F(LiveSessionTest, FinerLevelsFollowACoarseOneWithoutUndoSteps) {
    const auto peer = connect();
    apply(load());
    EXPECT_TRUE(
        eventually(*peer, [](const json& state) { return resolution(state) == json{{"level", 0}, {"levels", 3}}; }));
    apply(session::Undo{});
    EXPECT_TRUE(eventually(*peer, [](const json& state) { return state.at("polytope").at("name") == "5-cell"; }));
    apply(session::Redo{});
    EXPECT_TRUE(eventually(*peer, [](const json& state) { return resolution(state).value("level", 9) == 0; }));
}

TEST_F(LiveSessionTest, FinerLevelsWaitForAClient) {
    apply(load());
    const auto peer = connect();
    EXPECT_TRUE(eventually(*peer, [](const json& state) { return resolution(state).value("level", 9) == 0; }));
    const json newest = peer->messages("state").back();
    EXPECT_EQ(newest.at("revision"), 3) << "the load, and two levels";
    EXPECT_FALSE(resolution(newest).contains("refining"));
}

}  // namespace
}  // namespace oval4d::net
