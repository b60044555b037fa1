// When a session reads finer levels of an image, and what happens to the levels.

#include "net/live/field_refinement.hpp"

#include <boost/asio/awaitable.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/strand.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "net/coroutine_helpers.hpp"
#include "session/settings.hpp"
#include "unit/net/live/image_levels.hpp"
#include "unit/net/virtual_server.hpp"
#include "unit/session/support.hpp"

namespace oval4d::net {
namespace {

namespace asio = boost::asio;

class FieldRefinementTest : public testing::Test {
  protected:
    using Answer = std::optional<Result<slicing::Object>>;
    // The reading of a level that is in progress. The test decides when to answer it.
    struct Reading {
        session::LoadObject load;
        std::stop_token stop;
        std::function<void(Answer)> whenRead;
    };

    FieldRefinementTest() {
        session::ObjectLoader loader({}, support::cache());
        EXPECT_TRUE(session::replaceObject(value.current, coarse, loader));
    }

    std::function<void(std::function<void(Answer)>)> beginReading(session::LoadObject load, std::stop_token stop) {
        return [this, load = std::move(load), stop = std::move(stop)](std::function<void(Answer)> whenRead) {
            readings.push_back({load, stop, std::move(whenRead)});
        };
    }
    asio::awaitable<Result<slicing::Object>> read(session::LoadObject load, std::stop_token stop) {
        auto result = co_await awaitCallback<Answer>(beginReading(std::move(load), std::move(stop)));
        co_return std::move(*result);
    }
    /// Calls FieldRefinement::update() on the strand.
    void update() {
        asio::post(strand, [this] { refinement->startOrStopAsNeeded(); });
        server.settle();
    }
    /// Answers the reading that began last.
    void answer(Result<slicing::Object> result) {
        const auto whenRead = std::exchange(readings.back().whenRead, {});
        whenRead(Answer(std::move(result)));
        server.settle();
    }
    void answer(slicing::FieldPtr level) { answer(Result<slicing::Object>(slicing::Object(std::move(level)))); }
    const fields::MultiscaleImageLevel& shownLevel() const {
        return slicing::fieldIn(value.current.source)->imageLevel;
    }

    VirtualServer server;
    const std::shared_ptr<MeteredSession> metered =
        std::make_shared<MeteredSession>(server.account, session::Session{});
    session::Session& value = metered->value;
    const slicing::Object coarse = levelOfImage(2, 2);
    bool hasClients = true;
    int refined = 0;
    const asio::strand<asio::io_context::executor_type> strand = asio::make_strand(server.io);
    const std::shared_ptr<FieldRefinement> refinement = std::make_shared<FieldRefinement>(
        strand, metered, [this] { return hasClients; },
        [this](session::LoadObject load, std::stop_token stop) { return read(std::move(load), std::move(stop)); },
        [this] { ++refined; });
    std::vector<Reading> readings;
};

TEST_F(FieldRefinementTest, LevelsFollowOneAfterAnother) {
    update();
    ASSERT_EQ(readings.size(), 1U);
    EXPECT_EQ(readings[0].load.dataName, "image");
    EXPECT_EQ(readings[0].load.finer, (session::FinerImageLevel{1, 3}));
    update();
    EXPECT_EQ(readings.size(), 1U) << "it is being read";
    EXPECT_EQ(value.current.source, coarse);
    const slicing::Object middle = levelOfImage(1, 1), finest = levelOfImage(0, 0);
    answer(middle);
    EXPECT_EQ(value.current.source, middle);
    ASSERT_EQ(readings.size(), 2U);
    EXPECT_EQ(readings[1].load.finer, (session::FinerImageLevel{0, 3}));
    session::press(value, "r");  // other changes do not matter
    update();
    EXPECT_FALSE(readings[1].stop.stop_requested());
    answer(finest);
    EXPECT_EQ(value.current.source, finest);
    update();
    EXPECT_EQ(readings.size(), 2U);
    EXPECT_EQ(refined, 2);
    EXPECT_EQ(value.revision, 3U);
    EXPECT_EQ(value.undoSteps.size(), 1U) << "only that of the rotation";
    EXPECT_EQ(value.undoSteps.back().source, finest);
}

TEST_F(FieldRefinementTest, AnotherObjectEndsIt) {
    update();
    session::line(value, "polytope 24-cell");
    update();
    EXPECT_TRUE(readings.at(0).stop.stop_requested());
    answer(levelOfImage(1, 1));
    EXPECT_EQ(slicing::infoOf(value.current.source).name, "24-cell");
    EXPECT_EQ(value.undoSteps.back().source, coarse);
    EXPECT_EQ(readings.size(), 1U);
    EXPECT_EQ(refined, 0);
    session::line(value, "undo");
    update();
    ASSERT_EQ(readings.size(), 2U) << "it begins again when the image is shown again";
    answer(levelOfImage(1, 1));
    EXPECT_EQ(shownLevel().level, 1U);
    ASSERT_EQ(readings.size(), 3U);
    answer(kInternalError);
}

TEST_F(FieldRefinementTest, AnImageThatIsShownAgainInTheMeantimeIsReadAgain) {
    update();
    session::line(value, "polytope 24-cell");
    update();
    session::line(value, "undo");
    update();
    EXPECT_EQ(readings.size(), 1U);
    answer(kInternalError);  // the canceled reading
    EXPECT_EQ(refined, 0);
    ASSERT_EQ(readings.size(), 2U);
    EXPECT_FALSE(readings[1].stop.stop_requested());
    answer(levelOfImage(1, 0));
    EXPECT_EQ(shownLevel().level, 1U);
    EXPECT_EQ(readings.size(), 2U) << "no finer level fits into memory";
}

TEST_F(FieldRefinementTest, NothingIsReadWithoutClients) {
    hasClients = false;
    update();
    EXPECT_TRUE(readings.empty());
    hasClients = true;
    update();
    ASSERT_EQ(readings.size(), 1U);
    hasClients = false;
    update();
    EXPECT_TRUE(readings[0].stop.stop_requested());
    answer(levelOfImage(1, 1));
    EXPECT_EQ(value.current.source, coarse);
    EXPECT_EQ(readings.size(), 1U);
    hasClients = true;
    update();
    ASSERT_EQ(readings.size(), 2U);
    answer(levelOfImage(1, 0));
    EXPECT_EQ(shownLevel().level, 1U);
}

TEST_F(FieldRefinementTest, AfterALevelThatCannotBeReadNoneFollows) {
    update();
    ASSERT_EQ(readings.size(), 1U);
    answer(Error{ErrorCode::too_many, "no room"});
    EXPECT_EQ(shownLevel(), (fields::MultiscaleImageLevel{2, 3, 0}));
    EXPECT_EQ(slicing::fieldIn(value.current.source)->array, slicing::fieldIn(coarse)->array);
    EXPECT_EQ(refined, 1) << "the state says so";
    update();
    EXPECT_EQ(readings.size(), 1U);
}

TEST_F(FieldRefinementTest, AnotherLevelThanTheNextIsNotShown) {
    update();
    ASSERT_EQ(readings.size(), 1U);
    answer(levelOfImage(2, 2));
    EXPECT_EQ(shownLevel(), (fields::MultiscaleImageLevel{2, 3, 0}));
    EXPECT_EQ(readings.size(), 1U);
}

}  // namespace
}  // namespace oval4d::net
