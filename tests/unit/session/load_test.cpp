#include <gtest/gtest.h>

#include "polytopes/catalogue/catalogue.hpp"
#include "session/load.hpp"
#include "session/object_loader.hpp"
#include "unit/session/support.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::session {
namespace {

using support::kPentachoron;

TEST(Load, ShowsThePolytopeAndKeepsIt) {
    Session session;
    press(session, "rll");
    const State before = session.current;
    must(session, Load{"mine", "off", kPentachoron});
    EXPECT_EQ(infoOf(session.current).name, "mine");
    EXPECT_EQ(session.current.orientation, before.orientation);
    EXPECT_EQ(session.current.slices.focus, 0);
    EXPECT_NEAR(session.current.slices.spacing, infoOf(session.current).circumradius / 10, 1e-12);
    press(session, "u");
    EXPECT_EQ(session.current, before);
    line(session, "polytope mine");
    EXPECT_EQ(infoOf(session.current).name, "mine");
    press(session, "n");
    EXPECT_EQ(infoOf(session.current).name, polytopes::catalogue().front().name);
    press(session, "N");
    EXPECT_EQ(infoOf(session.current).name, "mine");
    expectRefused(session, CommandLine{"polytope mined"}, ErrorCode::unknown_polytope, "did you mean 'mine'?");
}

TEST(Load, RefusesWhatItCannotRead) {
    Session session;
    press(session, "r");
    expectRefused(session, Load{"mine", "off", "4OFF\n5 10 10 5\nx"}, ErrorCode::bad_polytope,
                  "line 2: the file is too short");
    expectRefused(session, Load{"mine", "stl", "solid"}, ErrorCode::unsupported_format,
                  "'stl' cannot be read; allowed formats: off (4OFF), points, cloud");
    expectRefused(session, Load{"tesseract", "off", kPentachoron}, ErrorCode::bad_polytope, "a name of the catalogue");
    expectRefused(session, Load{"a\nb", "off", kPentachoron}, ErrorCode::bad_message, "printable");
    expectRefused(session, Load{"mine", "off", kPentachoron}, ErrorCode::too_large, "at most 4 are allowed",
                  Limits{.maxVertices = 4});
}

// Applies a command as a server does; returns how many times it must wait for an object that is loaded separately.
int ordersOf(Session& session, const Command& command, ObjectLoader& loader, Result<std::monostate>& done) {
    for (int orders = 0;; ++orders) {
        const Session before = session;
        done = apply(session, command, Limits{}, loader);
        if (!loader.isPending()) return orders;
        EXPECT_FALSE(done);
        EXPECT_EQ(session, before);
        loader.loadPendingObject();
    }
}

TEST(Load, TheFirstWordTellsTheFormat) {
    EXPECT_EQ(detectFormat(kPentachoron), "off");
    EXPECT_EQ(detectFormat("1 0 0 0\n"), "points");
    EXPECT_EQ(detectFormat(""), "points");
    for (const std::string keyword : {"CLOUD", "cloud", "# from a simulation\nCLOUD # of two points"}) {
        const std::string text = keyword + "\n1 0 0 0\n0 1 0 0 0.25\n";
        ASSERT_EQ(detectFormat(text), "cloud");
        const auto read = readObject("cloud", text, "two points", Limits{});
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_EQ(slicing::elementCounts(read->object)[0], 2U);
    }
    const auto wrong = readObject("points", "CLOUD\n1 0 0 0\n", "two points", Limits{});
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().code, ErrorCode::bad_polytope);
}

TEST(Load, MayBeReadAhead) {
    Session session;
    Result<std::monostate> done = std::monostate{};
    const Command load = Load{"mine", "points", "0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n.1 .1 .1 .1\n"};
    ObjectLoader reader(Limits{}, support::cache(), ObjectLoader::Mode::deferred, readObject);
    EXPECT_EQ(ordersOf(session, load, reader, done), 1);
    EXPECT_TRUE(done);
    EXPECT_EQ(reader.warnings().size(), 1U);
    EXPECT_EQ(infoOf(session.current).name, "mine");
    EXPECT_EQ(slicing::elementCounts(session.current.object)[3], 5U);

    ObjectLoader refuser(Limits{}, support::cache(), ObjectLoader::Mode::deferred, readObject);
    EXPECT_EQ(ordersOf(session, Load{"other", "points", "1 2 3\n"}, refuser, done), 1);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::bad_polytope);
}

TEST(Load, PolytopesAreBuiltAheadOnlyWhereTheyAreNotBuiltYet) {
    Session session;
    Result<std::monostate> done = std::monostate{};
    const Command unusual = CommandLine{"polytope 17,19-duoprism"};
    ObjectLoader first(Limits{}, support::cache(), ObjectLoader::Mode::deferred, readObject);
    EXPECT_EQ(ordersOf(session, unusual, first, done), 1);
    EXPECT_TRUE(done);
    EXPECT_EQ(infoOf(session.current).name, "17,19-duoprism");
    Session other;
    ObjectLoader second(Limits{}, support::cache(), ObjectLoader::Mode::deferred, readObject);
    EXPECT_EQ(ordersOf(other, unusual, second, done), 0);
    EXPECT_EQ(other.current.object, session.current.object);

    ObjectLoader turner(Limits{}, support::cache(), ObjectLoader::Mode::deferred, readObject);
    EXPECT_EQ(ordersOf(session, Key{"y", false, false}, turner, done), 0);
    ObjectLoader walker(Limits{}, support::cache(), ObjectLoader::Mode::deferred, readObject);
    EXPECT_LE(ordersOf(session, Key{"N", false, false}, walker, done), 1);
    EXPECT_TRUE(done);

    // Its elements coincide, which is found only when the polytope is built.
    ObjectLoader builder(Limits{}, support::cache(), ObjectLoader::Mode::deferred, readObject);
    EXPECT_EQ(ordersOf(session, CommandLine{"polytope x3o3o5/2x"}, builder, done), 1);
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

TEST(Load, ReadsByWhatItIsGivenAndOnlyWhatItMayRead) {
    std::string seen;
    const FileReader reader = [&](std::string_view format, std::string_view text, const std::string& name,
                                  const Limits& /*limits*/) -> Result<LoadedObject> {
        EXPECT_EQ(format, "points");
        seen = name + ": " + std::string(text);
        return Error{ErrorCode::too_large, "so"};
    };
    ObjectLoader loader(Limits{}, support::cache(), ObjectLoader::Mode::immediate, reader);
    Session session;
    const auto done = apply(session, Load{"mine", "points", "1 2 3"}, Limits{}, loader);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().message, "so");
    EXPECT_EQ(seen, "mine: 1 2 3");
    ObjectLoader other(Limits{}, support::cache(), ObjectLoader::Mode::immediate, reader);
    EXPECT_FALSE(apply(session, Load{"tesseract", "points", "4 5 6"}, Limits{}, other));
    EXPECT_EQ(seen, "mine: 1 2 3");
}

}  // namespace
}  // namespace oval4d::session
