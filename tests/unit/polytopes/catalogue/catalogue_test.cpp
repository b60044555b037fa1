#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "unit/polytopes/support.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::polytopes;
using support::named;
using support::shared;

class Catalogue : public testing::TestWithParam<CatalogueEntry> {
  protected:
    const CatalogueEntry& entry = GetParam();
    const std::shared_ptr<const Polytope> polytope = shared(entry.name);
    const Polytope& p = *polytope;
};

TEST_P(Catalogue, hasTheNumbersOfElementsOfTheoryAndEulersFormula) {
    EXPECT_EQ(p.vertices.size(), entry.vertices);
    EXPECT_EQ(p.edges.size(), entry.edges);
    EXPECT_EQ(p.faces.size(), entry.faces);
    EXPECT_EQ(p.cells.size(), entry.cells);
    // Euler's formula V − E + F − C = 0 may not hold for star polytopes, whose cells may have handles.
    if (entry.family != "star") {
        EXPECT_EQ(entry.vertices + entry.faces, entry.edges + entry.cells);
    }
}

TEST_P(Catalogue, hasEqualEdgesAndIsCentered) {
    glm::dvec4 sum(0);
    for (const auto& v : p.vertices) {
        ASSERT_NEAR(glm::length(v), p.circumradius, 1e-12 * p.circumradius);
        sum += v;
    }
    EXPECT_LT(glm::length(sum), 1e-14 * p.circumradius * double(p.vertices.size()));
    for (const auto& [a, b] : p.edges)
        ASSERT_NEAR(glm::distance(p.vertices[a], p.vertices[b]), 2, 1e-12 * p.circumradius);
}

TEST_P(Catalogue, hasFlatFacesAndCells) {
    for (std::size_t c = 0; c < p.cells.size(); ++c) {
        // In a uniform polytope, the line from the origin to the center of a cell is perpendicular to the cell's
        // hyperplane.
        std::set<std::uint32_t> corners;
        for (const auto f : p.cells[c]) corners.insert(p.faces[f].begin(), p.faces[f].end());
        glm::dvec4 center(0);
        for (const auto v : corners) center += p.vertices[v] / static_cast<double>(corners.size());
        for (const auto v : corners) ASSERT_NEAR(glm::dot(p.vertices[v] - center, center), 0, 1e-9);
    }
    for (std::size_t f = 0; f < p.faces.size(); ++f) {
        const auto loop = p.faces[f];
        const glm::dvec4 u = glm::normalize(p.vertices[loop[1]] - p.vertices[loop[0]]);
        glm::dvec4 v = p.vertices[loop[2]] - p.vertices[loop[0]];
        v = glm::normalize(v - u * glm::dot(u, v));
        for (const auto i : loop) {
            const glm::dvec4 d = p.vertices[i] - p.vertices[loop[0]];
            ASSERT_LT(glm::length(d - u * glm::dot(d, u) - v * glm::dot(d, v)), 1e-10);
        }
    }
}

TEST_P(Catalogue, isAClosedCoherentlyOrientedSurface) {
    std::vector<int> signs(p.faces.size());
    std::vector<int> cellsOfFace(p.faces.size());
    for (std::size_t slot = 0; slot < p.cells.items.size(); ++slot) {
        signs[p.cells.items[slot]] += p.cellSigns[slot];
        ++cellsOfFace[p.cells.items[slot]];
    }
    for (std::size_t f = 0; f < p.faces.size(); ++f) {
        ASSERT_EQ(signs[f], 0);
        ASSERT_EQ(cellsOfFace[f], 2);
        for (const int i : {0, 1}) {
            const auto c = p.faceCells[f].at(i);
            const auto place = std::find(p.cells[c].begin(), p.cells[c].end(), f);
            ASSERT_NE(place, p.cells[c].end());
            ASSERT_EQ(p.cellSigns[p.cells.begin[c] + (place - p.cells[c].begin())], 2 * i - 1);
        }
    }
    for (std::size_t c = 0; c < p.cells.size(); ++c) {
        std::map<std::uint32_t, int> passes;
        std::size_t sides = 0;
        for (std::uint32_t slot = p.cells.begin[c]; slot < p.cells.begin[c + 1]; ++slot) {
            const auto f = p.cells.items[slot];
            sides += p.faces[f].size();
            for (std::size_t i = 0; i < p.faces[f].size(); ++i) {
                const auto e = p.faceEdges[f][i];
                const auto next = p.faces[f][(i + 1) % p.faces[f].size()];
                ASSERT_EQ(std::set({p.edges[e][0], p.edges[e][1]}), std::set({p.faces[f][i], next}));
                passes[e] += p.cellSigns[slot] * (p.edges[e][0] == p.faces[f][i] ? 1 : -1);
            }
        }
        ASSERT_EQ(sides, 2 * passes.size());
        for (const auto& [edge, sum] : passes) ASSERT_EQ(sum, 0) << "edge " << edge;
    }
}

TEST_P(Catalogue, listsFacesInCyclicOrderAroundEveryEdge) {
    std::vector<std::size_t> sides(p.faces.size());
    for (std::size_t e = 0; e < p.edges.size(); ++e) {
        const auto around = p.edgeFaces[e];
        for (std::size_t i = 0; i < around.size(); ++i) {
            const auto f = around[i] / 2, next = around[(i + 1) % around.size()];
            const auto loop = p.faces[f];
            const auto start = std::find(loop.begin(), loop.end(), p.edges[e][around[i] % 2 == 1 ? 0 : 1]);
            ASSERT_NE(start, loop.end());
            const auto behind = (start - loop.begin() + 1) % loop.size();
            ASSERT_EQ(loop[behind], p.edges[e][around[i] % 2 == 1 ? 1 : 0]);
            ++sides[f];
            ASSERT_EQ(p.faceCells[f].at(1 - around[i] % 2), p.faceCells[next / 2].at(next % 2));
        }
    }
    for (std::size_t f = 0; f < p.faces.size(); ++f) ASSERT_EQ(sides[f], p.faces[f].size());
}

TEST_P(Catalogue, isFoundByEveryName) {
    for (const auto& alias : entry.aliases) {
        ASSERT_NE(findEntry(alias), nullptr) << alias;
        EXPECT_EQ(findEntry(alias)->name, entry.name) << alias;
    }
    if (!entry.schlaefli.empty()) {
        EXPECT_EQ(findEntry(entry.schlaefli)->name, entry.name);
    }
    if (!entry.diagram.empty()) {
        ASSERT_NE(findEntry(entry.diagram), nullptr) << entry.diagram;
        EXPECT_EQ(findEntry(entry.diagram)->name, entry.name);
    }
    EXPECT_EQ(shared(entry.name)->name, entry.name);
}

INSTANTIATE_TEST_SUITE_P(All, Catalogue, testing::ValuesIn(catalogue().begin(), catalogue().end()), [](const auto& i) {
    std::string name(i.param.name);
    std::replace_if(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return "the_" + name;
});

TEST(CatalogueNames, ignoreCaseAndHyphens) {
    EXPECT_EQ(findEntry("24 Cell")->name, "24-cell");
    EXPECT_EQ(findEntry("TESSERACT")->name, "8-cell");
    EXPECT_EQ(findEntry("25-cell"), nullptr);
    EXPECT_EQ(findEntry(""), nullptr);
}

TEST(CatalogueNames, areAllDifferent) {
    std::map<std::string, std::string> owner;
    for (const auto& entry : catalogue()) {
        std::set<std::string> own(entry.aliases.begin(), entry.aliases.end());
        EXPECT_EQ(own.size(), entry.aliases.size()) << entry.name;
        own.insert({entry.name, entry.diagram, entry.schlaefli});
        own.erase("");
        for (const auto& name : own) {
            EXPECT_TRUE(owner.emplace(name, entry.name).second) << name << ": " << owner[name] << ", " << entry.name;
        }
    }
}

// The catalogue contains all 47 convex uniform polychora that are not prisms (Conway and Guy, 1965) and all ten regular
// star polychora.
TEST(CatalogueFamilies, areComplete) {
    std::map<std::string, int> families;
    for (const auto& entry : catalogue()) ++families[entry.family];
    EXPECT_EQ(families["regular"] + families["uniform A4"] + families["uniform B4"] + families["uniform F4"] +
                  families["uniform H4"] + families["other"],
              47);
    EXPECT_EQ(families["star"], 10);
    EXPECT_EQ(families["prism"], 17);  // the prisms over the 18 Platonic and Archimedean solids, without the cube
    EXPECT_GE(families["duoprism"], 5);
    EXPECT_GE(families["antiprism prism"], 3);
    const std::array<std::string_view, 6> first{"5-cell", "8-cell", "16-cell", "24-cell", "120-cell", "600-cell"};
    for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(catalogue()[i].name, first.at(i));
}

TEST(CatalogueNames, onlySimilarNamesAreSuggested) {
    for (const char* const text : {"", "z", "q", "qj", "teapot", "wvqzk", "snub", "a b c d e f g h i j k l m n o p"})
        EXPECT_EQ(nearestName(text), "") << text;
    EXPECT_EQ(nearestName("tessaract"), "tesseract");
    EXPECT_EQ(nearestName("icositetrakoron"), "icositetrachoron");
}

TEST(CatalogueNames, nothingIsSuggestedForLongTexts) {
    for (const std::size_t size : {100, 200, 256, 257, 1000, 1'000'000}) {
        EXPECT_EQ(nearestName(std::string(size, 'q')), "") << size;
        EXPECT_EQ(nearestName("tesseract" + std::string(size, 't')), "") << size;
    }
    EXPECT_EQ(editDistanceOfNames("tesseract", std::string(1'000'000, 't')), 254U);
}

TEST(CatalogueNames, nearMissesAreSuggested) {
    EXPECT_EQ(nearestName("25-cell"), "24-cell");
    EXPECT_EQ(nearestName("teseract"), "tesseract");
    EXPECT_EQ(nearestName("601cell"), "600-cell");
    EXPECT_EQ(nearestName("omnitruncate 120 cell"), "omnitruncated 120-cell");
    EXPECT_EQ(equallyNearestNames("teseract"), (std::vector<std::string_view>{"tesseract"}));
    EXPECT_EQ(equallyNearestNames("truncated 14-cell"),
              (std::vector<std::string_view>{"truncated 16-cell", "truncated 24-cell"}));
}

// Expects the vertices of the polytope to be `scale` times all vectors that arise from the seeds by changes of signs
// and by permutations. If a seed's flag is true, only even permutations count.
void expectOrbits(std::string_view name, double scale, const std::vector<std::pair<glm::dvec4, bool>>& seeds) {
    const Polytope& p = named(name);
    std::set<std::array<long, 4>> expected;
    const auto rounded = [](const glm::dvec4& v) {
        return std::array{std::lround(v.x * 1e6), std::lround(v.y * 1e6), std::lround(v.z * 1e6),
                          std::lround(v.w * 1e6)};
    };
    for (const auto& [seed, even] : seeds) {
        std::array<int, 4> order{0, 1, 2, 3};
        do {
            int inversions = 0;
            for (int i = 0; i < 4; ++i) {
                for (int j = i + 1; j < 4; ++j) inversions += order[i] > order[j] ? 1 : 0;
            }
            if (even && inversions % 2 != 0) continue;
            for (int signs = 0; signs < 16; ++signs) {
                glm::dvec4 v;
                for (int i = 0; i < 4; ++i) v[i] = seed[order[i]] * (signs >> i & 1 ? -scale : scale);
                expected.insert(rounded(v));
            }
        } while (std::next_permutation(order.begin(), order.end()));
    }
    std::set<std::array<long, 4>> found;
    for (const auto& v : p.vertices) found.insert(rounded(v));
    EXPECT_EQ(found, expected) << name;
}

TEST(StartingPosition, hasTheCoordinatesInCommonUse) {
    const double phi = std::numbers::phi;
    const double root5 = std::sqrt(5.0);
    expectOrbits("8-cell", 1, {{{1, 1, 1, 1}, false}});
    expectOrbits("16-cell", std::numbers::sqrt2, {{{1, 0, 0, 0}, false}});
    expectOrbits("24-cell", 1, {{{2, 0, 0, 0}, false}, {{1, 1, 1, 1}, false}});
    expectOrbits("600-cell", phi, {{{2, 0, 0, 0}, false}, {{1, 1, 1, 1}, false}, {{phi, 1, 1 / phi, 0}, true}});
    expectOrbits("120-cell", phi * phi,
                 {{{0, 0, 2, 2}, false},
                  {{1, 1, 1, root5}, false},
                  {{1 / phi / phi, phi, phi, phi}, false},
                  {{1 / phi, 1 / phi, 1 / phi, phi * phi}, false},
                  {{0, 1 / phi / phi, 1, phi * phi}, true},
                  {{0, 1 / phi, phi, root5}, true},
                  {{1 / phi, 1, phi, 2}, true}});
}

TEST(StartingPosition, ofThe5CellIsThatOfThePaper) {
    const double y = 1 / std::sqrt(3.0);
    const double z = 1 / std::sqrt(6.0);
    const double w = 1 / std::sqrt(10.0);
    const std::array<glm::dvec4, 5> paper{
        {{-1, -y, -z, -w}, {1, -y, -z, -w}, {0, 2 * y, -z, -w}, {0, 0, std::sqrt(1.5), -w}, {0, 0, 0, 4 * w}}};
    const Polytope& p = named("5-cell");
    ASSERT_EQ(p.vertices.size(), paper.size());
    for (std::size_t i = 0; i < paper.size(); ++i) EXPECT_LT(glm::distance(p.vertices[i], paper[i]), 1e-14) << "P" << i;
}

TEST(MakePolytope, refusesWhatIsNotAClosedSurface) {
    const Polytope& good = named(catalogue()[0].name);
    const auto build = [&](const geometry::JaggedArray& faces, const geometry::JaggedArray& cells) {
        return makePolytope("x", good.vertices, faces, cells);
    };
    EXPECT_NO_THROW((void)build(good.faces, good.cells));
    geometry::JaggedArray open = good.cells;
    open.begin.pop_back();
    open.items.resize(open.begin.back());
    EXPECT_THROW((void)build(good.faces, open), std::invalid_argument);
    geometry::JaggedArray wrongIndex = good.faces;
    wrongIndex.items[4] = 5;
    EXPECT_THROW((void)build(wrongIndex, good.cells), std::invalid_argument);
    geometry::JaggedArray twisted = good.cells;
    std::swap(twisted.items.front(), twisted.items.back());
    EXPECT_THROW((void)build(good.faces, twisted), std::invalid_argument);
    EXPECT_THROW((void)makePolytope("x", {}, {}, {}), std::invalid_argument);
}

}  // namespace
