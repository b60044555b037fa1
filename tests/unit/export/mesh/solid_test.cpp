#include <algorithm>
#include <chrono>

#include "export/mesh/hull.hpp"
#include "export/mesh/measure.hpp"
#include "export/mesh/skeleton.hpp"
#include "export/mesh/solid.hpp"
#include "unit/export/support.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::support;
using namespace oval4d::exports;
using namespace oval4d::geometry;
using namespace oval4d::polytopes;
using namespace oval4d::slicing;

constexpr double kSize = 60;

double scaleOf(const Polytope& p) { return kSize / 2 / p.circumradius; }
Mesh solid(const Polytope& p, const SliceSet& s) {
    return solidOf(s, 0, scaleOf(p), RoundingGrid(kSize, kSize), unhurried());
}

/// Expects that the solid body of a slice is a closed mesh with the volume of the slice. Returns whether there is a
/// body.
bool expectSolid(const Polytope& p, const Rotation& orientation, double w) {
    const SliceSet s = cutAt(p, orientation, w);
    const Mesh mesh = solid(p, s);
    if (mesh.triangles.empty()) {
        // There is no body if the slice is empty, or thinner than a few steps of the grid.
        const SliceMeasurements m = measureSlice(s, 0);
        const double step = RoundingGrid(kSize, kSize).step();
        EXPECT_LE(m.volume * std::pow(scaleOf(p), 3), 4 * step * m.area * scaleOf(p) * scaleOf(p));
        return false;
    }
    expectPrintable(mesh);
    const double exact = oval4d::support::volumeOf(s, 0) * std::pow(scaleOf(p), 3);
    const double rounding = 2 * RoundingGrid(kSize, kSize).step() * measureSlice(s, 0).area * scaleOf(p) * scaleOf(p);
    EXPECT_NEAR(volumeOf(mesh), exact, rounding);
    return true;
}

class Solids : public testing::TestWithParam<const char*> {};

TEST_P(Solids, areClosedAndAsLargeAsTheSliceHoweverTurned) {
    const Polytope& p = named(GetParam());
    std::mt19937 random(5);
    std::uniform_real_distribution<double> level(-0.95, 0.95);
    int made = 0;
    for (int trial = 0; trial < 60 && !HasFatalFailure(); ++trial)
        made += expectSolid(p, randomRotation(random), level(random) * p.circumradius) ? 1 : 0;
    EXPECT_GE(made, 35);
}

TEST_P(Solids, areClosedWhereTheHyperplaneMeetsAnElementOrNearlyDoes) {
    const Polytope& p = named(GetParam());
    std::mt19937 random(6);
    std::vector<Rotation> orientations{Rotation()};
    for (const auto* list : {&p.faces, &p.cells}) {
        // Use rotations after which a 2-face or a cell lies in a hyperplane.
        glm::dvec4 sum(0);
        for (const auto item : (*list)[0]) {
            if (list == &p.faces) {
                sum += p.vertices[item];
            } else {
                for (const auto v : p.faces[item]) sum += p.vertices[v];
            }
        }
        orientations.push_back(oval4d::support::ontoW(sum));
    }
    orientations.push_back(oval4d::support::ontoW(p.vertices[p.edges[0][0]] + p.vertices[p.edges[0][1]]));
    orientations.push_back(oval4d::support::ontoW(p.vertices[0]));
    orientations.push_back(randomRotation(random));
    int made = 0;
    for (const Rotation& orientation : orientations) {
        std::set<double> levels;
        for (const auto& v : p.vertices) levels.insert(std::round(orientation(v).w * 1e10) / 1e10);
        int count = 0;
        for (const double w : levels) {
            if (++count > 12) break;
            for (const double off : {0.0, 1e-10, -1e-10, 1e-8, -1e-8, 1e-6, -1e-6, 1e-5, -1e-5, 1e-4, 1e-3}) {
                made += expectSolid(p, orientation, w + off * p.circumradius) ? 1 : 0;
                if (HasFatalFailure()) FAIL() << "w = " << w << " off " << off;
            }
        }
    }
    EXPECT_GT(made, 50);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Solids,
                         testing::Values("5-cell", "8-cell", "16-cell", "24-cell", "120-cell", "600-cell"));

TEST(Solid, ofATesseractIsTheCube) {
    const Polytope& p = named("8-cell");
    const Mesh mesh = solid(p, cutAt(p, {}, 1));  // a whole cell lies in the hyperplane
    expectPrintable(mesh);
    EXPECT_EQ(mesh.points.size(), 8U);
    EXPECT_EQ(mesh.triangles.size(), 12U);
    const glm::dvec3 size = boundingBoxOf(mesh).size();
    // The tesseract has the circumradius 2 and edges of length 2.
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(size[axis], kSize / 2, 1e-3);
}

TEST(Solid, isNotToBeHadOfAFaceAnEdgeOrAPoint) {
    const Polytope& p = named("24-cell");
    const auto& face = p.faces[0];
    for (const glm::dvec4& top : {p.vertices[0], p.vertices[p.edges[0][0]] + p.vertices[p.edges[0][1]],
                                  p.vertices[face[0]] + p.vertices[face[1]] + p.vertices[face[2]]}) {
        const Rotation up = oval4d::support::ontoW(top);
        double most = 0;
        for (const auto& v : p.vertices) most = std::max(most, up(v).w);
        const SliceSet s = cutAt(p, up, most);
        ASSERT_GT(s.vertexCount(0), 0U);
        EXPECT_TRUE(solid(p, s).triangles.empty());
        EXPECT_TRUE(solid(p, cutAt(p, up, most * 1.01)).triangles.empty());
    }
}

TEST(Solid, ofAConvexSliceObservesTheLimitOfTime) {
    const Polytope& p = named("600-cell");
    const SliceSet s = cutAt(p, {}, 0.1);
    const RoundingGrid grid(kSize, kSize);
    const ExportBudget spent({.time = std::chrono::duration<double>(-1)}, {});
    EXPECT_THROW(solidOf(s, 0, scaleOf(p), grid, spent), ExportRefused);
    std::vector<glm::dvec3> points;
    for (const glm::dvec3& vertex : s.vertices) points.push_back(grid.snap(vertex * scaleOf(p)));
    EXPECT_THROW(convexHullOfGridPoints(points, grid, &spent), ExportRefused);
    expectPrintable(convexHullOfGridPoints(points, grid));
}

TEST(Hull, isClosedAndConvexThoughManyPointsLieInOnePlane) {
    const RoundingGrid grid(kSize, kSize);
    std::mt19937 random(10);
    for (const int side : {1, 2, 4}) {
        for (int trial = 0; trial < 20; ++trial) {
            std::uniform_int_distribution<int> place(0, side);
            std::vector<glm::dvec3> points;
            for (int n = 0; n < 40; ++n)
                points.push_back(grid.step() * glm::dvec3(place(random), place(random), place(random)));
            const Mesh hull = convexHullOfGridPoints(points, grid);
            expectPrintable(hull);
            for (const auto& t : hull.triangles) {
                for (const auto& p : points) EXPECT_LE(glm::dot(doubleAreaNormalOf(hull, t), p - hull.points[t[0]]), 0);
            }
        }
    }
    EXPECT_TRUE(convexHullOfGridPoints({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, grid).triangles.empty());
    EXPECT_TRUE(convexHullOfGridPoints({{0, 0, 0}, {1, 0, 0}}, grid).triangles.empty());
}

TEST(OuterSurface, ofACompoundIsThatOfTheUnion) {
    const Polytope& cube = named("8-cell");
    const Polytope two = compound(cube, cube, {1, 0.5, 0.25, 0});
    const Mesh mesh = solid(two, cutAt(two, {}, 0.1));
    expectPrintable(mesh);
    const double exact = 8 + 8 - 1 * 1.5 * 1.75;
    EXPECT_NEAR(volumeOf(mesh) / std::pow(scaleOf(two), 3), exact, 0.01 * exact);
}

TEST(OuterSurface, ofTwoBodiesApartIsTwoBodies) {
    const Polytope& cube = named("8-cell");
    const Polytope two = compound(cube, cube, {3, 0, 0, 0});
    const Mesh mesh = solid(two, cutAt(two, {}, 0.1));
    expectPrintable(mesh);
    EXPECT_NEAR(volumeOf(mesh) / std::pow(scaleOf(two), 3), 16, 0.16);
}

TEST(OuterSurface, ofAStarIsAllThatItWindsAround) {
    for (const auto& [polygon, area] : {std::pair{pentagram(), kPentagramArea}, {kDented, kDentedArea}}) {
        const Polytope p = product(polygon, kSquare);
        const Mesh mesh = solid(p, cutAt(p, {}, 0.3));
        expectPrintable(mesh);
        EXPECT_NEAR(volumeOf(mesh) / std::pow(scaleOf(p), 3), 2 * area, 0.02 * area);
    }
}

/// Returns the winding number of a slice's faces around a point, as a sum of solid angles (A. van Oosterom, J.
/// Strackee, IEEE Transactions on Biomedical Engineering 30, 1983).
double windingAround(const SliceSet& s, const glm::dvec3& place) {
    double sum = 0;
    for (std::uint32_t f = 0; f < s.faceBegin[1]; ++f) {
        for (std::uint32_t c = s.cornerBegin[f] + 1; c + 1 < s.cornerBegin[f + 1]; ++c) {
            const glm::dvec3 a = s.vertices[s.corners[s.cornerBegin[f]]] - place;
            const glm::dvec3 b = s.vertices[s.corners[c]] - place;
            const glm::dvec3 d = s.vertices[s.corners[c + 1]] - place;
            const double x = glm::length(a);
            const double y = glm::length(b);
            const double z = glm::length(d);
            sum += 2 * std::atan2(glm::dot(a, glm::cross(b, d)),
                                  x * y * z + glm::dot(a, b) * z + glm::dot(b, d) * x + glm::dot(d, a) * y);
        }
    }
    return sum / (4 * std::numbers::pi);
}

TEST(OuterSurface, ofStarPolychoraHoldsThePlacesThatTheFacesWindAround) {
    std::mt19937 random(14);
    for (const char* name : {"{5/2,5,3}", "{5,5/2,5}", "{3,5,5/2}"}) {
        const Polytope& p = named(name);
        const SliceSet s = cutAt(p, randomRotation(random), 0.1 * p.circumradius);
        const Mesh mesh = solid(p, s);
        expectPrintable(mesh);
        const BoundingBox box = boundingBoxOf(mesh);
        std::uniform_real_distribution<double> part(0, 1);
        constexpr int kPlaces = support::kSanitized ? 600 : 6000;
        int inside = 0;
        for (int i = 0; i < kPlaces; ++i) {
            const glm::dvec3 place = box.min + box.size() * glm::dvec3(part(random), part(random), part(random));
            inside += std::abs(windingAround(s, place / scaleOf(p))) > 0.5 ? 1 : 0;
        }
        const double whole = box.size().x * box.size().y * box.size().z;
        const double share = static_cast<double>(inside) / kPlaces;
        EXPECT_GT(share, 0.05);
        // The tolerance is four standard deviations of the count, plus the effect of edges that the grid of cubes
        // rounds.
        EXPECT_NEAR(volumeOf(mesh) / whole, share, 4 * std::sqrt(share / kPlaces) + 0.02 * share) << name;
    }
}

TEST(OuterSurface, isClosedHoweverTurned) {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> level(-0.6, 0.6);
    constexpr int kTrials = support::kSanitized ? 1 : 3;
    int made = 0;
    for (const Polytope& p : {product(pentagram(), pentagram()), product(kDented, pentagram()),
                              compound(named("24-cell"), named("16-cell"), {0.3, 0.2, 0, 0.1})}) {
        for (int trial = 0; trial < kTrials; ++trial) {
            const Mesh mesh = solid(p, cutAt(p, randomRotation(random), level(random) * p.circumradius));
            if (mesh.triangles.empty()) continue;
            ++made;
            expectPrintable(mesh);
        }
    }
    EXPECT_GT(made, kTrials);
}

TEST(OuterSurface, facesLieOnThoseOfTheSlice) {
    const Polytope p = product(kDented, kSquare);
    const Mesh mesh = solid(p, cutAt(p, {}, 0.3));
    std::size_t on = 0;
    for (const auto& point : mesh.points) {
        double nearest = 1e300;
        const glm::dvec3 q = point / scaleOf(p);
        for (const double plane : {-2.0, -0.5, 0.5, 2.0}) nearest = std::min(nearest, std::abs(q.x - plane));
        for (const double plane : {-2.0, 0.0, 1.5}) nearest = std::min(nearest, std::abs(q.y - plane));
        for (const double plane : {-1.0, 1.0}) nearest = std::min(nearest, std::abs(q.z - plane));
        on += nearest < 0.005 ? 1 : 0;
    }
    EXPECT_GT(on, mesh.points.size() * 8 / 10);
    for (const auto cell : mesh.cells) EXPECT_LT(cell, p.cellCount() + p.faces.size());
}

TEST(Skeleton, isClosedHoweverTurned) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> level(-0.9, 0.9);
    const RoundingGrid grid(kSize, kSize);
    for (const char* name : {"5-cell", "8-cell", "24-cell", "600-cell"}) {
        const Polytope& p = named(name);
        for (int trial = 0; trial < (support::kSanitized ? 1 : 4); ++trial) {
            const Rotation orientation = randomRotation(random);
            const SliceSet s = cutAt(p, orientation, level(random) * p.circumradius);
            if (s.vertexCount(0) == 0) continue;
            const SkeletonRadii thick = skeletonRadii(composed(p, orientation, s), scaleOf(p));
            expectPrintable(skeletonOf(s, 0, scaleOf(p), thick, thick.bar, grid, unhurried()));
        }
    }
}

TEST(Skeleton, ofAPointIsABall) {
    const Polytope& p = named("5-cell");
    const Rotation up = oval4d::support::ontoW(p.vertices[0]);
    const SliceSet s = cutAt(p, up, p.circumradius);
    ASSERT_EQ(s.vertexCount(0), 1U);
    const SkeletonRadii thick{3, 1};
    const Mesh mesh = skeletonOf(s, 0, scaleOf(p), thick, 0.3, RoundingGrid(kSize, kSize), unhurried());
    expectPrintable(mesh);
    EXPECT_NEAR(volumeOf(mesh), 4.0 / 3 * std::numbers::pi * 27, 1);
    double farthest = 0;
    for (const auto& point : mesh.points) farthest = std::max(farthest, std::abs(glm::length(point) - 3));
    EXPECT_LT(farthest, 0.02);
}

TEST(Skeleton, hasTheVolumeOfItsBallsAndBars) {
    // The skeleton consists of twelve bars of 30 mm between eight balls. The parts of bars inside balls count only
    // once.
    const Polytope& p = named("8-cell");
    const SliceSet s = cutAt(p, {}, 0);
    const SkeletonRadii thick{3, 1};
    const Mesh mesh = skeletonOf(s, 0, scaleOf(p), thick, 0.25, RoundingGrid(kSize, kSize), unhurried());
    expectPrintable(mesh);
    const double pi = std::numbers::pi;
    const double height = 3 - std::sqrt(8.0);  // height of the spherical cap above the circle where a bar leaves the
                                               // ball
    const double bar = pi * (30 - 2 * std::sqrt(8.0)) - 2 * pi * height * height * (9 - height) / 3;
    EXPECT_NEAR(volumeOf(mesh), 8 * 4.0 / 3 * pi * 27 + 12 * bar, 20);
    const double expected = estimateSkeletonTriangles(s, scaleOf(p), thick) / (0.25 * 0.25);
    EXPECT_NEAR(static_cast<double>(mesh.triangles.size()) / expected, 1, 0.25);
}

TEST(Mesh, theCheckSeesWhatIsOpenDoubledReversedOrTouching) {
    const Polytope& p = named("8-cell");
    const Mesh cube = solid(p, cutAt(p, {}, 0));
    EXPECT_TRUE(isClosedManifold(cube));
    Mesh open = cube;
    open.triangles.pop_back();
    EXPECT_FALSE(isClosedManifold(open));
    Mesh reversed = cube;
    std::swap(reversed.triangles[3][0], reversed.triangles[3][1]);
    EXPECT_FALSE(isClosedManifold(reversed));
    Mesh doubled = cube;
    for (const auto& t : cube.triangles) doubled.triangles.push_back(t);
    EXPECT_FALSE(isClosedManifold(doubled));
    Mesh touching = cube;  // will get a second cube that shares one corner
    for (const auto& point : cube.points) touching.points.push_back(point + boundingBoxOf(cube).size());
    for (const auto& t : cube.triangles) touching.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
    EXPECT_TRUE(isClosedManifold(touching));
    const auto at = [&](const glm::dvec3& place) {
        return static_cast<std::uint32_t>(std::ranges::find(touching.points, place) - touching.points.begin());
    };
    const auto shared = at(boundingBoxOf(cube).max);
    const auto copy = at(boundingBoxOf(cube).min + boundingBoxOf(cube).size());
    ASSERT_EQ(shared, copy);  // both searches find the first point at this position
    for (auto& t : touching.triangles) {
        for (auto& corner : t) {
            if (corner >= 8 && touching.points[corner] == touching.points[shared]) corner = shared;
        }
    }
    EXPECT_FALSE(isClosedManifold(touching));
}

}  // namespace
