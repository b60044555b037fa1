// Tests of duals by polar reciprocity.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "polytopes/catalogue/catalogue.hpp"
#include "polytopes/construction/design.hpp"
#include "polytopes/polytope.hpp"
#include "unit/polytopes/support.hpp"

namespace oval4d::polytopes {
namespace {

class DualOf : public testing::TestWithParam<const char*> {};

TEST_P(DualOf, isItsPolarReciprocal) {
    const Polytope base = build(support::designFor(GetParam()));
    const PolytopeDesign design = support::designFor(std::string("dual of ") + GetParam());
    const Polytope dual = build(design);
    EXPECT_EQ(dual.name, design.name);
    EXPECT_EQ(dual.vertices.size(), base.cells.size());
    EXPECT_EQ(dual.edges.size(), base.faces.size());
    EXPECT_EQ(dual.faces.size(), base.edges.size());
    EXPECT_EQ(dual.cells.size(), base.vertices.size());
    EXPECT_EQ(elementCounts(design).vertices, dual.vertices.size());
    EXPECT_EQ(elementCounts(design).cells, dual.cells.size());
    EXPECT_EQ(symmetryOrder(design), symmetryOrder(support::designFor(GetParam())));
    EXPECT_EQ(dual.convex, base.convex);
    EXPECT_NEAR(dual.circumradius, base.circumradius, 1e-9 * base.circumradius);
    // The product v · p of a vertex v of the dual and a vertex p of the base is the same for all incident pairs. For
    // convex polytopes, it is smaller for all other pairs.
    double squared = 0;
    for (std::size_t c = 0; c < base.cells.size(); ++c) {
        std::vector<bool> incident(base.vertices.size(), false);
        for (const auto f : base.cells[c]) {
            for (const auto v : base.faces[f]) incident[v] = true;
        }
        for (std::size_t v = 0; v < base.vertices.size(); ++v) {
            const double product = glm::dot(dual.vertices[c], base.vertices[v]);
            if (squared == 0 && incident[v]) squared = product;
            if (incident[v]) {
                EXPECT_NEAR(product, squared, 1e-9 * squared);
            } else if (base.convex) {
                EXPECT_LT(product, squared * (1 - 1e-6));
            }
        }
    }
}

TEST_P(DualOf, hasTheBaseAsItsDual) {
    const PolytopeDesign twice = support::designFor(std::string("dual of dual of ") + GetParam());
    EXPECT_EQ(twice.name, support::designFor(GetParam()).name);
}

INSTANTIATE_TEST_SUITE_P(Uniform, DualOf,
                         testing::Values("rectified 5-cell", "truncated tesseract", "bitruncated 16-cell",
                                         "omnitruncated 5-cell", "rectified 24-cell", "snub 24-cell", "grand antiprism",
                                         "5,7-duoprism", "3,3-duoprism", "truncated cubic prism",
                                         "pentagonal antiprism prism", "rectified 600-cell", "cyclic polytope C(9,4)"));

TEST(Dual, ofTheDualIsThePolytopeItself) {
    // The dual of a built dual, computed by reciprocating once more, has the vertices of the original polytope.
    const Polytope base = build(support::designFor("truncated tesseract"));
    const Polytope dual = build(support::designFor("dual of truncated tesseract"));
    std::vector<glm::dvec4> again;
    const double squared = glm::dot(dual.vertices[0], base.vertices[base.faces[base.cells[0][0]][0]]);
    for (std::size_t c = 0; c < dual.cells.size(); ++c) again.push_back(base.vertices[c]);
    for (std::size_t c = 0; c < dual.cells.size(); ++c) {
        for (const auto f : dual.cells[c]) {
            for (const auto v : dual.faces[f]) {
                EXPECT_NEAR(glm::dot(dual.vertices[v], again[c]), squared, 1e-9 * squared);
            }
        }
    }
    support::expectSamePoints(again, base.vertices, 1e-12);
}

TEST(Dual, ofARegularPolytopeIsRegular) {
    for (const auto& [name, dual] : {std::pair{"5-cell", "5-cell"},
                                     {"8-cell", "16-cell"},
                                     {"16-cell", "8-cell"},
                                     {"24-cell", "24-cell"},
                                     {"120-cell", "600-cell"},
                                     {"hexacosichoron", "120-cell"},
                                     {"{5,5/2,5}", "great 120-cell"}}) {
        EXPECT_EQ(support::designFor(std::string("dual of ") + name).name, support::designFor(dual).name) << name;
    }
    EXPECT_EQ(support::designFor("Dual  Rectified 5-cell").name, "dual of rectified 5-cell");
    EXPECT_EQ(findEntry("dual of 8-cell")->name, "16-cell");
}

TEST(Dual, ofSomethingUnknownIsUnknown) {
    const auto unknown = designNamed("dual of teapot", 100'000);
    ASSERT_TRUE(std::holds_alternative<PolytopeNameError>(unknown));
    EXPECT_EQ(std::get<PolytopeNameError>(unknown).message, "'teapot' is not the name of a polytope");
    EXPECT_TRUE(std::holds_alternative<PolytopeNameError>(designNamed("dual of", 100'000)));
    EXPECT_TRUE(std::holds_alternative<PolytopeNameError>(designNamed("dual", 100'000)));
    const auto large = designNamed("dual of 400,400-duoprism", 100'000);
    ASSERT_TRUE(std::holds_alternative<PolytopeNameError>(large));
    EXPECT_EQ(std::get<PolytopeNameError>(large).reason, PolytopeNameError::Reason::too_large);
}

}  // namespace
}  // namespace oval4d::polytopes
