#include <future>
#include <thread>

#include "store/keeper.hpp"
#include "store/memory_store.hpp"
#include "store_support.hpp"

namespace oval4d::store {
namespace {

using namespace std::chrono_literals;
using protocol::ErrorCode;
using session::Session;

/// What a test does to a store, and sees of it.
struct Reins {
    std::atomic<bool> fails = false;
    std::atomic<int> saves = 0;
    std::mutex mutex;
    MemoryStore kept;  // guarded by mutex
};

/// A store that other servers use too, and that can be made to fail.
class ReinedStore final : public Store {
  public:
    explicit ReinedStore(std::shared_ptr<Reins> reins) : reins_(std::move(reins)) {}
    Pace pace() const override { return Pace::at_once; }
    std::string name() const override { return "reined"; }
    std::optional<std::string> token(const std::string& id) override { return checked().token(id); }
    std::optional<Record> claim(const std::string& id) override { return checked().claim(id); }
    std::vector<Saved> save(std::span<const Saving> savings) override {
        MemoryStore& kept = checked();
        const std::lock_guard lock(reins_->mutex);
        reins_->saves += static_cast<int>(savings.size());
        return kept.save(savings);
    }
    void touch(std::span<const std::string> ids) override { checked().touch(ids); }
    std::size_t expire(Milliseconds age) override { return checked().expire(age); }
    std::vector<std::string> pulse() override { return checked().pulse(); }
    std::size_t size() const override { return reins_->kept.size(); }

  private:
    MemoryStore& checked() {
        if (reins_->fails) throw Outage("it is made to fail");
        return reins_->kept;
    }
    const std::shared_ptr<Reins> reins_;
};

class KeeperTest : public testing::Test {
  protected:
    Keeper::Fetch fetch(const Ticket& ticket) {
        std::promise<Keeper::Fetch> said;
        keeper.fetch(ticket, [&](Keeper::Fetch fetch) { said.set_value(std::move(fetch)); });
        return said.get_future().get();
    }
    bool save(const std::string& id, const Session& session, Keeper::Part part = Keeper::Part::whole) {
        std::promise<bool> said;
        keeper.save(id, session, part, [&](bool ours) { said.set_value(ours); });
        return said.get_future().get();
    }
    static void eventually(const std::function<bool()>& happened) {
        for (int i = 0; i < 3000 && !happened(); ++i) std::this_thread::sleep_for(10ms);
        EXPECT_TRUE(happened());
    }
    Session at(std::uint64_t revision) const {
        Session session;
        session.revision = revision;
        return session;
    }
    std::uint64_t kept(const std::string& id) {
        const std::lock_guard lock(reins->mutex);
        const auto record = reins->kept.claim(id);
        return record ? decode(record->whole, record->head, [](const std::string&) { return nullptr; }).revision : 0;
    }

    std::shared_ptr<Reins> reins = std::make_shared<Reins>();
    std::atomic<int> taken = 0, wanted = 0, back = 0;
    Keeper keeper{std::make_unique<ReinedStore>(reins),
                  {10s, 100},
                  {[this](const std::string&) { ++taken; }, [this](const std::string&) { ++wanted; },
                   [this] { ++back; }, [](const char*, double, bool) {}}};
};

TEST_F(KeeperTest, WhatIsWrittenIsInTheStore) {
    const Ticket ticket = keeper.create();
    EXPECT_EQ(keeper.count(), 1U);
    EXPECT_TRUE(save(ticket.id, at(5)));
    EXPECT_EQ(keeper.unsaved(), 0U);
    EXPECT_EQ(kept(ticket.id), 5U);
}

TEST_F(KeeperTest, AdmitsByTokenOnly) {
    const Ticket ticket = keeper.create();
    keeper.close(ticket.id, at(3));
    eventually([&] { return keeper.unsaved() == 0; });
    EXPECT_EQ(fetch({ticket.id, "wrong"}).error().code, ErrorCode::bad_token);
    EXPECT_EQ(fetch({"nobody", ticket.token}).error().code, ErrorCode::not_found);
    const auto fetched = fetch(ticket);
    ASSERT_TRUE(fetched);
    EXPECT_FALSE(fetched->record.whole.empty());
}

TEST_F(KeeperTest, AFailingStoreKeepsNobodyWaiting) {
    const Ticket ticket = keeper.create();
    reins->fails = true;
    EXPECT_TRUE(save(ticket.id, at(1)));
    eventually([&] { return !keeper.trouble().empty(); });
    EXPECT_TRUE(save(ticket.id, at(2)));
    EXPECT_EQ(fetch({"other", "x"}).error().code, ErrorCode::internal) << "not that there is none";
    const Ticket closed = keeper.create();
    keeper.close(closed.id, at(9));
    EXPECT_EQ(fetch({closed.id, "wrong"}).error().code, ErrorCode::bad_token);
    const auto again = fetch(closed);
    ASSERT_TRUE(again && again->session) << "it had not left";
    EXPECT_EQ(again->session->revision, 9U);
    EXPECT_EQ(keeper.unsaved(), 2U);
    reins->fails = false;
    eventually([&] { return keeper.unsaved() == 0; });
    EXPECT_EQ(keeper.trouble(), "");
    EXPECT_EQ(back, 1);
    EXPECT_EQ(kept(ticket.id), 2U);
    EXPECT_EQ(kept(closed.id), 9U);
}

TEST_F(KeeperTest, WritesNothingOfASessionThatAnotherHas) {
    const Ticket ticket = keeper.create();
    EXPECT_TRUE(save(ticket.id, at(1)));
    {
        const std::lock_guard lock(reins->mutex);
        reins->kept.claim(ticket.id);
    }
    EXPECT_FALSE(save(ticket.id, at(2)));
    EXPECT_EQ(taken, 1);
    EXPECT_FALSE(save(ticket.id, at(3))) << "nor later";
    EXPECT_EQ(kept(ticket.id), 1U);
}

TEST_F(KeeperTest, AsksForWhatTheStoreLacks) {
    const Ticket ticket = keeper.create();
    keeper.save(ticket.id, at(1), Keeper::Part::head);
    eventually([&] { return wanted == 1; });
    EXPECT_TRUE(save(ticket.id, at(2)));
    EXPECT_EQ(kept(ticket.id), 2U);
}

TEST_F(KeeperTest, OfManyChangesTheNewestIsWritten) {
    const Ticket ticket = keeper.create();
    EXPECT_TRUE(save(ticket.id, at(1)));
    for (std::uint64_t i = 2; i < 5000; ++i) keeper.save(ticket.id, at(i), Keeper::Part::head);
    EXPECT_TRUE(save(ticket.id, at(5000), Keeper::Part::head));
    EXPECT_EQ(kept(ticket.id), 5000U);
    EXPECT_LT(reins->saves, 5000);
}

TEST_F(KeeperTest, APolytopeTravelsOnce) {
    const Ticket ticket = keeper.create();
    Session session;
    ASSERT_TRUE(session::apply(session, ownPolytope("own", 1), session::Limits{}));
    const auto polytopes = [&] {
        const std::lock_guard lock(reins->mutex);
        return reins->kept.claim(ticket.id)->polytopes;
    };
    keeper.save(ticket.id, Session{}, Keeper::Part::whole);
    keeper.save(ticket.id, session, Keeper::Part::head);
    EXPECT_TRUE(save(ticket.id, session));
    const auto first = keeper.unsaved() == 0 ? polytopes() : decltype(polytopes()){};
    ASSERT_EQ(first.size(), 1U);
    EXPECT_EQ(first[0].second, encodePolytope(*session.loaded.at("own")));
}

TEST_F(KeeperTest, StopsWhenAllIsWritten) {
    std::vector<Ticket> tickets;
    for (std::uint64_t i = 1; i <= 600; ++i) {
        tickets.push_back(keeper.create());
        keeper.close(tickets.back().id, at(i));
    }
    keeper.stop(20s);
    for (std::uint64_t i = 1; i <= 600; ++i) EXPECT_EQ(kept(tickets[i - 1].id), i);
}

}  // namespace
}  // namespace oval4d::store
