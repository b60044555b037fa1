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
        keeper_.fetch(ticket, [&](Keeper::Fetch fetch) { said.set_value(std::move(fetch)); });
        return said.get_future().get();
    }
    bool save(const std::string& id, const Session& session, Keeper::Part part = Keeper::Part::whole) {
        std::promise<bool> said;
        keeper_.save(id, session, part, [&](bool ours) { said.set_value(ours); });
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
        const std::lock_guard lock(reins_->mutex);
        const auto record = reins_->kept.claim(id);
        return record ? decode(record->whole, record->head, [](const std::string&) { return nullptr; }).revision : 0;
    }

    std::shared_ptr<Reins> reins_ = std::make_shared<Reins>();
    std::atomic<int> taken_ = 0, wanted_ = 0, back_ = 0;
    Keeper keeper_{std::make_unique<ReinedStore>(reins_),
                   {10s, 100},
                   {[this](const std::string&) { ++taken_; }, [this](const std::string&) { ++wanted_; },
                    [this] { ++back_; }, [](const char*, double, bool) {}}};
};

TEST_F(KeeperTest, WhatIsWrittenIsInTheStore) {
    const Ticket ticket = keeper_.create();
    EXPECT_EQ(keeper_.count(), 1U);
    EXPECT_TRUE(save(ticket.id, at(5)));
    EXPECT_EQ(keeper_.unsaved(), 0U);
    EXPECT_EQ(kept(ticket.id), 5U);
}

TEST_F(KeeperTest, AdmitsByTokenOnly) {
    const Ticket ticket = keeper_.create();
    keeper_.close(ticket.id, at(3));
    eventually([&] { return keeper_.unsaved() == 0; });
    EXPECT_EQ(fetch({ticket.id, "wrong"}).error().code, ErrorCode::bad_token);
    EXPECT_EQ(fetch({"nobody", ticket.token}).error().code, ErrorCode::not_found);
    const auto fetched = fetch(ticket);
    ASSERT_TRUE(fetched);
    EXPECT_FALSE(fetched->record.whole.empty());
}

TEST_F(KeeperTest, AFailingStoreKeepsNobodyWaiting) {
    const Ticket ticket = keeper_.create();
    reins_->fails = true;
    EXPECT_TRUE(save(ticket.id, at(1)));
    eventually([&] { return !keeper_.trouble().empty(); });
    EXPECT_TRUE(save(ticket.id, at(2)));
    EXPECT_EQ(fetch({"other", "x"}).error().code, ErrorCode::internal) << "not that there is none";
    const Ticket closed = keeper_.create();
    keeper_.close(closed.id, at(9));
    EXPECT_EQ(fetch({closed.id, "wrong"}).error().code, ErrorCode::bad_token);
    const auto again = fetch(closed);
    ASSERT_TRUE(again && again->session) << "it had not left";
    EXPECT_EQ(again->session->revision, 9U);
    EXPECT_EQ(keeper_.unsaved(), 2U);
    reins_->fails = false;
    eventually([&] { return keeper_.unsaved() == 0; });
    EXPECT_EQ(keeper_.trouble(), "");
    EXPECT_EQ(back_, 1);
    EXPECT_EQ(kept(ticket.id), 2U);
    EXPECT_EQ(kept(closed.id), 9U);
}

TEST_F(KeeperTest, WritesNothingOfASessionThatAnotherHas) {
    const Ticket ticket = keeper_.create();
    EXPECT_TRUE(save(ticket.id, at(1)));
    {
        const std::lock_guard lock(reins_->mutex);
        reins_->kept.claim(ticket.id);
    }
    EXPECT_FALSE(save(ticket.id, at(2)));
    EXPECT_EQ(taken_, 1);
    EXPECT_FALSE(save(ticket.id, at(3))) << "nor later";
    EXPECT_EQ(kept(ticket.id), 1U);
}

TEST_F(KeeperTest, AsksForWhatTheStoreLacks) {
    const Ticket ticket = keeper_.create();
    keeper_.save(ticket.id, at(1), Keeper::Part::head);
    eventually([&] { return wanted_ == 1; });
    EXPECT_TRUE(save(ticket.id, at(2)));
    EXPECT_EQ(kept(ticket.id), 2U);
}

TEST_F(KeeperTest, OfManyChangesTheNewestIsWritten) {
    const Ticket ticket = keeper_.create();
    EXPECT_TRUE(save(ticket.id, at(1)));
    for (std::uint64_t i = 2; i < 5000; ++i) keeper_.save(ticket.id, at(i), Keeper::Part::head);
    EXPECT_TRUE(save(ticket.id, at(5000), Keeper::Part::head));
    EXPECT_EQ(kept(ticket.id), 5000U);
    EXPECT_LT(reins_->saves, 5000);
}

TEST_F(KeeperTest, APolytopeTravelsOnce) {
    const Ticket ticket = keeper_.create();
    Session session;
    ASSERT_TRUE(session::apply(session, ownPolytope("own", 1), session::Limits{}));
    const auto polytopes = [&] {
        const std::lock_guard lock(reins_->mutex);
        return reins_->kept.claim(ticket.id)->polytopes;
    };
    keeper_.save(ticket.id, Session{}, Keeper::Part::whole);
    keeper_.save(ticket.id, session, Keeper::Part::head);
    EXPECT_TRUE(save(ticket.id, session));
    const auto first = keeper_.unsaved() == 0 ? polytopes() : decltype(polytopes()){};
    ASSERT_EQ(first.size(), 1U);
    EXPECT_EQ(first[0].second, encodePolytope(*session.loaded.at("own")));
}

TEST_F(KeeperTest, StopsWhenAllIsWritten) {
    std::vector<Ticket> tickets;
    for (std::uint64_t i = 1; i <= 600; ++i) {
        tickets.push_back(keeper_.create());
        keeper_.close(tickets.back().id, at(i));
    }
    keeper_.stop(20s);
    for (std::uint64_t i = 1; i <= 600; ++i) EXPECT_EQ(kept(tickets[i - 1].id), i);
}

}  // namespace
}  // namespace oval4d::store
