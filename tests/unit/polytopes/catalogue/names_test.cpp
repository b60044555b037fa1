// Tests of the list of notations: polytopes are built for its examples, and its texts are compared with the
// specification.

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "polytopes/catalogue/catalogue.hpp"
#include "polytopes/catalogue/names.hpp"
#include "polytopes/construction/design.hpp"
#include "polytopes/construction/notations.hpp"
#include "polytopes/polytope.hpp"
#include "text/words.hpp"
#include "unit/polytopes/support.hpp"

namespace oval4d::polytopes {
namespace {

// Returns the names in backquotes in `notation.examples`.
std::vector<std::string> examplesOf(const PolytopeNotation& notation) {
    std::vector<std::string> examples;
    std::string_view rest = notation.examples;
    for (std::size_t begin = rest.find('`'); begin != std::string_view::npos; begin = rest.find('`')) {
        rest.remove_prefix(begin + 1);
        const std::size_t end = std::min(rest.find('`'), rest.size());
        examples.emplace_back(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return examples;
}

TEST(Notations, parseTheirExamples) {
    const DesignLookup lookup = [](std::string_view name) { return designNamed(name, 100'000); };
    for (const PolytopeNotation* notation : kNotations) {
        ASSERT_TRUE(notation->parse != nullptr);
        EXPECT_FALSE(examplesOf(*notation).empty()) << notation->polytopes;
        for (const std::string& example : examplesOf(*notation)) {
            SCOPED_TRACE(example);
            const std::vector<std::string> words = text::lowerCaseWords(example);
            const auto parsed = notation->parse({words, lookup});
            ASSERT_TRUE(parsed && std::holds_alternative<PolytopeDesign>(*parsed));
            const std::string& name = std::get<PolytopeDesign>(*parsed).name;
            EXPECT_EQ(name, support::designFor(example).name) << "an earlier notation fits, too";
            EXPECT_EQ(name, support::designFor(name).name)
                << "stored sessions could not build the polytope by its name";
        }
    }
}

TEST(Notations, haveExamplesWithTheStatedElements) {
    for (const PolytopeNotation* notation : kNotations) {
        for (const std::string& example : examplesOf(*notation)) {
            SCOPED_TRACE(example);
            const PolytopeDesign design = support::designFor(example);
            const Polytope p = build(design);
            const ElementCounts found{p.vertices.size(), p.edges.size(), p.faces.size(), p.cells.size()};
            // If the polytope is built as a convex hull, elementCounts() returns only an estimate.
            if (design.recipe->hullPointCount() == 0) {
                EXPECT_EQ(elementCounts(design), found);
            }
            // Euler's formula V − E + F − C = 0 may not hold for star polytopes, whose cells may have handles.
            if (p.convex) {
                EXPECT_EQ(found.vertices + found.faces, found.edges + found.cells);
            }
            if (notation->edges != "2") continue;
            for (const auto& [a, b] : p.edges)
                ASSERT_NEAR(glm::distance(p.vertices[a], p.vertices[b]), 2, 1e-9 * p.circumradius);
        }
    }
}

TEST(Notations, areInTheSpecification) {
    std::ifstream in(std::string(OVAL4D_SOURCE_DIR) + "/protocol/README.md");
    const std::string specification((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    for (const PolytopeNotation* notation : kNotations) {
        const std::string row = "| " + std::string(notation->polytopes) + " | " + std::string(notation->examples) +
                                " | " + std::string(notation->edges) + " |\n";
        EXPECT_NE(specification.find(row), std::string::npos) << row << "run tests/lint --fix";
    }
}

TEST(Constructions, areCounted) {
    std::size_t count = 0;
    for (const PolytopeNotation* notation : kNotations) {
        for (const std::string_view word : text::splitAtCommas(notation->constructions)) {
            std::string name = "5-cell";
            for (std::size_t i = 0; i <= kMaxConstructions; ++i) name = std::string(word) + " of " + name;
            const auto named = designNamed(name, 100'000);
            ASSERT_TRUE(std::holds_alternative<PolytopeNameError>(named)) << name;
            EXPECT_EQ(std::get<PolytopeNameError>(named).message, "the name has 9 constructions; at most 8 are allowed")
                << name;
            ++count;
        }
    }
    EXPECT_GE(count, 9U);
}

TEST(Constructions, areListedForOneThatIsUnknown) {
    const auto named = designNamed("piramid of cube", 100'000);
    ASSERT_TRUE(std::holds_alternative<PolytopeNameError>(named));
    EXPECT_EQ(std::get<PolytopeNameError>(named).message,
              "'piramid' is not a construction (did you mean 'pyramid'?); there are dual, prism, pyramid, bipyramid, "
              "truncation, rectification, product, hull, intersection");
}

TEST(Constructions, takeACircumradiusOnlyWithinHullsAndIntersections) {
    for (const char* name :
         {"prism of circumradius 3", "prism of cube of circumradius 3", "tesseract of circumradius 3",
          "dual of rectified 5-cell of circumradius 3", "product of 5-gon and 7-gon of circumradius 3",
          "hull of tesseract and 16-cell of circumradius 2 of circumradius 3"}) {
        const auto named = designNamed(name, 100'000);
        ASSERT_TRUE(std::holds_alternative<PolytopeNameError>(named)) << name;
        EXPECT_EQ(std::get<PolytopeNameError>(named).message,
                  "'of circumradius' and a number may follow only a polytope of a hull or an intersection, as in hull "
                  "of tesseract and 16-cell of circumradius 3")
            << name;
    }
    for (const char* name : {"hull of prism of cuboctahedron of circumradius 3 and tesseract",
                             "dual of intersection of pyramid of cube and 5,7-duoprism of circumradius 2.5"})
        EXPECT_TRUE(std::holds_alternative<PolytopeDesign>(designNamed(name, 100'000))) << name;
}

TEST(Duoprisms, areNamedAfterTwoPolygons) {
    for (const char* text : {"6,8-duoprism", "6x8 duoprism", "6×8-duoprism", "6, 8 duoprism", "8-6 duoprism",
                             "hexagonal-octagonal duoprism", "6-gonal 8-gonal duoprism"})
        EXPECT_EQ(support::designFor(text).name, "6,8-duoprism") << text;
    for (const char* text : {"hexagonal duoprism", "hexagon duoprism", "6 duoprism"})
        EXPECT_EQ(support::designFor(text).name, "6,6-duoprism") << text;
}

}  // namespace
}  // namespace oval4d::polytopes
