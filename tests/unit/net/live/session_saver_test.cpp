// When a session is saved, in virtual time.

#include "net/live/session_saver.hpp"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "store/session_codec.hpp"
#include "unit/net/virtual_timer_clock.hpp"
#include "unit/polytopes/support.hpp"
#include "unit/store/faulty_store.hpp"

namespace oval4d::net {
namespace {

using namespace std::chrono_literals;
using WriteTiming = store::Store::WriteTiming;

/// A session with its saver, and a store with this write policy.
struct SavedSession {
    explicit SavedSession(WriteTiming policy)
        : control(std::make_shared<store::StoreControl>(store::kDefaultQuota, policy)) {}

    std::shared_ptr<SessionSaver> makeSaver(store::FencingToken fence = store::kFirstFence) {
        return std::make_shared<SessionSaver>(writeBehind, id, fence, value, clock, io.get_executor());
    }
    /// Changes the session, and tells its saver.
    void change() {
        ++value->revision;
        saver->scheduleSave();
    }
    /// Lets this much virtual time pass.
    void advance(TimerClock::Clock::duration by) {
        clock.advanceTo(clock.now() + by);
        io.restart();
        io.poll();
    }
    /// Returns whether a save is scheduled.
    bool isScheduled() const { return clock.nextCall().has_value(); }
    /// Returns the revision in the store; an empty optional if the session is not stored.
    std::optional<std::uint64_t> stored() {
        std::string whole, head;
        {
            const std::lock_guard lock(control->mutex);
            for (const store::RecordUpdate& update : control->updates) {
                if (update.credentials.id != id) continue;
                if (!update.whole.empty()) whole = update.whole;
                head = update.head;
            }
        }
        if (whole.empty()) return std::nullopt;
        const auto noObject = [](const std::string&) { return std::nullopt; };
        return store::decodeSession(whole, head, noObject, support::cache()).revision;
    }
    /// Waits until the store has written all that was handed to it before.
    void waitForWrites() {
        const std::string other = writeBehind.createSession().id;
        std::promise<bool> done;
        writeBehind.save(other, store::kFirstFence, {}, store::WriteBehindStore::SaveScope::whole,
                         [&](bool written) { done.set_value(written); });
        EXPECT_TRUE(done.get_future().get());
    }
    /// Calls `write`, and returns what its callback gets: true if the session has been or will be written.
    static bool resultOf(const SessionSaver::WriteFunction& write) {
        std::promise<bool> done;
        write([&](bool written) { done.set_value(written); });
        return done.get_future().get();
    }

    const std::shared_ptr<store::StoreControl> control;
    store::WriteBehindStore writeBehind{
        std::make_unique<store::FaultyStore>(control),
        {1h, 100, store::kDefaultQuota},
        {[](const std::string&) {}, [](const std::string&) {}, [] {}, [](const char*, double, bool) {}},
        control->clock.now<store::WriteBehindStore::Clock>()};
    const std::string id = writeBehind.createSession().id;
    const std::shared_ptr<session::Session> value = std::make_shared<session::Session>();
    boost::asio::io_context io;
    VirtualTimerClock clock;
    std::shared_ptr<SessionSaver> saver = makeSaver();
};

TEST(SessionSaver, SavesAfterADelayThatFurtherChangesDoNotProlong) {
    SavedSession saved(WriteTiming::soon);
    saved.change();
    EXPECT_EQ(saved.writeBehind.unsaved(), 1U) << "the store knows of the change at once";
    saved.advance(SessionSaver::kDelay - 1ms);
    EXPECT_TRUE(saved.isScheduled());
    saved.waitForWrites();
    EXPECT_FALSE(saved.stored());
    saved.change();
    saved.advance(1ms);
    EXPECT_FALSE(saved.isScheduled());
    saved.waitForWrites();
    EXPECT_EQ(saved.stored(), 2U);
    EXPECT_EQ(saved.writeBehind.unsaved(), 0U);
}

TEST(SessionSaver, SavesEveryLaterChangeToo) {
    SavedSession saved(WriteTiming::soon);
    for (std::uint64_t revision = 1; revision < 4; ++revision) {
        saved.change();
        saved.advance(SessionSaver::kDelay);
        saved.waitForWrites();
        EXPECT_EQ(saved.stored(), revision);
    }
    saved.advance(1h);
    saved.waitForWrites();
    EXPECT_EQ(saved.control->saves.load(), 3 + 4) << "nothing is saved without a change";
}

TEST(SessionSaver, LeavesChangesToTheEndIfTheStoreWantsThemOnlyThen) {
    SavedSession saved(WriteTiming::at_close);
    saved.change();
    EXPECT_FALSE(saved.isScheduled());
    EXPECT_EQ(saved.writeBehind.unsaved(), 0U);
    EXPECT_FALSE(saved.saver->writeFunctionBeforeAcknowledgment(true));
    EXPECT_FALSE(SavedSession(WriteTiming::soon).saver->writeFunctionBeforeAcknowledgment(true));
}

TEST(SessionSaver, WritesTheSessionAsItWasBeforeAChangeIsAcknowledged) {
    SavedSession saved(WriteTiming::at_once);
    saved.value->revision = 1;
    const auto whole = saved.saver->writeFunctionBeforeAcknowledgment(true);
    ASSERT_TRUE(whole);
    saved.value->revision = 2;
    const auto head = saved.saver->writeFunctionBeforeAcknowledgment(false);
    ASSERT_TRUE(head);
    saved.value->revision = 3;
    EXPECT_TRUE(SavedSession::resultOf(*whole));
    EXPECT_EQ(saved.stored(), 1U);
    EXPECT_TRUE(SavedSession::resultOf(*head));
    EXPECT_EQ(saved.stored(), 2U);
    const std::lock_guard lock(saved.control->mutex);
    EXPECT_TRUE(saved.control->updates.back().whole.empty()) << "only the state is written again";
}

TEST(SessionSaver, SaysIfAnotherServerHasTakenTheSessionOver) {
    SavedSession saved(WriteTiming::at_once);
    const auto write = saved.makeSaver(store::kFirstFence + 1)->writeFunctionBeforeAcknowledgment(true);
    ASSERT_TRUE(write);
    EXPECT_FALSE(SavedSession::resultOf(*write));
}

TEST(SessionSaver, NeverWritesADetachedSession) {
    SavedSession saved(WriteTiming::at_once);
    saved.change();
    const auto write = saved.saver->writeFunctionBeforeAcknowledgment(true);
    ASSERT_TRUE(write);
    EXPECT_FALSE(saved.saver->hasStoppedSaving());
    saved.saver->stopSaving();
    EXPECT_TRUE(saved.saver->hasStoppedSaving());
    saved.advance(SessionSaver::kDelay);
    EXPECT_FALSE(SavedSession::resultOf(*write));
    const auto held = std::make_shared<int>();
    bool called = false;
    saved.saver->saveNow([held, &called](bool) { called = true; });
    EXPECT_EQ(held.use_count(), 1) << "who waits for the save learns that there is none";
    EXPECT_FALSE(called);
    saved.waitForWrites();
    EXPECT_FALSE(saved.stored());
}

TEST(SessionSaver, MayBeDestroyedWhileASaveIsScheduled) {
    SavedSession saved(WriteTiming::soon);
    saved.change();
    saved.saver.reset();
    saved.advance(SessionSaver::kDelay);
    saved.waitForWrites();
    EXPECT_FALSE(saved.stored());
}

}  // namespace
}  // namespace oval4d::net
