// Tests of Coxeter–Dynkin diagrams, and of the names and notations of polytopes.

#include <array>
#include <string>

#include <gtest/gtest.h>

#include "polytopes/catalogue/catalogue.hpp"
#include "polytopes/catalogue/names.hpp"
#include "polytopes/construction/coxeter.hpp"
#include "polytopes/construction/diagram.hpp"
#include "polytopes/construction/diagram_text.hpp"
#include "unit/polytopes/support.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::polytopes;

CoxeterDiagram diagram(std::string_view symbol) { return std::get<CoxeterDiagram>(parseDiagram(symbol)); }

/// Returns the error message for a text that names no polytope. For other texts, returns "none: " and the polytope's
/// name.
std::string errorFor(std::string_view text, std::size_t maxVertices = 100'000) {
    const auto named = designNamed(text, maxVertices);
    const auto* error = std::get_if<PolytopeNameError>(&named);
    return error == nullptr ? "none: " + std::get<PolytopeDesign>(named).name : error->message;
}

std::string nameOf(std::string_view text) {
    const auto named = designNamed(text, 100'000);
    const auto* design = std::get_if<PolytopeDesign>(&named);
    return design == nullptr ? "error: " + std::get<PolytopeNameError>(named).message : design->name;
}

TEST(Symbols, roundTrip) {
    for (const char* symbol : {"x5o3o3x", "x5/2o5o3o", "x3o3o *b3o", "x5o x7o", "o4x3x x", "x x x x", "x5/2o x7/3o"})
        EXPECT_EQ(linearNotationOf(diagram(symbol)), symbol);
    EXPECT_EQ(linearNotationOf(diagram("  x4o3o   x")), "x4o3o x");
    EXPECT_EQ(linearNotationOf(diagram("x4o3o2x")), "x4o3o x");
    EXPECT_EQ(diagram("x3o3o*b3o"), diagram("x3o3o *b3o"));
}

TEST(Symbols, agreeWithSchlaefliSymbols) {
    for (const auto& [schlaefli, symbol] : {std::pair{"{3,3,5}", "x3o3o5o"},
                                            {"t0,1{4,3,3}", "x4x3o3o"},
                                            {"t0,1,2,3{5,3,3}", "x5x3x3x"},
                                            {"r{3,4,3}", "o3x4o3o"},
                                            {"2t{3,3,3}", "o3x3x3o"},
                                            {"{5/2,5,5/2}", "x5/2o5o5/2o"},
                                            {"{5}×{7}", "x5o x7o"},
                                            {"tr{4,3}x{}", "x4x3x x"}}) {
        const auto read = parseSchlaefli(schlaefli);
        ASSERT_TRUE(std::holds_alternative<CoxeterDiagram>(read))
            << schlaefli << std::get<PolytopeNameError>(read).message;
        EXPECT_EQ(linearNotationOf(std::get<CoxeterDiagram>(read)), symbol);
    }
    EXPECT_EQ(schlaefliOf(diagram("x5x3o3x")), "t0,1,3{5,3,3}");
    EXPECT_EQ(schlaefliOf(diagram("x4x3o x")), "t0,1{4,3}×{}");
    EXPECT_EQ(schlaefliOf(diagram("x3o3o *b3o")), "");
}

TEST(Groups, haveTheKnownOrders) {
    const auto order = [](const char* symbol) { return groupOrder(diagram(symbol)); };
    EXPECT_EQ(order("x3o3o3o"), 120U);
    EXPECT_EQ(order("x4o3o3o"), 384U);
    EXPECT_EQ(order("o3o3o4x"), 384U);
    EXPECT_EQ(order("x3o3o *b3o"), 192U);
    EXPECT_EQ(order("x3o4o3o"), 1152U);
    EXPECT_EQ(order("x5o3o3o"), 14400U);
    EXPECT_EQ(order("x5/2o5o5/2o"), 14400U);
    EXPECT_EQ(order("x5o x7o"), 140U);
    EXPECT_EQ(order("x5o3o x"), 240U);
    EXPECT_EQ(automorphismsOf(diagram("x3o3o3x")).size(), 2U);
    EXPECT_EQ(automorphismsOf(diagram("x3o3o3o")).size(), 1U);
    EXPECT_EQ(automorphismsOf(diagram("o3x3o *b3o")).size(), 6U);
    EXPECT_EQ(automorphismsOf(diagram("x5o x5o")).size(), 2U);
}

// The computed numbers of elements agree with the built polytopes for all diagrams of the groups of the regular
// polychora and of D4.
TEST(Counts, agreeWithTheBuiltPolytopes) {
    for (const char* group : {"o3o3o3o", "o4o3o3o", "o3o4o3o", "o5o3o3o", "o3o3o *b3o"}) {
        for (unsigned rings = 1; rings < 16; ++rings) {
            std::string symbol(group);
            unsigned node = 0;
            for (char& c : symbol) {
                if (c == 'o' && (rings >> node++ & 1U) != 0) c = 'x';
            }
            const CoxeterDiagram d = diagram(symbol);
            const Polytope p = wythoffConstruction(symbol, d, mirrorsOf(d));
            EXPECT_EQ((ElementCounts{p.vertices.size(), p.edges.size(), p.faces.size(), p.cells.size()}),
                      elementCounts(d))
                << symbol;
        }
    }
}

TEST(Counts, ofTheOmnitruncated120CellAreKnown) {
    EXPECT_EQ(elementCounts(diagram("x5x3x3x")), (ElementCounts{14400, 28800, 17040, 2640}));
}

TEST(Names, ofTheSamePolytopeLeadToOneDesign) {
    EXPECT_EQ(nameOf("o5o3o3x"), "600-cell");
    EXPECT_EQ(nameOf("x3o3o4o"), "16-cell");
    EXPECT_EQ(nameOf("O3X3O *B3O"), "24-cell");
    EXPECT_EQ(nameOf("o3o3x4x"), "truncated tesseract");
    EXPECT_EQ(nameOf("tat"), "truncated tesseract");
    EXPECT_EQ(nameOf("Truncated_Octachoron"), "truncated tesseract");
    EXPECT_EQ(nameOf("truncated hypercube"), "truncated tesseract");
    EXPECT_EQ(nameOf("birectified 16-cell"), "rectified tesseract");
    EXPECT_EQ(nameOf("cantellated 16 cell"), "rectified 24-cell");
    EXPECT_EQ(nameOf("runcicantellated tesseract"), "runcitruncated 16-cell");
    EXPECT_EQ(nameOf("Omnitruncated hecatonicosachoron"), "omnitruncated 120-cell");
    EXPECT_EQ(nameOf("omnitruncated 600-cell"), "omnitruncated 120-cell");
    EXPECT_EQ(nameOf("t0,1{3,3,5}"), "truncated 600-cell");
    EXPECT_EQ(nameOf("{5,5/2,5}"), "great 120-cell");
    EXPECT_EQ(nameOf("s{3,4,3}"), "snub 24-cell");
    EXPECT_EQ(nameOf("s3s4o3o"), "snub 24-cell");
    for (const char* text : {"5,7-duoprism", "7,5-duoprism", "5-7 duoprism", "5x7 duoprism", "5×7-duoprism", "x5o x7o",
                             "x7o x5o", "{7}×{5}", "pentagonal-heptagonal duoprism", "5, 7 duoprism"})
        EXPECT_EQ(nameOf(text), "5,7-duoprism") << text;
    EXPECT_EQ(nameOf("hexagonal duoprism"), "6,6-duoprism");
    EXPECT_EQ(nameOf("x3x x7o"), "6,7-duoprism");
    EXPECT_EQ(nameOf("x x x9o"), "4,9-duoprism");
    EXPECT_EQ(nameOf("enneagonal prism prism"), "4,9-duoprism");
    EXPECT_EQ(nameOf("9-gonal prismatic prism"), "4,9-duoprism");
    EXPECT_EQ(nameOf("4,4-duoprism"), "8-cell");
    EXPECT_EQ(nameOf("cube prism"), "8-cell");
    EXPECT_EQ(nameOf("17-gonal antiprism prism"), "17-gonal antiprism prism");
    EXPECT_EQ(nameOf("17 antiprism prism"), "17-gonal antiprism prism");
    EXPECT_EQ(nameOf("s2s17s x"), "17-gonal antiprism prism");
    EXPECT_EQ(nameOf("pentagonal antiprismatic prism"), "pentagonal antiprism prism");
    EXPECT_EQ(nameOf("triangular antiprism prism"), "octahedral prism");
    EXPECT_EQ(nameOf("snub cube prism"), "snub cubic prism");
    EXPECT_EQ(nameOf("s4s3s x"), "snub cubic prism");
    EXPECT_EQ(nameOf("x s5s3s"), "snub dodecahedral prism");
    EXPECT_EQ(nameOf("x3o3x x"), "cuboctahedral prism");
    EXPECT_EQ(nameOf("gidpixhi"), "omnitruncated 120-cell");
}

TEST(Names, ofNoPolytopeGiveAnError) {
    EXPECT_NE(errorFor("x5o3o").find("four nodes"), std::string::npos);
    EXPECT_NE(errorFor("x5o3o3o3o").find("four nodes"), std::string::npos);
    EXPECT_NE(errorFor("o5o3o3o").find("ringed"), std::string::npos);
    EXPECT_NE(errorFor("x5o o7o").find("ringed"), std::string::npos);
    EXPECT_NE(errorFor("x6o3o3o").find("finite"), std::string::npos);
    EXPECT_NE(errorFor("x3o4o *b3o").find("finite"), std::string::npos);
    EXPECT_NE(errorFor("x5/0o3o3o").find("5/2"), std::string::npos);
    EXPECT_NE(errorFor("x4/2o3o3o").find("lowest terms"), std::string::npos);
    EXPECT_NE(errorFor("x99999999999o3o3o").find("whole number"), std::string::npos);
    EXPECT_NE(errorFor("x3o3o *d3o").find("letter"), std::string::npos);
    EXPECT_NE(errorFor("x3o3o *bo").find("whole number"), std::string::npos);
    EXPECT_NE(errorFor("xo3o3o").find("separated by a branch number"), std::string::npos);
    EXPECT_NE(errorFor("x5/2x5o3o").find("cover themselves twice"), std::string::npos);
    EXPECT_NE(errorFor("{5,3").find("whole number"), std::string::npos);
    EXPECT_NE(errorFor("{5,3,3}}").find("may be followed only by"), std::string::npos);
    EXPECT_NE(errorFor("t0,4{3,3,3}").find("Schläfli"), std::string::npos);
    EXPECT_NE(errorFor("t3{3,3}x{}").find("numbers before {"), std::string::npos);
    EXPECT_NE(errorFor("2,5-duoprism").find("at least three sides"), std::string::npos);
    EXPECT_NE(errorFor("3,4,5-duoprism").find("at least three sides"), std::string::npos);
    EXPECT_NE(errorFor("6/2,5-duoprism").find("at least three sides"), std::string::npos);
    EXPECT_NE(errorFor("5/2 antiprism prism").find("be no star"), std::string::npos);
    EXPECT_EQ(errorFor("1000,1000-duoprism"),
              "the 1000,1000-duoprism has 1000000 vertices; at most 100000 are allowed");
    EXPECT_EQ(errorFor("5,7-duoprism", 30), "none: 5,7-duoprism");  // polytopes in the catalogue are not limited
    EXPECT_EQ(errorFor("7,9-duoprism", 62), "the 7,9-duoprism has 63 vertices; at most 62 are allowed");
    for (const char* text : {"", " ", "-", "25-cell", "prism", "duo prism", "truncated", "truncated cat", "x",
                             "banana prism", "s", "sxs", "{", "omnitruncated cube"}) {
        const auto named = designNamed(text, 1000);
        ASSERT_TRUE(std::holds_alternative<PolytopeNameError>(named)) << text;
    }
}

TEST(Names, ofAnyLengthAndWithAnyNumbersGiveAnError) {
    for (const int nodes : {5, 32, 33, 64, 1000}) {
        std::string numbers = "3";
        std::string nodesOfDiagram = "x3o";
        for (int i = 2; i < nodes; ++i) {
            numbers += ",3";
            nodesOfDiagram += "3o";
        }
        const std::string expected =
            "the diagram of a polychoron has four nodes, as in x5o3o3x, not " + std::to_string(nodes);
        for (const char* prefix : {"", "r", "t", "2tr", "t0,3"})
            EXPECT_EQ(std::get<PolytopeNameError>(parseSchlaefli(prefix + ("{" + numbers) + "}")).message, expected);
        EXPECT_EQ(std::get<PolytopeNameError>(parseDiagram(nodesOfDiagram)).message, expected);
    }
    for (const char* text : {"{0,3,3}", "{1,3,3}", "{-3,3,3}", "{3/0,3,3}", "{3/-2,3,3}", "{1000001,3,3}",
                             "{4294967299,3,3}", "{18446744073709551619,3,3}", "{3,3,1000000/3}", "{5/4,3,3}",
                             "{1000000,3,3}", "{1000000,1000000,1000000}", "t0,1,0,1,0,1,0,1,4{3,3,3}", "t{}", "{3}×"})
        EXPECT_TRUE(std::holds_alternative<PolytopeNameError>(parseSchlaefli(text))) << text;
    EXPECT_EQ(errorFor("1000000,1000000-duoprism"),
              "the 1000000,1000000-duoprism has 1000000000000 vertices; at most 100000 are allowed");
    EXPECT_EQ(errorFor("1000000,1000000-duoantiprism"),
              "the 1000000,1000000-duoantiprism has 2000000000000 vertices; at most 100000 are allowed");
}

TEST(Names, ofAnyTextAreParsedSafely) {
    // Parsing any sequence of four of these pieces neither crashes nor throws.
    const auto pieces =
        std::to_array<std::string_view>({"x", "o", "s", "3", "5/2", "*b", "{", "}", ",", " ", "×", "t", "duoprism",
                                         "prism", "antiprism", "truncated", "24-cell", "\xff"});
    for (const auto a : pieces) {
        for (const auto b : pieces) {
            for (const auto c : pieces) {
                for (const auto d : pieces) {
                    const std::string text = std::string(a) + std::string(b) + std::string(c) + std::string(d);
                    (void)designNamed(text, 1000);
                    (void)designNamed("5 " + text + " prism", 1000);
                }
            }
        }
    }
}

TEST(Designs, outsideTheCatalogueAreBuiltAndShared) {
    const auto built = [](std::string_view text) {
        return support::cache().findOrBuild(std::get<PolytopeDesign>(designNamed(text, 100'000)));
    };
    const auto twenty = built("20,30-duoprism");
    EXPECT_EQ(twenty->vertices.size(), 600U);
    EXPECT_EQ(twenty->cells.size(), 50U);
    EXPECT_EQ(built("20,30-duoprism"), twenty);  // the same object: the cache returns it for all names of the polytope
    EXPECT_EQ(built("x30o x20o"), twenty);
    const auto antiprism = built("100-gonal antiprism prism");
    EXPECT_EQ(antiprism->vertices.size(), 400U);
    EXPECT_EQ(antiprism->cells.size(), 204U);
    EXPECT_EQ(built("1000,3-duoprism")->faces.size(), 4003U);
}

}  // namespace
