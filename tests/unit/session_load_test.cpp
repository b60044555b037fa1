#include <cmath>
#include <random>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "geometry/catalogue.hpp"
#include "geometry/import.hpp"
#include "session_support.hpp"

namespace oval4d::session {
namespace {

using geometry::ImportError;
using geometry::importOff4;
using geometry::Polytope;
using protocol::ErrorCode;
using protocol::Load;

// A polytope as a 4OFF file would have it.
std::string asOff4(const Polytope& p, const std::string& end = "\n", int digits = 17) {
    std::ostringstream out;
    out.precision(digits);
    out << "4OFF" << end << p.vertices.size() << ' ' << p.faces.size() << " 0 " << p.cells.size() << end;
    for (const auto& v : p.vertices) out << v.x << ' ' << v.y << ' ' << v.z << ' ' << v.w << end;
    for (const auto* lists : {&p.faces, &p.cells}) {
        for (std::size_t i = 0; i < lists->size(); ++i) {
            out << (*lists)[i].size();
            for (const auto item : (*lists)[i]) out << ' ' << item;
            out << end;
        }
    }
    return out.str();
}

std::shared_ptr<const Polytope> named(std::string_view name) {
    return geometry::polytopeOf(*geometry::findEntry(name));
}

const Polytope& sound(const std::variant<Polytope, ImportError>& result) {
    if (const auto* error = std::get_if<ImportError>(&result)) {
        throw std::runtime_error("line " + std::to_string(error->line) + ": " + error->reason);
    }
    return std::get<Polytope>(result);
}

constexpr const char* kPentachoron = R"(#before the header
4OFF# the edges below are wrong on purpose
5 10 7 5
+1 1 1 -.4472136 # glued comments, signs, few digits
1e0 -1 -1 -.4472136 255 0 0
-1 1 -1 -.4472136

-1	-1 1 -.4472136   
0 0 0 1.7888544
3 0 1 2 0.5 0.5 0.5
3 0 1 3 12 200 7 255
3 0 1 4#
3 0 2 3
3 0 2 4
3 0 3 4
3 1 2 3
3 1 2 4
3 1 3 4
3 2 3 4
4 0 1 3 6 255 0 0
4 0 2 4 7
4 1 2 5 8
4 3 4 5 9
4 6 7 8 9
# the end)";

TEST(Import, ReadsFilesAsTheyAre) {
    const Polytope p = sound(importOff4(kPentachoron, "pen", 100));
    EXPECT_EQ(p.name, "pen");
    EXPECT_EQ(p.vertices.size(), 5U);
    EXPECT_EQ(p.edges.size(), 10U);
    EXPECT_EQ(p.faces.size(), 10U);
    EXPECT_EQ(p.cells.size(), 5U);
    EXPECT_EQ(p.vertices[0], glm::dvec4(1, 1, 1, -.4472136));
    EXPECT_NEAR(p.circumradius, 4 / std::sqrt(5.0), 1e-6);
}

TEST(Import, ReadsTheWholeCatalogueBack) {
    for (const auto& entry : geometry::catalogue().first(6)) {
        const Polytope& original = *geometry::polytopeOf(entry);
        for (const char* end : {"\n", "\r\n", " \t\r\n"}) {
            const Polytope p = sound(importOff4(asOff4(original, end), "p", 1000));
            EXPECT_EQ(p.vertices, original.vertices);
            EXPECT_EQ(p.edges.size(), original.edges.size());
            EXPECT_EQ(p.faces, original.faces);
            EXPECT_EQ(p.cells, original.cells);
        }
        sound(importOff4(asOff4(original, "\n", 4), "p", 1000));  // three decimals
    }
}

TEST(Import, DropsVerticesThatNoFaceUses) {
    std::string text = asOff4(*named("5-cell"));
    text.replace(text.find("5 10"), 1, "7");
    const std::size_t at = text.find('\n', text.find("7 10")) + 1;
    text.insert(at, "9 9 9 9\n9 9 9 9\n");
    for (std::size_t i = text.find("\n3 ") + 1; i < text.size(); i = text.find('\n', i) + 1) {
        if (text[i] != '3') break;
        for (const std::size_t k : {i + 2, i + 4, i + 6}) text[k] = static_cast<char>(text[k] + 2);
    }
    const Polytope p = sound(importOff4(text, "p", 100));
    EXPECT_EQ(p.vertices, named("5-cell")->vertices);
    EXPECT_EQ(p.faces, named("5-cell")->faces);
}

struct Unsound {
    std::string find, replace, says;
    std::size_t line;
};
class UnsoundFiles : public testing::TestWithParam<Unsound> {};

TEST_P(UnsoundFiles, AreRefusedWithTheLine) {
    const Unsound& c = GetParam();
    std::string text = kPentachoron;
    ASSERT_NE(text.find(c.find), std::string::npos);
    text.replace(text.find(c.find), c.find.size(), c.replace);
    const auto result = importOff4(text, "p", 100);
    const auto* error = std::get_if<ImportError>(&result);
    ASSERT_TRUE(error);
    EXPECT_NE(error->reason.find(c.says), std::string::npos) << error->reason;
    EXPECT_EQ(error->line, c.line) << error->reason;
}

INSTANTIATE_TEST_SUITE_P(
    All, UnsoundFiles,
    testing::Values(Unsound{"4OFF#", "OFF #", "must begin with 4OFF, not 'OFF'", 2},
                    Unsound{"5 10 7 5", "5 10 7", "three counts: this is Geomview's", 3},
                    Unsound{"5 10 7 5", "5 10 -7 5", "'-7' is not a number of edges", 3},
                    Unsound{"5 10 7 5", "5 10 7 x", "'x' is not a number of cells", 3},
                    Unsound{"5 10 7 5", "5 4000000000 7 5", "promise more than the file holds", 3},
                    Unsound{"5 10 7 5", "500 10 7 5", "500 vertices are too many", 3},
                    Unsound{"5 10 7 5", "5 10 7 4", "stands after the last cell", 24},
                    Unsound{"1e0", "one", "'one' is not a coordinate", 5},
                    Unsound{"1e0", "nan", "'nan' is not a coordinate", 5},
                    Unsound{"1e0", "inf", "'inf' is not a coordinate", 5},
                    Unsound{"1e0", "1e999", "'1e999' is not a coordinate", 5},
                    Unsound{"1e0", "1e10", "'1e10' is not a coordinate", 5},
                    Unsound{"3 0 1 2 ", "3 0 1 5 ", "the last is 4", 10},
                    Unsound{"3 0 1 2 ", "3 0 1 1 ", "names one of its vertices twice", 10},
                    Unsound{"3 0 1 2 ", "2 0 1 2 ", "has 2 vertices; allowed are 3 to 5", 10},
                    Unsound{"3 0 1 2 ", "3 0 -1 2 ", "'-1' is not a number of vertices", 10},
                    Unsound{"4 0 1 3 6 ", "4 0 1 3 10 ", "the last is 9", 20},
                    Unsound{"4 0 1 3 6 ", "3 0 1 3 6 ", "has 3 2-faces; allowed are 4 to 10", 20},
                    Unsound{"4 6 7 8 9\n", "", "the file ends before cell 4", 24},
                    Unsound{"4 6 7 8 9\n", "4 6 7 8", "the file ends where a number of 2-faces is expected", 24},
                    Unsound{"4 6 7 8 9", "4 3 4 5 9", "lies in more than two cells", 0},
                    Unsound{"0 0 0 1.7888544", "0 0 0 -.4472136", "all vertices lie in one hyperplane", 0},
                    Unsound{"4 6 7 8 9", "4 6 7 8 5", "cell 4 does not lie in a hyperplane", 0}));

TEST(Import, CellsMustLieInAHyperplaneAndFacesInAPlane) {
    std::string text = asOff4(*named("8-cell"));
    const std::size_t at = text.find('\n', text.find("16 24")) + 1;
    text.replace(at, text.find('\n', at) - at, "-1 -1 -1 -1.2");
    const auto result = importOff4(text, "p", 100);
    const auto* error = std::get_if<ImportError>(&result);
    ASSERT_TRUE(error);
    EXPECT_NE(error->reason.find("is not flat"), std::string::npos) << error->reason;

    // A flat-faced cell bent out of its hyperplane: two triangular bipyramids' worth of 5-cell faces taken as one cell.
    std::string bent = kPentachoron;
    bent.replace(bent.find("5 10 7 5"), 8, "5 10 7 4");
    bent.replace(bent.find("4 0 1 3 6 255 0 0\n4 0 2 4 7"), 27, "6 1 3 6 2 4 7");
    const auto other = importOff4(bent, "p", 100);
    error = std::get_if<ImportError>(&other);
    ASSERT_TRUE(error);
    EXPECT_NE(error->reason.find("cell 0 does not lie in a hyperplane"), std::string::npos) << error->reason;
}

TEST(Import, SurvivesGarbage) {
    std::mt19937 random(7);
    const std::string good = asOff4(*named("16-cell"));
    const std::string alphabet = "0123456789 .-+e#\n\t4OFX\xff";
    const auto pick = [&](std::size_t below) {
        return std::uniform_int_distribution<std::size_t>(0, below - 1)(random);
    };
    for (int round = 0; round < 20'000; ++round) {
        std::string text = good.substr(0, pick(8) == 0 ? pick(good.size()) : good.size());
        for (std::size_t edits = pick(6); edits-- > 0 && !text.empty();) {
            const std::size_t at = pick(text.size());
            switch (pick(3)) {
                case 0:
                    text[at] = alphabet[pick(alphabet.size())];
                    break;
                case 1:
                    text.insert(at, 1, alphabet[pick(alphabet.size())]);
                    break;
                default:
                    text.erase(at, 1 + pick(20));
                    break;
            }
        }
        const auto result = importOff4(text, "p", 1000);
        if (const auto* error = std::get_if<ImportError>(&result)) {
            EXPECT_FALSE(error->reason.empty());
        }
    }
    for (const char* text :
         {"", "4OFF", "4OFF\n", "#", "4OFF 0 0 0 0", "4OFF 0 0 0 1", "4OFF\n1 0 0 0\n0 0 0 0\n",
          "4OFF 4294967295 4294967295 4294967295 4294967295", "\xEF\xBB\xBF", "4OFF 5", "4OFF 5 5 5 5 5"}) {
        const auto result = importOff4(text, "p", ~std::size_t{0});
        EXPECT_TRUE(std::holds_alternative<ImportError>(result)) << text;
    }
}

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
                  "'stl' cannot be read; allowed is off");
    expectRefused(session, Load{"tesseract", "off", kPentachoron}, ErrorCode::bad_polytope, "a name of the catalogue");
    expectRefused(session, Load{"a\nb", "off", kPentachoron}, ErrorCode::bad_message, "printable");
    expectRefused(session, Load{"mine", "off", kPentachoron}, ErrorCode::too_large, "at most 4 are allowed",
                  Limits{.maxVertices = 4});
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
