#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "polytopes/construction/coxeter.hpp"
#include "unit/slicing/soundness.hpp"
#include "unit/slicing/support.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::support;
using namespace oval4d::slicing;

/// Returns the signed area of a polygon, weighted by the winding number.
double areaOf(const Polygon& polygon) {
    double sum = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2 a = polygon[i];
        const glm::dvec2 b = polygon[(i + 1) % polygon.size()];
        sum += (a.x * b.y - a.y * b.x) / 2;
    }
    return sum;
}

const Polygon kSquare{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
const Polygon kDented{{-2, -2}, {2, -2}, {2, 0}, {0.5, 0}, {0.5, 1.5}, {-0.5, 1.5}, {-0.5, 0}, {-2, 0}};

Polygon pentagram() {
    Polygon star;
    for (int i = 0; i < 5; ++i)
        star.emplace_back(std::cos(4 * i * std::numbers::pi / 5), std::sin(4 * i * std::numbers::pi / 5));
    return star;
}

TEST(NonConvex, productsHaveTheProductOfTheAreasAsHypervolume) {
    std::mt19937 random(21);
    for (const auto& [p, q] : {std::pair{kDented, kSquare},
                               {kSquare, kDented},
                               {kDented, kDented},
                               {pentagram(), kSquare},
                               {pentagram(), kDented},
                               {pentagram(), pentagram()}}) {
        const polytopes::Polytope polytope = product(p, q);
        EXPECT_FALSE(polytope.convexFaces);
        for (int trial = 0; trial < 5; ++trial) {
            EXPECT_NEAR(hypervolumeBySlices(polytope, randomRotation(random)), std::abs(areaOf(p) * areaOf(q)), 1e-6);
        }
    }
}

TEST(NonConvex, slicesAreClosed) {
    std::mt19937 random(22);
    SliceSet s;
    CellComplexSlicer slicer;
    const polytopes::DiagramBranch star{5, 2};
    const polytopes::CoxeterDiagram stellated =
        polytopes::CoxeterDiagram::linear(star, {5, 1}, {3, 1}, {true, false, false, false});
    for (const polytopes::Polytope& p :
         {product(kDented, pentagram()), wythoffConstruction("{5/2,5,3}", stellated, mirrorsOf(stellated))}) {
        for (int trial = 0; trial < 50; ++trial) {
            // In every other trial, vertices lie in hyperplanes.
            geometry::Rotation orientation = randomRotation(random);
            if (trial % 2 == 0)
                orientation = geometry::Rotation(geometry::RotationAngles{
                    geometry::kPlanes.at(random() % 6), std::numbers::pi / 2 * int(random() % 4), {}});
            slicer.slice(p, orientation, {-10, 21, trial % 4 == 0 ? 0.25 : p.circumradius / 9.7}, s);
            expectClosed(s);
            ASSERT_FALSE(HasFatalFailure()) << p.name << " trial " << trial;
        }
    }
}

TEST(NonConvex, sectionNearThePointOfAPentagramIsABox) {
    // The prism over a pentagram prism, cut across one tip of the star.
    const polytopes::Polytope p = product(kSquare, pentagram());
    const SliceSet s =
        cutAt(p, geometry::Rotation(geometry::RotationAngles{geometry::Plane::zw, std::numbers::pi / 2, {}}), 0.9);
    EXPECT_EQ(s.vertexCount(0), 8U);  // a thin box at the tip of the star
    EXPECT_EQ(s.edgeCount(0), 12U);
    EXPECT_EQ(s.faceCount(0), 6U);
}

// Sections through the tips of a comb's teeth have one box for each tooth. The polytope is a comb with many teeth along
// w, times a square with the area 4. The hyperplane contains the lowest or highest edges of the comb's 2-faces: one
// edge for each tooth.
TEST(NonConvex, sectionThroughTheTipsOfACombConsistsOfBoxes) {
    constexpr int kTeeth = 12;
    for (const double down : {-1.0, 1.0}) {
        Polygon comb;
        for (int tooth = 0; tooth < kTeeth; ++tooth) {
            const double left = 2 * tooth, right = left + 1;
            if (tooth > 0) comb.emplace_back(left, 0);
            comb.emplace_back(left, down);
            comb.emplace_back(right, down);
            if (tooth + 1 < kTeeth) comb.emplace_back(right, 0);
        }
        comb.emplace_back(2 * kTeeth - 1, -down);
        comb.emplace_back(0, -down);
        const SliceSet s = cutAt(product(kSquare, comb), {}, down);
        expectClosed(s);
        EXPECT_EQ(sliceCounts(s), (ElementsOfSlice{8 * kTeeth, 12 * kTeeth, 6 * kTeeth})) << down;
        EXPECT_NEAR(volumeOf(s, 0), 4 * kTeeth, 1e-9) << down;
    }
}

// Slices through bent cells are closed. Each cell in a hyperplane w = const has its vertices moved up and down, so that
// a hyperplane between them cuts the cell's 2-faces several times.
TEST(NonConvex, slicesThroughBentCellsAreClosed) {
    std::mt19937 random(23);
    std::uniform_real_distribution<double> noise(-1e-6, 1e-6);
    for (const char* name : {"8-cell", "24-cell", "5,7-duoprism"}) {
        const polytopes::Polytope& exact = named(name);
        auto vertices = exact.vertices;
        for (glm::dvec4& v : vertices) v.w += noise(random);
        const polytopes::Polytope bent = polytopes::makePolytope(name, vertices, exact.faces, exact.cells);
        std::sort(vertices.begin(), vertices.end(), [](const auto& a, const auto& b) { return a.w < b.w; });
        for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
            // The vertices may count as lying in the hyperplane.
            if (vertices[i + 1].w - vertices[i].w < 1e-7) continue;
            expectClosed(cutAt(bent, {}, (vertices[i].w + vertices[i + 1].w) / 2));
            ASSERT_FALSE(HasFatalFailure()) << name << " above " << vertices[i].w;
        }
    }
}

}  // namespace
