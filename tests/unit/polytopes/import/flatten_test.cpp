#include "polytopes/import/flatten.hpp"
#include "polytopes/import/simplex_division.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "polytopes/off.hpp"
#include "unit/polytopes/import/import_support.hpp"
#include "unit/slicing/soundness.hpp"

namespace oval4d::polytopes {
namespace {

using support::countsOf;
using support::importPoints;
using support::named;
using support::sound;
using support::warningsOf;

using Points = std::vector<glm::dvec4>;

// Returns the points with noise of at most `amplitude` in each coordinate.
Points noisy(Points points, double amplitude, std::mt19937& random) {
    std::uniform_real_distribution<double> noise(-amplitude, amplitude);
    for (glm::dvec4& p : points) {
        for (int axis = 0; axis < 4; ++axis) p[axis] += noise(random);
    }
    return points;
}

ImportedPolytope imported(const Polytope& polytope, const Points& vertices) {
    return sound(importPolytope(PolytopeFileFormat::off4, write4Off(polytope, vertices), "p", {}));
}

// Returns the largest distance of a vertex from the hyperplane of its cell, relative to the circumradius.
double unevenness(const Polytope& p) {
    Points normals;
    std::vector<double> offsets;
    slicing::findCellHyperplanes(support::objectOf(p), normals, offsets);
    double most = 0;
    for (std::size_t c = 0; c < p.cells.size(); ++c) {
        const double length = glm::length(normals[c]);
        if (length == 0) continue;  // the cell encloses no volume
        for (const std::uint32_t f : p.cells[c]) {
            for (const std::uint32_t v : p.faces[f])
                most = std::max(most, std::abs(glm::dot(normals[c], p.vertices[v]) - offsets[c]) / length);
        }
    }
    return most / p.circumradius;
}

// Returns the hypervolume: the sum over the cones from the origin to the cells. The normal of a cell is six times as
// long as the cell's volume.
double contentOf(const Polytope& p) {
    Points normals;
    std::vector<double> offsets;
    slicing::findCellHyperplanes(support::objectOf(p), normals, offsets);
    double sum = 0;
    for (const double offset : offsets) sum += offset / 24;
    return sum;
}

// Expects that no vertex of a section of a convex polytope lies outside of the polytope by more than a tolerance. A
// vertex of the polytope counts as lying in the section's hyperplane if it is at most kOnPlaneTolerance circumradii
// away. In a section that is nearly parallel to a cell, such a vertex may be farther from the plane of a face.
void expectInside(const Polytope& p, const geometry::Rotation& orientation, const slicing::SliceSet& section) {
    Points normals;
    std::vector<double> offsets;
    slicing::findCellHyperplanes(support::objectOf(p), normals, offsets);
    for (std::size_t c = 0; c < normals.size(); ++c) {
        const glm::dvec4 normal = orientation(glm::normalize(normals[c]));
        const double offset = offsets[c] / glm::length(normals[c]);
        for (const glm::dvec3& v : section.vertices)
            ASSERT_LT(glm::dot(normal, glm::dvec4(v, section.planes.w(0))) - offset,
                      2 * slicing::kOnPlaneTolerance * p.circumradius);
    }
}

// Expects that sections near some vertices of the polytope, rotated by `orientation`, are closed surfaces.
void expectClosedSections(const Polytope& p, const geometry::Rotation& orientation, std::mt19937& random) {
    std::uniform_real_distribution<double> anywhere(-p.circumradius, p.circumradius);
    for (int i = 0; i < 6; ++i) {
        const glm::dvec4 at = orientation(p.vertices[random() % p.vertices.size()]);
        for (const double w : {at.w, at.w + 1e-10, at.w - 1e-8, at.w + 1e-7, at.w - 1e-5, anywhere(random)}) {
            const slicing::SliceSet slice = support::cutAt(p, orientation, w);
            if (slice.faceCount(0) != 1) support::expectClosed(slice);  // a single face is a 2-face in the hyperplane
            if (p.convex) expectInside(p, orientation, slice);
            // If vertices count as lying in the hyperplane, the section of a nearly parallel cell may fold over.
            const bool exact = std::none_of(p.vertices.begin(), p.vertices.end(), [&](const glm::dvec4& v) {
                return std::abs(orientation(v).w - w) <= 2 * slicing::kOnPlaneTolerance * p.circumradius;
            });
            constexpr double kAny = std::numeric_limits<double>::infinity();  // no limit on the distance from a face's
                                                                              // plane (see expectInside())
            if (p.convex && exact && slice.faceCount(0) > 1) support::expectClosedConvexSolid(slice, 0, kAny);
            ASSERT_FALSE(testing::Test::HasFatalFailure()) << p.name << " at " << w;
        }
    }
}

const support::Polygon kSquare{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
const support::Polygon kDented{{-2, -2}, {2, -2}, {2, 0}, {0.5, 0}, {0.5, 1.5}, {-0.5, 1.5}, {-0.5, 0}, {-2, 0}};

TEST(Flatten, MakesTheSectionsOfNoisyPolytopesClosed) {
    std::mt19937 random(51);
    const Polytope dented = support::product(kDented, kSquare);
    for (const Polytope* exact : {&named("8-cell"), &named("24-cell"), &named("rectified 24-cell"),
                                  &named("truncated icosahedral prism"), &named("{5/2,3,5}"), &dented}) {
        for (const double noise : {1e-12, 1e-9, 3e-9, 1e-6, 1e-4}) {
            for (const bool turned : {false, true}) {
                // Without a rotation, the hyperplanes w = const are parallel to cells.
                const geometry::Rotation rotation = turned ? support::randomRotation(random) : geometry::Rotation();
                Points vertices;
                for (const glm::dvec4& v : exact->vertices) vertices.push_back(rotation(v));
                vertices = noisy(vertices, noise, random);
                const Polytope flat = imported(*exact, vertices).polytope;
                const std::string what = exact->name + " with noise " + std::to_string(noise);
                ASSERT_EQ(countsOf(flat), countsOf(*exact)) << what;
                EXPECT_LT(unevenness(flat), 4e-12) << what;
                EXPECT_EQ(flat.convex, exact->convex) << what;
                for (std::size_t v = 0; v < vertices.size(); ++v)
                    EXPECT_LT(glm::distance(flat.vertices[v], vertices[v]), 6 * noise) << what;
                expectClosedSections(flat, {}, random);
                ASSERT_FALSE(HasFatalFailure()) << what;
            }
        }
    }
}

// A polytope that is far from the origin is flat up to the rounding of its coordinates, which is more than 1e-12 of its
// size.
TEST(Flatten, LeavesDistantPolytopesAsExactAsTheirCoordinatesAre) {
    std::mt19937 random(52);
    for (const double distance : {1e2, 1e4, 1e6}) {
        for (const std::string name : {"8-cell", "120-cell", "rectified 24-cell"}) {
            const Polytope& exact = named(name);
            const geometry::Rotation rotation = support::randomRotation(random);
            Points vertices;
            for (const glm::dvec4& v : exact.vertices)
                vertices.push_back(rotation(v) + distance * glm::dvec4(1, -2, 0, 1));
            const std::string text = write4Off(exact, vertices);
            for (const auto choice :
                 {geometry::Centering::OriginChoice::origin, geometry::Centering::OriginChoice::object}) {
                const ImportedPolytope made =
                    sound(importPolytope(PolytopeFileFormat::off4, text, "p", {}, {.choice = choice, .place = {}}));
                EXPECT_EQ(made.warnings, std::vector<std::string>()) << name << " at " << distance;
                EXPECT_EQ(countsOf(made.polytope), countsOf(exact));
                EXPECT_LT(unevenness(made.polytope), std::max(4e-12, 1e-14 * distance));
            }
        }
    }
}

TEST(Flatten, KeepsTheContent) {
    std::mt19937 random(52);
    for (const char* name : {"8-cell", "24-cell", "5,7-duoprism"}) {
        const Polytope& exact = named(name);
        const Polytope flat = imported(exact, noisy(exact.vertices, 1e-5, random)).polytope;
        const double content = contentOf(flat);
        EXPECT_NEAR(content, contentOf(exact), 1e-3) << name;
        EXPECT_NEAR(support::hypervolumeBySlices(flat, {}), content, 1e-6 * content) << name;
        EXPECT_NEAR(support::hypervolumeBySlices(flat, support::randomRotation(random)), content, 1e-6 * content)
            << name;
    }
}

TEST(Flatten, ConvergesForLargePolytopes) {
    std::mt19937 random(53);
    const Polytope& exact = named("120-cell");
    const ImportedPolytope flat = imported(exact, noisy(exact.vertices, 1e-4, random));
    EXPECT_LT(unevenness(flat.polytope), 1e-12);
    EXPECT_TRUE(flat.polytope.convex);
    EXPECT_EQ(flat.warnings.size(), 1U);
}

TEST(Flatten, TellsWhatItMoves) {
    std::mt19937 random(54);
    const Polytope& cube = named("8-cell");
    EXPECT_EQ(warningsOf(imported(cube, cube.vertices)), "");
    const std::string warning = warningsOf(imported(cube, noisy(cube.vertices, 1e-6, random)));
    EXPECT_NE(warning.find("16 vertices were moved by up to "), std::string::npos) << warning;
    EXPECT_NE(warning.find("so that the vertices of each cell lie in one hyperplane"), std::string::npos) << warning;
    // Any points can be the vertices of a simplex, so they are not moved.
    const Polytope& simplex = named("5-cell");
    const Points moved = noisy(simplex.vertices, 1e-3, random);
    const ImportedPolytope kept = imported(simplex, moved);
    EXPECT_EQ(kept.polytope.vertices, moved);
    EXPECT_EQ(warningsOf(kept), "");
}

TEST(Flatten, MovesTheVerticesOfAHullWithinTheirDigits) {
    std::mt19937 random(55);
    for (const char* name : {"8-cell", "24-cell", "3,3-duoprism", "120-cell"}) {
        const Points points = support::turned(named(name), random);
        const ImportedPolytope hull = sound(importPoints(support::asPoints(points, 5)));
        EXPECT_EQ(countsOf(hull.polytope), countsOf(named(name)));
        EXPECT_EQ(warningsOf(hull), "") << name;
        EXPECT_LT(unevenness(hull.polytope), 1e-12) << name;
        EXPECT_TRUE(hull.polytope.convex) << name;
        support::expectSamePoints(hull.polytope.vertices, points, 1e-3);
    }
}

// Returns the vertices, 2-faces and cells of a polytope as a polygon soup.
PolygonSoup soupOf(const Polytope& p) { return {p.vertices, p.faces, p.cells, {}, {}}; }

TEST(Flatten, DividesCellsThatItMayNotMakeFlat) {
    std::mt19937 random(56);
    const Polytope& cube = named("8-cell");
    PolygonSoup soup = soupOf(cube);
    soup.vertices = noisy(soup.vertices, 1e-4, random);
    const Points before = soup.vertices;
    const FlatteningReport done = flattenOrSplit(soup, halfDiagonal(soup.vertices), 1e-7, 0);
    EXPECT_EQ(done.split, 8U);
    EXPECT_EQ(done.moved, 0U);
    EXPECT_GT(done.deviation, 1e-5);
    EXPECT_EQ(soup.vertices, before);
    const Polytope divided = makePolytope("p", soup.vertices, soup.faces, soup.cells);
    EXPECT_LT(unevenness(divided), 1e-12);
    EXPECT_NEAR(support::hypervolumeBySlices(divided, support::randomRotation(random)), contentOf(divided), 1e-6);
    expectClosedSections(divided, {}, random);
}

TEST(Flatten, DividesCubesIntoSixTetrahedra) {
    const Polytope& cube = named("8-cell");
    PolygonSoup soup = soupOf(cube);
    splitIntoSimplices(soup, std::vector<bool>(24, false), std::vector<bool>(8, true));
    const Polytope divided = makePolytope("p", soup.vertices, soup.faces, soup.cells);
    EXPECT_EQ(divided.vertices.size(), 16U);
    EXPECT_EQ(divided.cellCount(), 48U);
    EXPECT_TRUE(divided.convex);
    EXPECT_NEAR(contentOf(divided), 16, 1e-9);
}

TEST(Flatten, DividesSomeCellsAndAllTheir2Faces) {
    const Polytope& cube = named("8-cell");
    PolygonSoup soup = soupOf(cube);
    std::vector<bool> cells(8, false);
    cells[3] = true;
    splitIntoSimplices(soup, std::vector<bool>(24, false), cells);
    const Polytope divided = makePolytope("p", soup.vertices, soup.faces, soup.cells);
    EXPECT_EQ(divided.cellCount(), 13U);
    EXPECT_NEAR(contentOf(divided), 16, 1e-9);
}

}  // namespace
}  // namespace oval4d::polytopes
