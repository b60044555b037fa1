#include <map>

#include "store_support.hpp"

namespace oval4d::store {
namespace {

using session::Session;

/// Keeps polytopes as bytes, as a store does.
class Shelf {
  public:
    KeyOf keyOf = [this](const session::PolytopePtr& polytope) {
        const auto [found, isNew] = keys_.try_emplace(polytope->serial, "key" + std::to_string(keys_.size()));
        if (isNew) bytes_[found->second] = encodePolytope(*polytope);
        return found->second;
    };
    PolytopeOf polytopeOf = [this](const std::string& key) {
        auto& polytope = built_[key];
        if (!polytope && bytes_.contains(key)) polytope = decodePolytope(bytes_[key]);
        return polytope;
    };
    std::size_t size() const { return bytes_.size(); }

  private:
    std::map<std::uint64_t, std::string> keys_;
    std::map<std::string, std::string> bytes_;
    std::map<std::string, session::PolytopePtr> built_;
};

TEST(Codec, ReadsWhatItWrote) {
    std::mt19937 random(4);
    std::size_t own = 0;
    for (int round = 0; round < 60; ++round) {
        Session session;
        wander(session, random, round);
        Shelf shelf;
        const Session back = decode(encodeWhole(session, 1000, shelf.keyOf), "", shelf.polytopeOf);
        EXPECT_TRUE(same(session, back)) << "round " << round;
        own += shelf.size();
    }
    EXPECT_GT(own, 10U) << "polytopes of the users' own were among them";
}

TEST(Codec, GoesOnFromAHead) {
    std::mt19937 random(5);
    for (int round = 0; round < 40; ++round) {
        Session session;
        Shelf shelf;
        wander(session, random, 20);
        const std::string whole = encodeWhole(session, 1000, shelf.keyOf);
        const Session before = session;
        wander(session, random, round % 5);
        const Session back = decode(whole, encodeHead(session, shelf.keyOf), shelf.polytopeOf);
        EXPECT_EQ(back.revision, session.revision);
        if (session.revision == before.revision) {
            EXPECT_TRUE(same(before, back));
            continue;
        }
        Session bare, expected;
        bare.now = back.now;
        expected.now = session.now;
        EXPECT_TRUE(same(expected, bare));
        ASSERT_EQ(back.past.size(), before.past.size() + 1) << "one step back leads to the last whole state";
        bare.now = back.past.back();
        expected.now = before.now;
        EXPECT_TRUE(same(expected, bare));
    }
}

TEST(Codec, KeepsTheLastStepsOnly) {
    std::mt19937 random(6);
    Session session;
    wander(session, random, 200);
    Shelf shelf;
    const Session back = decode(encodeWhole(session, 7, shelf.keyOf), "", shelf.polytopeOf);
    ASSERT_EQ(back.past.size(), 7U);
    session.past.erase(session.past.begin(), session.past.end() - 7);
    EXPECT_TRUE(same(session, back));
}

TEST(Codec, KnowsOtherVersionsAndOtherBytes) {
    const PolytopeOf none = [](const std::string&) { return nullptr; };
    Shelf shelf;
    std::string bytes = encodeWhole(Session{}, 10, shelf.keyOf);
    ASSERT_EQ(bytes[1], 1) << "the version";
    bytes[1] = 2;
    try {
        decode(bytes, "", none);
        FAIL() << "a later version was read";
    } catch (const Unreadable& fault) {
        EXPECT_NE(std::string(fault.what()).find("version 2"), std::string::npos) << fault.what();
    }
    for (const std::string other : {"", "x", "\x80", "\xa0", "\x81\x01", "{\"a\":1}"}) {
        EXPECT_THROW(decode(other, "", none), Unreadable) << other;
        EXPECT_THROW(decodePolytope(other), Unreadable) << other;
    }
}

/// Whatever became of the bytes: a session that can be cut and drawn, or Unreadable.
TEST(Codec, SurvivesDamage) {
    std::mt19937 random(7);
    Session session;
    wander(session, random, 30);
    ASSERT_TRUE(session::apply(session, ownPolytope("own", 1), session::Limits{}));
    Shelf shelf;
    const std::string whole = encodeWhole(session, 100, shelf.keyOf);
    const std::string polytope = encodePolytope(*session.loaded.at("own"));
    int unreadable = 0;
    for (int round = 0; round < 3000; ++round) {
        std::string damaged = round % 2 == 0 ? whole : polytope;
        for (unsigned i = 0; i < 1 + random() % 3; ++i)
            damaged[random() % damaged.size()] = static_cast<char>(random());
        if (random() % 4 == 0) damaged.resize(random() % damaged.size());
        try {
            if (round % 2 == 1) {
                decodePolytope(damaged);
            } else {
                const Session read = decode(damaged, "", shelf.polytopeOf);
                EXPECT_GT(read.now.hyperplanes().count, 0);
                for (const std::uint32_t kind : read.now.look.kinds.hidden)
                    EXPECT_LT(kind, read.now.polytope->kinds.size());
            }
        } catch (const Unreadable&) {
            ++unreadable;
        }
    }
    EXPECT_GT(unreadable, 1000);
}

}  // namespace
}  // namespace oval4d::store
