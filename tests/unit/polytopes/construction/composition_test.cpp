// Tests of polytopes that names compose from others: over polyhedra, with vertices cut off, products, hulls and
// intersections.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "polytopes/catalogue/catalogue.hpp"
#include "polytopes/construction/convex_hull.hpp"
#include "polytopes/construction/design.hpp"
#include "polytopes/construction/solids.hpp"
#include "polytopes/polytope.hpp"
#include "sanitizers/sanitized.hpp"
#include "text/words.hpp"
#include "unit/polytopes/support.hpp"

namespace oval4d::polytopes {
namespace {

using FVector = std::array<std::size_t, 4>;

Polytope built(const std::string& name) { return build(support::designFor(name)); }

PolytopeNameError errorOf(const std::string& name) {
    const auto named = designNamed(name, 100'000);
    if (std::holds_alternative<PolytopeDesign>(named)) throw std::runtime_error(name + " names a polytope");
    return std::get<PolytopeNameError>(named);
}

FVector fVector(const Polytope& p) { return {p.vertices.size(), p.edges.size(), p.faces.size(), p.cells.size()}; }

// Returns the hypervolume of the polytope by the divergence theorem. The result is the sum of the signed hypervolumes
// of simplices with a corner at the origin, one for each triangle of a 2-face and a vertex of its cell.
double hypervolume(const Polytope& p) {
    double sum = 0;
    for (std::uint32_t c = 0; c < p.cells.size(); ++c) {
        const glm::dvec4 apex = p.vertices[p.faces[p.cells[c][0]][0]];
        for (std::uint32_t i = p.cells.begin[c]; i < p.cells.begin[c + 1]; ++i) {
            const auto loop = p.faces[p.cells.items[i]];
            for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
                sum -= p.cellSigns[i] * glm::determinant(glm::dmat4(apex, p.vertices[loop[0]], p.vertices[loop[k]],
                                                                    p.vertices[loop[k + 1]]));
            }
        }
    }
    return sum / 24;
}

// Expects that the polytope is convex and has the Euler characteristic 0. Expects that the mean of its vertices is the
// origin, unless the polytope is a dual.
void expectSound(const Polytope& p) {
    const auto [v, e, f, c] = fVector(p);
    EXPECT_EQ(v + f, e + c) << p.name;
    EXPECT_TRUE(p.convex) << p.name;
    EXPECT_GT(hypervolume(p), 0) << p.name;
    if (p.name.starts_with("dual of")) return;
    glm::dvec4 mean(0);
    for (const glm::dvec4& x : p.vertices) mean += x / static_cast<double>(v);
    EXPECT_LT(glm::length(mean), 1e-9 * p.circumradius) << p.name;
}

// Expects that both lists have the same points after the points of the second list are multiplied by `scale`.
void expectScaledPoints(const std::vector<glm::dvec4>& one, std::vector<glm::dvec4> other, double scale) {
    for (glm::dvec4& p : other) p *= scale;
    double size = 0;
    for (const glm::dvec4& p : one) size = std::max(size, glm::length(p));
    support::expectSamePoints(one, other, 1e-9 * size);
}

std::map<std::string, std::uint32_t> cellsByName(const Polytope& p) {
    std::map<std::string, std::uint32_t> cells;
    for (const CellType& type : p.cellTypes) cells[type.name] += type.cells;
    return cells;
}

// --- Tests of prisms, pyramids and bipyramids over polyhedra

class OverPolyhedra : public testing::TestWithParam<const char*> {};

TEST_P(OverPolyhedra, haveTheElementsThatTheBaseImplies) {
    const std::string base = GetParam();
    const auto solid = std::get<SolidDescription>(*solidNamed(text::lowerCaseWords(base)));
    const SolidMesh mesh = meshOf(solid);
    const std::size_t v = mesh.vertices.size(), f = mesh.faces.size(), e = v + f - 2;
    const auto stated = countsOf(solid);
    EXPECT_EQ((std::array{stated.vertices, stated.edges, stated.faces}), (std::array<std::uint64_t, 3>{v, e, f}));
    const auto prism = built("prism of " + base);
    const auto pyramid = built("pyramid of " + base);
    const auto bipyramid = built("bipyramid of " + base);
    EXPECT_EQ(fVector(prism), (FVector{2 * v, 2 * e + v, 2 * f + e, f + 2}));
    EXPECT_EQ(fVector(pyramid), (FVector{v + 1, e + v, f + e, f + 1}));
    EXPECT_EQ(fVector(bipyramid), (FVector{v + 2, e + 2 * v, f + 2 * e, 2 * f}));
    for (const Polytope* p : {&prism, &pyramid, &bipyramid}) {
        expectSound(*p);
        const ElementCounts counts = elementCounts(support::designFor(p->name));
        EXPECT_EQ((FVector{counts.vertices, counts.edges, counts.faces, counts.cells}), fVector(*p));
    }
    // The volume V follows from the volume B of the base and the height h: V = 2 B for a prism, B h / 4 for a pyramid,
    // and twice that for a bipyramid.
    double radius = 0;
    for (const auto& x : mesh.vertices) radius = std::max(radius, glm::length(x));
    const double height = !solid.dual && radius < 2 - 1e-9 ? std::sqrt(4 - radius * radius) : radius;
    const double area = hypervolume(prism) / 2;
    EXPECT_NEAR(hypervolume(pyramid), area * height / 4, 1e-9 * area);
    EXPECT_NEAR(hypervolume(bipyramid), area * height / 2, 1e-9 * area);
    if (solid.dual || radius >= 2 - 1e-9) return;
    for (const Polytope* p : {&prism, &pyramid, &bipyramid}) {
        for (const auto& [a, b] : p->edges) EXPECT_NEAR(glm::distance(p->vertices[a], p->vertices[b]), 2, 1e-9);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Solids, OverPolyhedra,
    testing::Values("tetrahedron", "cube", "octahedron", "dodecahedron", "icosahedron", "truncated tetrahedron",
                    "cuboctahedron", "truncated cube", "truncated octahedron", "rhombicuboctahedron",
                    "truncated cuboctahedron", "snub cube", "icosidodecahedron", "truncated dodecahedron",
                    "truncated icosahedron", "rhombicosidodecahedron", "truncated icosidodecahedron",
                    "snub dodecahedron", "triangular prism", "pentagonal prism", "6-gonal prism", "17 gonal prism",
                    "square antiprism", "9-gonal antiprism", "triakis tetrahedron", "rhombic dodecahedron",
                    "triakis octahedron", "tetrakis hexahedron", "deltoidal icositetrahedron", "disdyakis dodecahedron",
                    "pentagonal icositetrahedron", "rhombic triacontahedron", "triakis icosahedron",
                    "pentakis dodecahedron", "deltoidal hexecontahedron", "disdyakis triacontahedron",
                    "pentagonal hexecontahedron", "dual of hexagonal prism", "triangular bipyramid",
                    "square trapezohedron", "dual of snub cube"));

TEST(OverPolyhedra, haveOneDesignForEachPolytope) {
    for (const auto& [name, same] : {std::pair{"prism of cube", "8-cell"},
                                     {"prism of 4-gonal prism", "8-cell"},
                                     {"product of cube and segment", "8-cell"},
                                     {"product of segment and snub cube", "snub cubic prism"},
                                     {"prism of snub cube", "snub cubic prism"},
                                     {"prism of pentagonal prism", "4,5-duoprism"},
                                     {"prism of 5-gonal antiprism", "pentagonal antiprism prism"},
                                     {"pyramid of tetrahedron", "5-cell"},
                                     {"bipyramid of octahedron", "16-cell"},
                                     {"bipyramid of triangular antiprism", "16-cell"},
                                     {"bipyramid of dual of cube", "16-cell"},
                                     {"pyramid of dual of dodecahedron", "pyramid of icosahedron"},
                                     {"pyramid of dual of dual of snub cube", "pyramid of snub cube"},
                                     {"pyramid of dual of 7-gonal prism", "pyramid of heptagonal bipyramid"},
                                     {"PYRAMID of  Dual of cuboctahedron", "pyramid of rhombic dodecahedron"},
                                     {"product of 7-gon and pentagon", "5,7-duoprism"},
                                     {"product of square and 4-gon", "8-cell"},
                                     {"product of 5/2-gon and 5-gon", "5,5/2-duoprism"}}) {
        EXPECT_EQ(support::designFor(name).name, same) << name;
    }
}

// A pyramid, prism or bipyramid has the hypervolume that the base and the height imply, even if it is a polytope with a
// name of its own.
TEST(OverPolyhedra, ofSimplicesAreRegular) {
    const Polytope bipyramid = built("bipyramid of dual of hexagonal prism");
    EXPECT_EQ(fVector(bipyramid), (FVector{10, 18 + 16, 12 + 36, 24}));
    const double tetrahedron = std::sqrt(8.0 / 9) * 3;  // the volume of the tetrahedron of edge 2
    EXPECT_NEAR(hypervolume(built("pyramid of tetrahedron")), std::sqrt(5.0) / 96 * 16, 1e-12);
    EXPECT_NEAR(hypervolume(built("prism of tetrahedron")), 2 * tetrahedron / 3, 1e-12);
    EXPECT_NEAR(hypervolume(built("pyramid of cube")), 8 * 1.0 / 4, 1e-12);
}

TEST(OverPolyhedra, haveCellsWithNames) {
    using Cells = std::map<std::string, std::uint32_t>;
    EXPECT_EQ(cellsByName(built("pyramid of cube")), (Cells{{"cube", 1}, {"square pyramid", 6}}));
    EXPECT_EQ(cellsByName(built("bipyramid of cube")), (Cells{{"square pyramid", 12}}));
    EXPECT_EQ(cellsByName(built("pyramid of 7-gonal prism")),
              (Cells{{"heptagonal prism", 1}, {"square pyramid", 7}, {"heptagonal pyramid", 2}}));
    EXPECT_EQ(cellsByName(built("prism of rhombic dodecahedron")),
              (Cells{{"rhombic dodecahedron", 2}, {"rhombic prism", 12}}));
    EXPECT_EQ(cellsByName(built("pyramid of heptagonal bipyramid")),
              (Cells{{"heptagonal bipyramid", 1}, {"tetrahedron", 14}}));
    EXPECT_EQ(cellsByName(built("prism of pentagonal trapezohedron")),
              (Cells{{"pentagonal trapezohedron", 2}, {"quadrilateral prism", 10}}));
    EXPECT_EQ(cellsByName(built("5,7-duoprism")), (Cells{{"heptagonal prism", 5}, {"pentagonal prism", 7}}));
    EXPECT_EQ(cellsByName(built("dual of rectified tesseract")), (Cells{{"triangular bipyramid", 32}}));
    for (const NamedPolyhedron& each : namedPolyhedra()) {
        if (!isConvex(each)) continue;
        const std::string dual = nameOf(SolidDescription{&each, 0, false, true});
        EXPECT_EQ(cellsByName(built("prism of " + dual))[dual], dual == "cube" ? 8U : 2U) << dual;
    }
}

// --- Tests of truncations, rectifications, hulls and intersections

TEST(TruncationsAndRectifications, ofRegularPolytopesAreUniform) {
    EXPECT_EQ(support::designFor("rectification of 16-cell").name, "24-cell");
    EXPECT_EQ(support::designFor("rectification of 120-cell").name, "rectified 120-cell");
    EXPECT_EQ(support::designFor("truncation of 600-cell").name, "truncated 600-cell");
    EXPECT_EQ(support::designFor("truncation of tesseract").name, "truncation of 8-cell")
        << "its squares are cut at thirds";
}

// A polytope that is regular, but has no name of its own, is truncated or rectified by a convex hull. The result agrees
// with the uniform polytope.
TEST(TruncationsAndRectifications, areTheHullsOfPointsOnEdges) {
    const std::string cell24 = "hull of tesseract and 16-cell";
    for (const auto& [cut, uniform, ratio] :
         {std::tuple{"rectification of ", "rectified 24-cell", 1.0}, {"truncation of ", "truncated 24-cell", 1.0}}) {
        const Polytope own = built(cut + cell24);
        const Polytope known = built(uniform);
        EXPECT_EQ(fVector(own), fVector(known));
        EXPECT_EQ(cellsByName(own), cellsByName(known));
        expectSound(own);
    }
    // The truncation cuts the edges of the tesseract at their thirds: it removes a simplex with legs of 2/3 at each of
    // the 16 vertices.
    const Polytope tesseract = built("truncation of tesseract");
    EXPECT_EQ(fVector(tesseract), fVector(built("truncated tesseract")));
    EXPECT_NEAR(hypervolume(tesseract), 16 - 16 * std::pow(2.0 / 3, 4) / 24, 1e-12);
    EXPECT_EQ(fVector(built("rectification of 5,7-duoprism")), (FVector{70, 210, 187, 47}));
}

TEST(Combinations, mayStateCircumradiiWithExponents) {
    EXPECT_EQ(support::designFor("hull of tesseract of circumradius 5e-1 and 16-cell of circumradius .2E1").name,
              "hull of 8-cell of circumradius 0.5 and 16-cell of circumradius 2");
}

TEST(Combinations, ofTheTesseractAndThe16CellAreThe24Cell) {
    for (const std::string name : {"hull of tesseract and 16-cell", "hull of tesseract and 16-cell of circumradius 2",
                                   "hull of 16-cell of circumradius 2 and 8-cell of circumradius 2",
                                   "intersection of tesseract and 16-cell", "intersection of 16-cell and tesseract",
                                   "intersection of tesseract and dual of tesseract of circumradius 2"}) {
        const Polytope p = built(name);
        EXPECT_EQ(fVector(p), (FVector{24, 96, 96, 24})) << name;
        EXPECT_EQ(cellsByName(p), (std::map<std::string, std::uint32_t>{{"octahedron", 24}})) << name;
        expectSound(p);
        if (name.starts_with("hull")) {
            expectScaledPoints(p.vertices, built("24-cell").vertices, 1);
        } else {  // the vertices are multiples of the permutations of (±1, ±1, 0, 0)
            const double one = p.circumradius / std::numbers::sqrt2;
            for (const glm::dvec4& v : p.vertices) {
                for (int i = 0; i < 4; ++i)
                    EXPECT_NEAR(std::min(std::abs(v[i]), std::abs(std::abs(v[i]) - one)), 0, 1e-12) << name;
            }
        }
    }
    EXPECT_NEAR(hypervolume(built("hull of tesseract and 16-cell")), 32, 1e-12);  // twice the hypervolume of the
                                                                                  // tesseract
}

// The intersection of a tesseract and a larger 16-cell, |x|∞ ≤ 1 and |x|₁ ≤ s, is the tesseract without its corners,
// whose hypervolumes are known.
TEST(Combinations, ofTheTesseractAndLarger16CellsAreItsTruncations) {
    for (const double s : {2.5, 3.0, 3.25, 3.5}) {
        const std::string name =
            "intersection of tesseract and 16-cell of circumradius " + std::string(s == 2.5    ? "2.5"
                                                                                   : s == 3    ? "3"
                                                                                   : s == 3.25 ? "3.25"
                                                                                               : "3.5");
        const Polytope p = built(name);
        // The corner of the unit cube with Σ (1 − x_i) < 4 − s is a simplex without four small simplices, by
        // inclusion–exclusion.
        const double t = 4 - s;
        const double missing = 16 * (std::pow(t, 4) - 4 * std::pow(std::max(t - 1, 0.0), 4)) / 24;
        EXPECT_NEAR(hypervolume(p), 16 - missing, 1e-12) << name;
        if (s > 3) {
            EXPECT_EQ(fVector(p), (FVector{64, 128, 88, 24})) << name;
        }
        if (s == 3) {
            EXPECT_EQ(fVector(p), fVector(built("rectified tesseract")));
        }
        if (s < 3) {
            EXPECT_EQ(fVector(p), fVector(built("bitruncated tesseract")));
        }
        expectSound(p);
    }
}

TEST(Combinations, areBetweenTheirParts) {
    for (const auto& [a, b] : {std::pair{"pyramid of cube", "600-cell"},
                               {"5,7-duoprism", "snub 24-cell"},
                               {"grand antiprism", "dual of grand antiprism"}}) {
        const Polytope first = built(a), hull = built(std::string("hull of ") + a + " and " + b),
                       common = built(std::string("intersection of ") + a + " and " + b);
        expectSound(hull);
        expectSound(common);
        EXPECT_GE(hypervolume(hull), hypervolume(first) * (1 - 1e-12));
        EXPECT_LE(hypervolume(common), hypervolume(first) * (1 + 1e-12));
    }
    // By polarity, the dual of a hull is the intersection of the duals. Both operands have the circumradius 2.
    EXPECT_EQ(fVector(built("dual of hull of 24-cell and 5,5-duoprism")).at(0),
              fVector(built("hull of 24-cell and 5,5-duoprism")).at(3));
}

// --- Tests of compositions of several constructions

TEST(Dual, ofAnyConvexPolytopeReversesTheElements) {
    for (const std::string name :
         {"pyramid of cube", "bipyramid of icosahedron", "prism of snub cube", "hull of tesseract and 5-cell",
          "rectification of 5,7-duoprism", "intersection of 24-cell and 5-cell", "truncation of tesseract"}) {
        const Polytope base = built(name), dual = built("dual of " + name);
        FVector reversed = fVector(base);
        std::ranges::reverse(reversed);
        EXPECT_EQ(fVector(dual), reversed) << name;
        expectSound(dual);
        EXPECT_EQ(support::designFor("dual of dual of " + name).name, support::designFor(name).name);
    }
}

// The dual of a dual has the vertices of the original polytope, even if the dual is a hull and no name says that it is
// a dual. The small simplex does not change the hull.
TEST(Dual, ofTheDualHasTheSameVertices) {
    for (const std::string name : {"bipyramid of cube", "truncation of tesseract", "prism of rhombic dodecahedron"}) {
        const std::string hidden = "hull of dual of " + name + " and 5-cell of circumradius 0.01";
        const Polytope base = built(name), twice = built("dual of " + hidden);
        EXPECT_EQ(fVector(twice), fVector(base)) << name;
        expectScaledPoints(twice.vertices, base.vertices, twice.circumradius / base.circumradius);
    }
}

class Grammar {
  public:
    explicit Grammar(unsigned seed) : random_(seed) {}

    std::string polytope(int depth) {
        static const std::vector<std::string> kLeaves{"5-cell",           "tesseract",      "16-cell",
                                                      "24-cell",          "snub 24-cell",   "3,5-duoprism",
                                                      "rectified 5-cell", "grand antiprism"};
        if (depth == 0) return pick(kLeaves);
        switch (random_() % 7) {
            case 0:
                return "dual of " + polytope(depth - 1);
            case 1:
                return pick({"prism of ", "pyramid of ", "bipyramid of "}) + solid(depth - 1);
            case 2:
                return "truncation of " + polytope(depth - 1);
            case 3:
                return "rectification of " + polytope(depth - 1);
            case 4:
                return "hull of " + polytope(depth / 2) + radius() + " and " + polytope(depth - 1 - depth / 2) +
                       radius();
            case 5:
                return "intersection of " + polytope(depth / 2) + radius() + " and " + polytope(depth - 1 - depth / 2) +
                       radius();
            default:
                return "product of " + std::to_string(3 + random_() % 5) + "-gon and " +
                       std::to_string(3 + random_() % 5) + "-gon";
        }
    }

  private:
    std::string pick(const std::vector<std::string>& from) { return from[random_() % from.size()]; }
    std::string radius() { return random_() % 3 == 0 ? " of circumradius 2.25" : ""; }
    std::string solid(int depth) {
        if (depth > 0 && random_() % 2 == 0) return "dual of " + solid(depth - 1);
        return pick({"cube", "tetrahedron", "truncated octahedron", "5-gonal prism", "square antiprism", "snub cube"});
    }

    std::mt19937 random_;
};

TEST(Compositions, ofRandomNamesAreSound) {
    int builtCount = 0;
    for (int seed = 0; seed < trials(120); ++seed) {
        Grammar grammar(static_cast<unsigned>(seed));
        const std::string name = grammar.polytope(1 + seed % 4);
        const auto named = designNamed(name, 100'000);
        if (const auto* error = std::get_if<PolytopeNameError>(&named)) {
            EXPECT_NE(error->reason, PolytopeNameError::Reason::unknown) << name << ": " << error->message;
            continue;
        }
        const PolytopeDesign& design = std::get<PolytopeDesign>(named);
        EXPECT_EQ(support::designFor(design.name).name, design.name) << "the name is that of the same design";
        if (elementCounts(design).vertices > 1500 || design.recipe->hullPointCount() > 3000) continue;
        try {
            const Polytope p = build(design);
            expectSound(p);
            EXPECT_TRUE(p.rebuildableFromName);
            const Polytope again = built(design.name);
            EXPECT_EQ(again.vertices, p.vertices) << name;
            EXPECT_EQ(again.faces.items, p.faces.items) << name;
            ++builtCount;
        } catch (const TooLarge&) {
        }
    }
    EXPECT_GT(builtCount, trials(120) * 2 / 3);
}

// --- Tests of mistakes in names, and of limits of size

TEST(Compositions, withMistakesAreExplained) {
    for (const auto& [name, part] : std::vector<std::pair<std::string, std::string>>{
             {"pyramid of teapot", "'teapot' is not the name of a polyhedron"},
             {"pyramid of tesseract", "Platonic or Archimedean solid"},
             {"bipyramid of great icosahedron", "is a star"},
             {"prism of 2-gonal prism", "at least three sides"},
             {"dual of cube", "the cube is a polyhedron"},
             {"hull of tesseract", "'and' must stand between two names"},
             {"hull of and tesseract", "'and' must stand"},
             {"hull of hull of tesseract and 16-cell", "'and' must stand"},
             {"intersection of tessaract and 16-cell",
              "'tessaract' is not the name of a polytope; did you mean 'tesseract'?"},
             {"hull of tesseract and 16-cell of circumradius 0", "from 0.01 to 100"},
             {"hull of tesseract and 16-cell of circumradius nan", "is not a circumradius"},
             {"hull of tesseract and 16-cell of circumradius 1e9", "is not a circumradius"},
             {"hull of tesseract and 16-cell of circumradius 1e-9", "'1e-9' is not a circumradius"},
             {"product of 5-gon and cube", "'cube' is not a polygon"},
             {"product of 2-gon and 5-gon", "at least three sides"},
             {"piramid of cube", "did you mean 'pyramid'?"},
             {"dual of dual of dual of dual of dual of dual of dual of dual of dual of 5-cell",
              "at most 8 are allowed"},
             {"product of segment and segment", "not the name of a polyhedron"}}) {
        EXPECT_NE(errorOf(name).message.find(part), std::string::npos) << name << ": " << errorOf(name).message;
    }
    EXPECT_EQ(support::designFor("dual of dual of dual of dual of dual of dual of dual of dual of snub 24-cell").name,
              "snub 24-cell");
    for (const char* const name : {"truncation of great 120-cell", "hull of tesseract and 5/2,5-duoprism",
                                   "intersection of {5,5/2,5} and tesseract"}) {
        try {
            (void)built(name);
            FAIL() << name;
        } catch (const std::invalid_argument& fault) {
            EXPECT_NE(std::string(fault.what()).find("is not convex"), std::string::npos) << fault.what();
        }
    }
}

TEST(Compositions, areLimitedInSize) {
    SKIP_IF_SANITIZED();
    for (const std::string name : {"pyramid of 100000-gonal prism", "truncation of omnitruncated 120-cell",
                                   "hull of omnitruncated 120-cell and omnitruncated 120-cell",
                                   "rectification of rectification of rectification of omnitruncated 24-cell"}) {
        EXPECT_EQ(errorOf(name).reason, PolytopeNameError::Reason::too_large) << name;
    }
    EXPECT_THROW((void)built("rectification of 3,1001-duoprism"), TooLarge);
    // The numbers of elements of this hull exceed a limit, which only building the hull can show.
    EXPECT_THROW((void)built("hull of dual of 90,110-duoprism of circumradius 2 and dual of 300,300-duoprism"),
                 TooLarge);
    std::string deep = "5-cell";
    for (int i = 0; i < 5000; ++i) deep = "hull of " + deep + " and 5-cell";
    EXPECT_NE(errorOf(deep).message.find("5000 constructions"), std::string::npos);
    EXPECT_EQ(errorOf(std::string(100'000, 'x')).message.find("bytes"), std::string::npos);
}

}  // namespace
}  // namespace oval4d::polytopes
