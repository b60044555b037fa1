// Tests of the ten regular star polychora and of other polytopes with star polygons.

#include <cmath>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "polytopes/catalogue/catalogue.hpp"
#include "unit/slicing/support.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::support;
using namespace oval4d::polytopes;

struct Star {
    const char *name, *symbol;
    int density;
    ElementCounts counts;
    int verticesOfCell, facesOfCell;
};

// The densities and numbers of elements are those of Coxeter, Regular Polytopes, table I (ii) and §14.
const Star kStars[] = {
    {"small stellated 120-cell", "{5/2,5,3}", 4, {120, 1200, 720, 120}, 12, 12},
    {"icosahedral 120-cell", "{3,5,5/2}", 4, {120, 720, 1200, 120}, 12, 20},
    {"great 120-cell", "{5,5/2,5}", 6, {120, 720, 720, 120}, 12, 12},
    {"grand 120-cell", "{5,3,5/2}", 20, {120, 720, 720, 120}, 20, 12},
    {"great stellated 120-cell", "{5/2,3,5}", 20, {120, 720, 720, 120}, 20, 12},
    {"grand stellated 120-cell", "{5/2,5,5/2}", 66, {120, 720, 720, 120}, 12, 12},
    {"great grand 120-cell", "{5,5/2,3}", 76, {120, 1200, 720, 120}, 12, 12},
    {"great icosahedral 120-cell", "{3,5/2,5}", 76, {120, 720, 1200, 120}, 12, 20},
    {"grand 600-cell", "{3,3,5/2}", 191, {120, 720, 1200, 600}, 4, 4},
    {"great grand stellated 120-cell", "{5/2,3,3}", 191, {600, 1200, 720, 120}, 20, 12},
};

/// Returns the density at a direction: how often the boundary, seen from the origin, covers this direction. Divides the
/// boundary into simplices, and adds up the signs of those whose cones from the origin contain the direction.
int densityAt(const Polytope& p, const glm::dvec4& direction) {
    int sum = 0;
    for (std::uint32_t c = 0; c < p.cells.size(); ++c) {
        const glm::dvec4 apex = p.vertices[p.faces[p.cells[c][0]][0]];
        for (auto slot = p.cells.begin[c]; slot < p.cells.begin[c + 1]; ++slot) {
            const auto loop = p.faces[p.cells.items[slot]];
            for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
                const glm::dmat4 corners(apex, p.vertices[loop[0]], p.vertices[loop[i]], p.vertices[loop[i + 1]]);
                const double determinant = glm::determinant(corners);
                if (std::abs(determinant) < 1e-9) continue;  // a triangle at the apex of its cell gives no simplex
                const glm::dvec4 parts = glm::inverse(corners) * direction;
                if (parts.x > 0 && parts.y > 0 && parts.z > 0 && parts.w > 0)
                    sum += p.cellSigns[slot] * (determinant > 0 ? 1 : -1);
            }
        }
    }
    return sum;
}

class Stars : public testing::TestWithParam<Star> {
  protected:
    const Star& star = GetParam();
    const std::shared_ptr<const Polytope> polytope = shared(star.symbol);
    const Polytope& p = *polytope;
};

TEST_P(Stars, haveTheNumbersOfElementsOfTheTable) {
    EXPECT_EQ(p.name, star.name);
    EXPECT_EQ(findEntry(star.name), findEntry(star.symbol));
    EXPECT_EQ((ElementCounts{p.vertices.size(), p.edges.size(), p.faces.size(), p.cells.size()}), star.counts);
    for (std::size_t c = 0; c < p.cells.size(); ++c) {
        std::set<std::uint32_t> corners;
        for (const auto f : p.cells[c]) corners.insert(p.faces[f].begin(), p.faces[f].end());
        ASSERT_EQ(corners.size(), std::size_t(star.verticesOfCell));
        ASSERT_EQ(p.cells[c].size(), std::size_t(star.facesOfCell));
    }
}

TEST_P(Stars, haveTheDensityOfTheTable) {
    std::mt19937 random(41);
    for (int trial = 0; trial < 12; ++trial) EXPECT_EQ(std::abs(densityAt(p, randomDirection(random))), star.density);
}

// A regular star polychoron has the 2-faces of its Schläfli symbol. The length of a diagonal tells pentagrams from
// pentagons.
TEST_P(Stars, havePentagramsAccordingToTheirSymbol) {
    const bool pentagrams = std::string_view(star.symbol).starts_with("{5/2");
    EXPECT_EQ(p.convexFaces, !pentagrams);
    for (std::size_t f = 0; f < p.faces.size(); ++f) {
        const auto loop = p.faces[f];
        const double diagonal = glm::distance(p.vertices[loop[0]], p.vertices[loop[2]]);
        const double phi = std::numbers::phi;
        EXPECT_NEAR(diagonal, loop.size() == 3 ? 2 : pentagrams ? 2 / phi : 2 * phi, 1e-9);
    }
}

TEST_P(Stars, haveSlicesWhoseVolumesIntegrateToTheHypervolume) {
    double cones = 0;
    for (std::uint32_t c = 0; c < p.cells.size(); ++c) {
        for (auto slot = p.cells.begin[c]; slot < p.cells.begin[c + 1]; ++slot) {
            const auto loop = p.faces[p.cells.items[slot]];
            for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
                cones += p.cellSigns[slot] *
                         glm::determinant(glm::dmat4(p.vertices[p.faces[p.cells[c][0]][0]], p.vertices[loop[0]],
                                                     p.vertices[loop[i]], p.vertices[loop[i + 1]])) /
                         24;
            }
        }
    }
    std::mt19937 random(42);
    EXPECT_NEAR(hypervolumeBySlices(p, randomRotation(random)) / std::abs(cones), 1, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(All, Stars, testing::ValuesIn(kStars), [](const auto& i) {
    std::string name(i.param.name);
    std::replace_if(name.begin(), name.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
    return name;
});

TEST(StarProducts, haveTheDensityOfTheirPolygons) {
    std::mt19937 random(43);
    const auto density = [&](std::string_view name) {
        const auto design = designNamed(name, 1000);
        if (!std::holds_alternative<PolytopeDesign>(design)) return -1;
        return std::abs(densityAt(*cache().findOrBuild(std::get<PolytopeDesign>(design)), randomDirection(random)));
    };
    EXPECT_EQ(density("5/2,5-duoprism"), 2);
    EXPECT_EQ(density("5/2,7/3-duoprism"), 6);
    EXPECT_EQ(density("x5/2o x5o"), 2);
    EXPECT_EQ(density("small stellated dodecahedral prism"), 3);
    EXPECT_EQ(density("great dodecahedron prism"), 3);
    EXPECT_EQ(density("great icosahedron prism"), 7);
    EXPECT_EQ(density("{5/2,3}x{}"), 7);
    EXPECT_EQ(density("5,7-duoprism"), 1);
}

TEST(StarDiagrams, whoseElementsCoincideAreRefused) {
    for (const char* diagram : {"x3o3o5/2x", "x5/2o5o5/2x", "x5o5/2o5x"}) {
        const auto design = designNamed(diagram, 100'000);
        ASSERT_TRUE(std::holds_alternative<PolytopeDesign>(design)) << diagram;
        try {
            (void)cache().findOrBuild(std::get<PolytopeDesign>(design));
            ADD_FAILURE() << diagram;
        } catch (const std::invalid_argument& refused) {
            EXPECT_NE(std::string_view(refused.what()).find("coincide"), std::string_view::npos) << refused.what();
        }
    }
}

TEST(StarCells, areNamedAfterKeplerAndPoinsot) {
    const auto cellTypeOf = [](std::string_view name) { return named(name).cellTypes.at(0).name; };
    EXPECT_EQ(cellTypeOf("{5/2,5,3}"), "small stellated dodecahedron");
    EXPECT_EQ(cellTypeOf("{5,5/2,5}"), "great dodecahedron");
    EXPECT_EQ(cellTypeOf("{5/2,3,5}"), "great stellated dodecahedron");
    EXPECT_EQ(cellTypeOf("{3,5/2,5}"), "great icosahedron");
    EXPECT_EQ(cellTypeOf("{3,5,5/2}"), "icosahedron");
    EXPECT_EQ(cellTypeOf("{5,3,5/2}"), "dodecahedron");
    EXPECT_EQ(cellTypeOf("{3,3,5/2}"), "tetrahedron");
}

}  // namespace
