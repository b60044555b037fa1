#include <random>

#include <gtest/gtest.h>

#include "slicing/slice_edges.hpp"
#include "slicing/slicer.hpp"
#include "unit/polytopes/support.hpp"
#include "unit/slicing/support.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::slicing;
using support::named;

std::size_t edgesOf(const Object& object, const geometry::Rotation& orientation, const geometry::Hyperplanes& planes) {
    SliceSet slices;
    Slicer().sliceWithoutSurfaces(object, orientation, planes, slices);
    return slices.edges.size();
}

TEST(SliceEdges, areCountedExactlyIfNoVertexLiesInAHyperplane) {
    std::mt19937 random(31);
    for (const auto* name : {"5-cell", "24-cell", "120-cell", "5,7-duoprism", "grand 600-cell"}) {
        const polytopes::Polytope& p = named(name);
        const Object object = support::objectOf(p);
        for (int i = 0; i < 20; ++i) {
            const geometry::Rotation orientation = support::randomRotation(random);
            const geometry::Hyperplanes planes{-10, 21, p.circumradius / 9, 0.01 * p.circumradius};
            geometry::Hyperplanes listed{0, 3, 1};
            for (const double part : {0.7, -0.31, 0.05}) listed.listed.push_back(part * p.circumradius);
            EXPECT_EQ(sliceEdgeBound(object, orientation, planes), edgesOf(object, orientation, planes)) << name;
            EXPECT_EQ(sliceEdgeBound(object, orientation, listed), edgesOf(object, orientation, listed)) << name;
        }
    }
}

TEST(SliceEdges, areNotMoreThanCountedIfVerticesLieInHyperplanes) {
    for (const auto* name : {"8-cell", "16-cell", "24-cell", "600-cell"}) {
        const polytopes::Polytope& p = named(name);
        const Object object = support::objectOf(p);
        const geometry::Hyperplanes planes{-10, 21, p.circumradius / 8};
        EXPECT_GE(sliceEdgeBound(object, {}, planes), edgesOf(object, {}, planes)) << name;
    }
}

// Slices with more edges than the limit are refused. Pentagrams can have several edges in one slice.
TEST(SliceEdges, areRefusedBeyondTheLimit) {
    std::mt19937 random(32);
    for (const auto* name : {"24-cell", "small stellated 120-cell"}) {
        const Object object = support::objectOf(named(name));
        const geometry::Rotation orientation = support::randomRotation(random);
        for (const int count : {1, 21}) {
            const geometry::Hyperplanes planes{0, count, 0.02, 0.01};
            const std::size_t found = sliceEdgeBound(object, orientation, planes);
            ASSERT_GT(found, 0U);
            EXPECT_NO_THROW(checkSliceEdges(object, orientation, planes, found));
            EXPECT_THROW(checkSliceEdges(object, orientation, planes, found - 1), TooManySliceEdges);
        }
    }
}

}  // namespace
