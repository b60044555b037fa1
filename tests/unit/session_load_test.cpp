#include <gtest/gtest.h>

#include "geometry/catalogue.hpp"
#include "geometry_support.hpp"
#include "session/workshop.hpp"
#include "session_support.hpp"

namespace oval4d::session {
namespace {

using geometry::support::kPentachoron;
using protocol::ErrorCode;
using protocol::Load;

TEST(Load, ShowsThePolytopeAndKeepsIt) {
    Session session;
    press(session, "rll");
    const State before = session.now;
    must(session, Load{"mine", "off", kPentachoron});
    EXPECT_EQ(session.now.polytope->name, "mine");
    EXPECT_EQ(session.now.orientation, before.orientation);
    EXPECT_EQ(session.now.slices.focus, 0);
    EXPECT_NEAR(session.now.slices.spacing, session.now.polytope->circumradius / 10, 1e-12);
    press(session, "u");
    EXPECT_EQ(session.now, before);
    line(session, "polytope mine");
    EXPECT_EQ(session.now.polytope->name, "mine");
    press(session, "n");
    EXPECT_EQ(session.now.polytope->name, geometry::catalogue().front().name);
    press(session, "N");
    EXPECT_EQ(session.now.polytope->name, "mine");
    expectRefused(session, protocol::CommandLine{"polytope mined"}, ErrorCode::unknown_polytope,
                  "did you mean 'mine'?");
}

TEST(Load, RefusesWhatItCannotRead) {
    Session session;
    press(session, "r");
    expectRefused(session, Load{"mine", "off", "4OFF\n5 10 10 5\nx"}, ErrorCode::bad_polytope,
                  "line 2: the counts promise more");
    expectRefused(session, Load{"mine", "stl", "solid"}, ErrorCode::unsupported_format,
                  "'stl' cannot be read; allowed are off");
    expectRefused(session, Load{"tesseract", "off", kPentachoron}, ErrorCode::bad_polytope, "a name of the catalogue");
    expectRefused(session, Load{"a\nb", "off", kPentachoron}, ErrorCode::bad_message, "printable");
    expectRefused(session, Load{"mine", "off", kPentachoron}, ErrorCode::too_large, "at most 4 are allowed",
                  Limits{.maxVertices = 4});
}

// Applies the command as a server does, and counts the orders it takes.
int ordersOf(Session& session, const protocol::Command& command, Workshop& workshop,
             protocol::Result<std::monostate>& done) {
    for (int orders = 0;; ++orders) {
        const Session before = session;
        done = apply(session, command, Limits{}, workshop);
        if (!workshop.ordered()) return orders;
        EXPECT_FALSE(done);
        EXPECT_EQ(session, before);
        workshop.work();
    }
}

TEST(Load, MayBeReadAhead) {
    Session session;
    protocol::Result<std::monostate> done = std::monostate{};
    const protocol::Command load = Load{"mine", "points", "0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n.1 .1 .1 .1\n"};
    Workshop reader(Limits{}, Workshop::Pace::later);
    EXPECT_EQ(ordersOf(session, load, reader, done), 1);
    EXPECT_TRUE(done);
    EXPECT_EQ(reader.warnings().size(), 1U);
    EXPECT_EQ(session.now.polytope->name, "mine");
    EXPECT_EQ(session.now.polytope->cellCount(), 5U);

    Workshop refuser(Limits{}, Workshop::Pace::later);
    EXPECT_EQ(ordersOf(session, Load{"other", "points", "1 2 3\n"}, refuser, done), 1);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::bad_polytope);
}

TEST(Load, PolytopesAreBuiltAheadOnlyWhereTheyAreNotBuiltYet) {
    Session session;
    protocol::Result<std::monostate> done = std::monostate{};
    const protocol::Command unusual = protocol::CommandLine{"polytope 17,19-duoprism"};
    Workshop first(Limits{}, Workshop::Pace::later);
    EXPECT_EQ(ordersOf(session, unusual, first, done), 1);
    EXPECT_TRUE(done);
    EXPECT_EQ(session.now.polytope->name, "17,19-duoprism");
    Session other;
    Workshop second(Limits{}, Workshop::Pace::later);
    EXPECT_EQ(ordersOf(other, unusual, second, done), 0);
    EXPECT_EQ(other.now.polytope, session.now.polytope);

    Workshop turner(Limits{}, Workshop::Pace::later);
    EXPECT_EQ(ordersOf(session, protocol::Key{"y", false, false}, turner, done), 0);
    Workshop walker(Limits{}, Workshop::Pace::later);
    EXPECT_LE(ordersOf(session, protocol::Key{"N", false, false}, walker, done), 1);
    EXPECT_TRUE(done);

    // Its elements coincide: told only by building it.
    Workshop builder(Limits{}, Workshop::Pace::later);
    EXPECT_EQ(ordersOf(session, protocol::CommandLine{"polytope x3o3o5/2x"}, builder, done), 1);
    EXPECT_FALSE(done);
}

TEST(Load, IsLimited) {
    Session session;
    const Limits limits{.maxLoaded = 2};
    must(session, Load{"a", "off", kPentachoron}, limits);
    must(session, Load{"b", "off", kPentachoron}, limits);
    expectRefused(session, Load{"c", "off", kPentachoron}, ErrorCode::too_many, "at most 2 loaded polytopes", limits);
    must(session, Load{"b", "off", kPentachoron}, limits);
}

}  // namespace
}  // namespace oval4d::session
