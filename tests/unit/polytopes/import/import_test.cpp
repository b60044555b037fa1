// Tests of the import of 4OFF files and of lists of points. repair_test.cpp tests the repairs of 4OFF files.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "polytopes/catalogue/catalogue.hpp"
#include "polytopes/construction/coxeter.hpp"
#include "polytopes/import/import.hpp"
#include "unit/polytopes/import/import_support.hpp"

namespace oval4d::polytopes {
namespace {

using support::asPoints;
using support::countsOf;
using support::importOff4;
using support::importPoints;
using support::kPentachoron;
using support::Lines;
using support::named;
using support::reasonOf;
using support::Result;
using support::sound;
using support::turned;
using support::warningsOf;

// Returns the text of a 4OFF file of a polytope.
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

TEST(Import, KeepsCoordinatesUnchanged) {
    const Polytope p = sound(importOff4(kPentachoron, 100)).polytope;
    EXPECT_EQ(p.name, "p");
    EXPECT_EQ(p.vertices.size(), 5U);
    EXPECT_EQ(p.edges.size(), 10U);
    EXPECT_EQ(p.faces.size(), 10U);
    EXPECT_EQ(p.cells.size(), 5U);
    EXPECT_EQ(p.vertices[0], glm::dvec4(1, 1, 1, -.4472136));
    EXPECT_NEAR(p.circumradius, 4 / std::sqrt(5.0), 1e-6);
}

TEST(Import, ReadsRegularPolychoraBack) {
    for (const auto& entry : catalogue().first(6)) {
        const Polytope& original = named(entry.name);
        for (const char* end : {"\n", "\r\n", " \t\r\n"}) {
            const Polytope p = sound(importOff4(asOff4(original, end), 1000)).polytope;
            EXPECT_EQ(p.vertices, original.vertices);
            EXPECT_EQ(p.edges.size(), original.edges.size());
            EXPECT_EQ(p.faces, original.faces);
            EXPECT_EQ(p.cells, original.cells);
        }
        sound(importOff4(asOff4(original, "\n", 4), 1000));  // 4 significant digits: three decimals
    }
}

struct UnsoundFile {
    std::string find, replace, says;
    std::size_t line;
};
class UnsoundFiles : public testing::TestWithParam<UnsoundFile> {};

TEST_P(UnsoundFiles, AreRefusedWithTheLine) {
    const UnsoundFile& c = GetParam();
    std::string text = kPentachoron;
    ASSERT_NE(text.find(c.find), std::string::npos);
    text.replace(text.find(c.find), c.find.size(), c.replace);
    const auto result = importOff4(text, 100);
    const auto* error = std::get_if<FileError>(&result);
    ASSERT_TRUE(error);
    EXPECT_NE(error->reason.find(c.says), std::string::npos) << error->reason;
    EXPECT_EQ(error->line, c.line) << error->reason;
}

INSTANTIATE_TEST_SUITE_P(
    All, UnsoundFiles,
    testing::Values(UnsoundFile{"4OFF#", "OFF #", "must begin with 4OFF, not 'OFF'", 2},
                    UnsoundFile{"5 10 7 5", "5 10 7", "'4' follows the last 2-face", 20},
                    UnsoundFile{"5 10 7 5", "5 10 -7 5", "'-7' is not a number of edges", 3},
                    UnsoundFile{"5 10 7 5", "5 10 7 x", "'x' is not a number of cells", 3},
                    UnsoundFile{"5 10 7 5", "5 4000000000 7 5", "the file is too short for its numbers", 3},
                    UnsoundFile{"5 10 7 5", "500 10 7 5", "500 vertices are too many", 3},
                    UnsoundFile{"5 10 7 5", "5 10 7 4", "follows the last cell", 24},
                    UnsoundFile{"1e0", "one", "'one' is not a number", 5},
                    UnsoundFile{"1e0", "nan", "'nan' is not a finite number", 5},
                    UnsoundFile{"1e0", "inf", "'inf' is not a finite number", 5},
                    UnsoundFile{"1e0", "1e999", "'1e999' is beyond ±1e14", 5},
                    UnsoundFile{"1e0", "1e15", "'1e15' is beyond ±1e14", 5},
                    UnsoundFile{"3 0 1 2 ", "3 0 1 5 ", "2-face 0 refers to vertex 5, but the last is vertex 4", 10},
                    UnsoundFile{"3 0 1 2 ", "3 0 1 1 ", "2-face 0 has only 2 different vertices", 10},
                    UnsoundFile{"3 0 1 2 ", "2 0 1 2 ", "has 2 vertices; 3 to 10 are allowed", 10},
                    UnsoundFile{"3 0 1 2 ", "3 0 -1 2 ", "'-1' is not the number of a vertex", 10},
                    UnsoundFile{"4 0 1 3 6 ", "4 0 1 3 10 ", "cell 0 refers to 2-face 10, but the last is 2-face 9",
                                20},
                    UnsoundFile{"4 0 1 3 6 ", "3 0 1 3 6 ", "has 3 2-faces; 4 to 20 are allowed", 20},
                    UnsoundFile{"4 6 7 8 9\n", "", "the file ends before cell 4", 24},
                    UnsoundFile{"4 6 7 8 9\n", "4 6 7 8", "cell 4 has 3 of 4 2-faces", 24},
                    UnsoundFile{"4 6 7 8 9", "4 3 4 5 9", "2-face 3 lies in more than two cells", 13},
                    UnsoundFile{"4 6 7 8 9", "4 6 7 8 8", "cell 4 lists one of its 2-faces twice", 24},
                    UnsoundFile{"0 0 0 1.7888544", "0 0 0 -.4472136", "all vertices lie in one hyperplane", 0},
                    UnsoundFile{"4 6 7 8 9", "4 6 7 8 5", "cell 4 does not lie in a hyperplane", 24}));

TEST(Import, NamesTheRecordThatIsTooShortForItsLine) {
    for (const char* name : {"5-cell", "8-cell"}) {
        const Polytope& p = named(name);
        std::vector<std::string> lines;
        std::istringstream text(asOff4(p));
        for (std::string line; std::getline(text, line);) lines.push_back(line);
        for (std::size_t at = 2; at < lines.size(); ++at) {
            std::string shorter;
            for (std::size_t i = 0; i < lines.size(); ++i)
                shorter += (i == at ? lines[i].substr(0, lines[i].rfind(' ')) : lines[i]) + '\n';
            std::size_t number = at - 2;
            std::string record = "vertex ";
            if (number >= p.vertices.size()) {
                record = "2-face ";
                number -= p.vertices.size();
                if (number >= p.faces.size()) {
                    record = "cell ";
                    number -= p.faces.size();
                }
            }
            record += std::to_string(number) + " has ";
            const auto result = importOff4(shorter);
            const auto* error = std::get_if<FileError>(&result);
            ASSERT_TRUE(error) << lines[at];
            EXPECT_EQ(error->reason.substr(0, record.size()), record) << error->reason;
            EXPECT_EQ(error->line, at + 1) << error->reason;
        }
    }
}

TEST(Import, ReadsRecordsThatShareAndBreakLines) {
    const Polytope& original = named("24-cell");
    const std::string text = asOff4(original);
    std::string together = text, apart = text;
    const std::size_t header = text.find('\n', text.find('\n') + 1) + 1;
    std::replace(together.begin() + static_cast<std::ptrdiff_t>(header), together.end(), '\n', ' ');
    std::replace(apart.begin() + static_cast<std::ptrdiff_t>(header), apart.end(), ' ', '\n');
    for (const std::string& each : {together, apart}) {
        const Polytope p = sound(importOff4(each)).polytope;
        EXPECT_EQ(p.vertices, original.vertices);
        EXPECT_EQ(p.faces, original.faces);
        EXPECT_EQ(p.cells, original.cells);
    }
}

TEST(Import, SaysThatAFileListsNoCells) {
    for (const char* text :
         {"4OFF\n2 0 0 0\n1 2 3 4\n5 6 7 8\n", "4OFF\n5 1 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n0 0 0 0\n3 0 1 2\n",
          "4OFF\n3 1 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n3 0 1 2\n"})
        EXPECT_EQ(reasonOf(importOff4(text)), "the file lists no cells; its points can be loaded as a list of points");
}

TEST(Import, SaysThatCoordinatesAreSeparatedByCommas) {
    std::string text = asOff4(named("5-cell"));
    text.replace(text.find('\n', text.find("5 10")) + 1, 0, "0, 0, 0, 0\n");
    EXPECT_NE(reasonOf(importOff4(text)).find("'0,' ends with a comma; write blanks between numbers"),
              std::string::npos)
        << reasonOf(importOff4(text));
}

TEST(Import, CellsMustLieInAHyperplaneAndFacesInAPlane) {
    std::string text = asOff4(named("8-cell"));
    const std::size_t at = text.find('\n', text.find("16 24")) + 1;
    text.replace(at, text.find('\n', at) - at, "-1 -1 -1 -1.2");
    const auto result = importOff4(text, 100);
    const auto* error = std::get_if<FileError>(&result);
    ASSERT_TRUE(error);
    EXPECT_NE(error->reason.find("is not flat"), std::string::npos) << error->reason;

    // A cell with flat 2-faces that does not lie in a hyperplane is an error. Here, the triangles of two cells of the
    // 5-cell form one cell.
    std::string bent = kPentachoron;
    bent.replace(bent.find("5 10 7 5"), 8, "5 10 7 4");
    bent.replace(bent.find("4 0 1 3 6 255 0 0\n4 0 2 4 7"), 27, "6 1 3 6 2 4 7");
    const auto other = importOff4(bent, 100);
    error = std::get_if<FileError>(&other);
    ASSERT_TRUE(error);
    EXPECT_NE(error->reason.find("cell 0 does not lie in a hyperplane"), std::string::npos) << error->reason;
}

TEST(Points, OfARegularPolytopeHaveItAsTheirHull) {
    std::mt19937 random(11);
    for (const char* name : {"5-cell", "8-cell", "16-cell", "24-cell", "120-cell", "600-cell"}) {
        const auto& original = named(name);
        for (const int digits : {17, 5}) {
            auto points = turned(original, random);
            std::shuffle(points.begin(), points.end(), random);
            const ImportedPolytope imported = sound(importPoints(asPoints(points, digits)));
            EXPECT_EQ(countsOf(imported.polytope), countsOf(original)) << name << " with " << digits << " digits";
            EXPECT_EQ(warningsOf(imported), "");
            EXPECT_EQ(imported.polytope.cellTypes.size(), 1U) << name;
        }
    }
}

TEST(Points, InsideTheHullAreLeftOutWithAWarning) {
    std::mt19937 random(12);
    auto points = turned(named("24-cell"), random);
    const std::size_t corners = points.size();
    for (int i = 0; i < 30; ++i) points.push_back(0.3 * points[i % corners] + 0.3 * points[(i + 5) % corners]);
    points.push_back(points[3]);
    const ImportedPolytope imported = sound(importPoints(asPoints(points)));
    EXPECT_EQ(countsOf(imported.polytope), countsOf(named("24-cell")));
    EXPECT_EQ(warningsOf(imported), "31 of 55 points are not hull vertices and were left out");
}

TEST(Points, AreReadFromTables) {
    std::mt19937 random(13);
    const auto points = turned(named("16-cell"), random);
    for (const char* between : {",", ", ", ";", "\t"}) {
        const std::string text = "# a comment\nx,y,z,w\n" + asPoints(points, 17, between);
        EXPECT_EQ(sound(importPoints(text)).polytope.cellCount(), 16U);
        EXPECT_EQ(detectFileFormat(text), PolytopeFileFormat::points);
    }
}

// The cyclic polytope of n points on the moment curve has n(n − 3)/2 cells, which are simplices, and each pair of its
// vertices is an edge (Ziegler, Lectures on Polytopes, §0).
TEST(Points, OnTheMomentCurveGiveTheCyclicPolytope) {
    const auto curve = [](int n) {
        std::vector<glm::dvec4> points;
        for (int i = 0; i < n; ++i) {
            // The trigonometric moment curve; the hull of its points is also a cyclic polytope.
            const double t = 2 * std::numbers::pi * i / n;
            points.emplace_back(std::cos(t), std::sin(t), std::cos(2 * t), std::sin(2 * t));
        }
        return asPoints(points);
    };
    const Polytope p = sound(importPoints(curve(40))).polytope;
    EXPECT_EQ(p.cellCount(), 40U * 37 / 2);
    EXPECT_EQ(p.edges.size(), 40U * 39 / 2);
    const Result result = importPoints(curve(200), 10'000);
    EXPECT_NE(reasonOf(result).find("more than 10000 cells"), std::string::npos) << reasonOf(result);
    EXPECT_TRUE(std::get<FileError>(result).tooLarge);
}

TEST(Points, ThatDoNotSpanFourDimensionsAreRefused) {
    const auto refusal = [](std::string_view text) { return reasonOf(importPoints(text)); };
    EXPECT_NE(refusal("").find("the file is empty"), std::string::npos);
    EXPECT_NE(refusal("1 2 3 4\n").find("at least 5 points, not 1"), std::string::npos);
    EXPECT_NE(refusal("1 2 3 4\n1 2 3\n").find("a point has 3 coordinates"), std::string::npos);
    EXPECT_NE(refusal("1 2 3 4\n1 2 3 4 5\n").find("'5' follows a point's four coordinates"), std::string::npos);
    EXPECT_NE(refusal("1 2 3 4\n1 2 x 4\n").find("'x' is not a number"), std::string::npos);
    EXPECT_NE(refusal("0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n1 1 1 1\n2 1 1 1\n").find("lie in one hyperplane"),
              std::string::npos);
    EXPECT_EQ(std::get<FileError>(importPoints("1 2 3 4\n\n1 2 3\n")).line, 3U);
}

TEST(Import, ReadsTheLargestUniformPolychoronBack) {
    const CoxeterDiagram diagram = CoxeterDiagram::linear({5, 1}, {3, 1}, {3, 1}, {true, true, true, true});
    const Polytope original = wythoffConstruction("omnitruncated 120-cell", diagram, mirrorsOf(diagram));
    ASSERT_EQ(original.vertices.size(), 14'400U);
    const ImportedPolytope imported = sound(importOff4(Lines(original).text(28'800)));
    EXPECT_EQ(countsOf(imported.polytope), countsOf(original));
    EXPECT_EQ(imported.polytope.faces, original.faces);
    EXPECT_EQ(warningsOf(imported), "");
}

TEST(Import, ReadsStarPolychoraBack) {
    for (const auto& [p, q, r] : {std::array<DiagramBranch, 3>{{{5, 2}, {5, 1}, {3, 1}}},
                                  {{{5, 1}, {5, 2}, {5, 1}}},
                                  {{{5, 2}, {3, 1}, {3, 1}}}}) {
        const CoxeterDiagram diagram = CoxeterDiagram::linear(p, q, r, {true, false, false, false});
        const Polytope original = wythoffConstruction("star", diagram, mirrorsOf(diagram));
        const ImportedPolytope imported = sound(importOff4(Lines(original).text()));
        EXPECT_EQ(countsOf(imported.polytope), countsOf(original));
        EXPECT_EQ(imported.polytope.convexFaces, original.convexFaces);
        EXPECT_EQ(warningsOf(imported), "");
    }
}

TEST(Import, SurvivesGarbage) {
    std::mt19937 random(7);
    const std::string good = asOff4(named("16-cell"));
    const std::string alphabet = "0123456789 .-+e#\n\t4OFX\xff";
    const auto pick = [&](std::size_t below) {
        return std::uniform_int_distribution<std::size_t>(0, below - 1)(random);
    };
    for (int round = 0; round < (support::kSanitized ? 2'000 : 20'000); ++round) {
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
        const auto result = importPolytope(detectFileFormat(text), text, "p", {1000, 1000});
        if (const auto* error = std::get_if<FileError>(&result)) {
            EXPECT_FALSE(error->reason.empty());
        }
    }
    for (const char* text :
         {"", "4OFF", "4OFF\n", "#", "4OFF 0 0 0 0", "4OFF 0 0 0 1", "4OFF\n1 0 0 0\n0 0 0 0\n",
          "4OFF 4294967295 4294967295 4294967295 4294967295", "\xEF\xBB\xBF", "4OFF 5", "4OFF 5 5 5 5 5"}) {
        const auto result = importOff4(text, ~std::size_t{0});
        EXPECT_TRUE(std::holds_alternative<FileError>(result)) << text;
    }
}

}  // namespace
}  // namespace oval4d::polytopes
