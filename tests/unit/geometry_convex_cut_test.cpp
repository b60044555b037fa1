#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "geometry_soundness.hpp"

namespace {

using namespace oval4d::geometry;
using namespace oval4d::geometry::support;
using std::numbers::pi;

/// A slice's elements by their origins, so that neither their order nor where a loop begins matters.
struct ByOrigin {
    std::map<std::uint32_t, glm::dvec3> vertices;
    std::map<std::uint32_t, std::set<std::uint32_t>> edges;  // the origins of its ends
    /// The origins of its corners and of the edges that go on from them, from the least corner on.
    std::map<std::uint32_t, std::vector<std::array<std::uint32_t, 2>>> faces;
};

ByOrigin byOrigin(const SliceSet& s, int slice) {
    ByOrigin out;
    const auto* vertexOf = s.vertexOf.data() + s.vertexBegin[slice];
    const auto* edgeOf = s.edgeOf.data() + s.edgeBegin[slice];
    for (auto v = s.vertexBegin[slice]; v < s.vertexBegin[slice + 1]; ++v) out.vertices[s.vertexOf[v]] = s.vertices[v];
    for (auto e = s.edgeBegin[slice]; e < s.edgeBegin[slice + 1]; ++e) {
        out.edges[s.edgeOf[e]] = {vertexOf[s.edges[e][0]], vertexOf[s.edges[e][1]]};
    }
    for (auto f = s.faceBegin[slice]; f < s.faceBegin[slice + 1]; ++f) {
        auto& loop = out.faces[s.faceOf[f]];
        for (auto i = s.cornerBegin[f]; i < s.cornerBegin[f + 1]; ++i) {
            loop.push_back({vertexOf[s.corners[i]], edgeOf[s.cornerEdges[i]]});
        }
        std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    }
    return out;
}

void expectSame(const SliceSet& s, const SliceSet& t) {
    ASSERT_EQ(s.planes.count, t.planes.count);
    for (int i = 0; i < s.planes.count; ++i) {
        const ByOrigin one = byOrigin(s, i), other = byOrigin(t, i);
        EXPECT_EQ(sliceCounts(s, i), sliceCounts(t, i));
        EXPECT_EQ(one.vertices.size(), s.vertexCount(i)) << "two of one origin";
        EXPECT_EQ(one.edges.size(), s.edgeCount(i)) << "two of one origin";
        EXPECT_EQ(one.faces.size(), s.faceCount(i)) << "two of one origin";
        ASSERT_EQ(one.vertices.size(), other.vertices.size());
        for (auto a = one.vertices.begin(), b = other.vertices.begin(); a != one.vertices.end(); ++a, ++b) {
            EXPECT_EQ(a->first, b->first);
            EXPECT_NEAR(glm::distance(a->second, b->second), 0, 1e-12);
        }
        EXPECT_EQ(one.edges, other.edges);
        EXPECT_EQ(one.faces, other.faces);
    }
}

/// What is known of convex polytopes changes how they are cut, not what comes out.
class ConvexSlices : public testing::TestWithParam<const char*> {
  protected:
    // Cuts the polytope as it is, and as if it might not be convex; returns in how many slices vertices lie.
    int expectSameAsAny(const Rotation& orientation, const Hyperplanes& planes) {
        slicer.slice(p, orientation, planes, s);
        slicerOfAny.slice(any, orientation, planes, t);
        expectSame(s, t);
        int met = 0;
        for (int i = 0; i < planes.count; ++i) {
            const auto of = std::span(s.vertexOf).subspan(s.vertexBegin[i], s.vertexCount(i));
            met += std::any_of(of.begin(), of.end(), [&](auto each) { return each >= p.edges.size(); }) ? 1 : 0;
        }
        return met;
    }

    const Polytope& p = named(GetParam());
    Polytope any = [this] {
        Polytope other = p;
        other.convex = false;
        return other;
    }();
    std::mt19937 random{9};
    Slicer slicer, slicerOfAny;
    SliceSet s, t;
};

TEST_P(ConvexSlices, areThoseOfAnyPolytope) {
    ASSERT_TRUE(p.convex);
    for (const int count : {21, 1, 101}) {
        for (int trial = 0; trial < 4; ++trial) {
            SCOPED_TRACE(testing::Message() << count << " slices, trial " << trial);
            expectSameAsAny(randomRotation(random), {-(count / 2), count, 1.8 * p.circumradius / count});
        }
    }
}

TEST_P(ConvexSlices, inHyperplanesThroughVerticesAreThoseOfAnyPolytope) {
    std::set<int> met;
    for (int trial = 0; trial < 60; ++trial) {
        SCOPED_TRACE(testing::Message() << "trial " << trial);
        Rotation orientation;
        switch (trial % 4) {
            case 0:  // what lies in the plane yz stays in w = 0
                orientation = Rotation(Turn{Plane::xw, 0.1 + 0.37 * trial, 0.2 + 0.11 * trial});
                break;
            case 1:
                orientation = Rotation(Turn{kPlanes.at(random() % 6), 0.3 + 0.2 * trial, {}});
                break;
            case 2:
                orientation = ontoW(p.vertices[random() % p.vertices.size()]);
                break;
            default:
                orientation = randomRotation(random);
        }
        // A hyperplane through the origin, or one through some vertex.
        const glm::dvec4 vertex = orientation(p.vertices[random() % p.vertices.size()]);
        const int count = trial % 3 == 0 ? 41 : 21;
        const double spacing = trial % 2 == 0 ? 1.9 * p.circumradius / count : std::abs(vertex.w) / (1 + trial % 5);
        if (spacing < 0.01 * p.circumradius) continue;
        met.insert(expectSameAsAny(orientation, {-(count / 2), count, spacing}));
        ASSERT_FALSE(HasFailure());
    }
    EXPECT_GE(met.size(), 2U) << "slices with vertices in more and in fewer hyperplanes";
}

INSTANTIATE_TEST_SUITE_P(Some, ConvexSlices,
                         testing::Values("5-cell", "8-cell", "24-cell", "120-cell", "600-cell", "snub 24-cell",
                                         "truncated 5-cell", "5,7-duoprism", "cuboctahedral prism"),
                         [](const auto& i) {
                             std::string name(i.param);
                             std::replace_if(name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
                             return "the_" + name;
                         });

/// An 8-cell in whose every cell the squares are cut into triangles: its edges and 2-faces may lie side by side in one
/// hyperplane that its cells stand on.
TEST(ConvexCut, takesCellsThatStandOnSeveralFaces) {
    const Polytope& whole = named("8-cell");
    Lists faces, cells;
    for (std::size_t f = 0; f < whole.faces.size(); ++f) {
        const auto loop = whole.faces[f];
        faces.add(std::array{loop[0], loop[1], loop[2]});
        faces.add(std::array{loop[0], loop[2], loop[3]});
    }
    for (std::size_t c = 0; c < whole.cells.size(); ++c) {
        std::vector<std::uint32_t> halves;
        for (const std::uint32_t f : whole.cells[c]) halves.insert(halves.end(), {2 * f, 2 * f + 1});
        cells.add(halves);
    }
    const Polytope p = makePolytope("halved", whole.vertices, faces, cells);
    ASSERT_TRUE(p.convex);
    const double side = 2 * std::abs(p.vertices[0].x);
    std::mt19937 random(18);
    Slicer slicer;
    SliceSet s;
    for (int trial = 0; trial < 60; ++trial) {
        const Rotation orientation = Rotation(Turn{Plane::xw, pi / 4 * (trial % 8), pi / 4 * (trial / 8 % 8)});
        slicer.slice(p, orientation, {-4, 9, trial % 2 == 0 ? side / 4 : side / std::numbers::sqrt2 / 4}, s);
        expectAllSound(p, s);
        for (int i = 0; i < s.planes.count; ++i) {
            EXPECT_NEAR(volumeOf(s, i), volumeOf(cutAt(whole, orientation, s.planes.w(i)), 0), 1e-9);
        }
        ASSERT_FALSE(HasFailure()) << "trial " << trial;
    }
}

TEST(ConvexCut, cutsPolytopesOfManyElements) {
    Polygon polygon;
    for (int i = 0; i < 130; ++i) polygon.emplace_back(std::cos(2 * pi * i / 130), std::sin(2 * pi * i / 130));
    const Polytope p = product(polygon, polygon);
    ASSERT_GT(p.edges.size(), 0x8000U);
    ASSERT_TRUE(p.convex);
    std::mt19937 random(17);
    Slicer slicer;
    SliceSet s;
    slicer.slice(p, randomRotation(random), {-1, 3, 0.4}, s);
    for (int i = 0; i < 3; ++i) {
        const SliceCounts c = sliceCounts(s, i);
        EXPECT_GT(c.faces, 100U);
        EXPECT_EQ(c.vertices + c.faces, c.edges + 2);
        EXPECT_GT(volumeOf(s, i), 0);
    }
}

/// Whether a second core helps with a large polytope depends on who else uses it.
TEST(ConvexCut, ofLargePolytopesIsTheSameOnOneAndOnTwoCores) {
    const Polytope& p = named("omnitruncated 120-cell");
    Polytope any = p;
    any.convex = false;
    std::mt19937 random(20);
    const Rotation orientation = randomRotation(random);
    const double step = p.circumradius / 10;
    // On both sides of the middle; on one; beside the polytope; a single one.
    for (const Hyperplanes& planes : {Hyperplanes{-6, 13, step}, {3, 10, step}, {12, 9, step}, {1, 1, step}}) {
        SliceSet expected;
        Slicer().slice(any, orientation, planes, expected);
        std::vector<SliceSet> got(3);
        {
            std::vector<std::jthread> threads;
            for (SliceSet& mine : got) threads.emplace_back([&] { Slicer().slice(p, orientation, planes, mine); });
        }
        for (const SliceSet& each : got) expectSame(each, expected);
        ASSERT_FALSE(HasFailure());
    }
}

/// A 2-face whose corners on a straight side waver by rounding is cut twice there, and a cell may have a dent or a
/// bump; that is nobody's harm.
TEST(ConvexCut, takesPolytopesThatAreNotQuiteConvex) {
    std::mt19937 random(3);
    Slicer slicer;
    SliceSet s;
    for (const char* name : {"120-cell", "600-cell", "5-cell", "8-cell"}) {
        for (const double much : {0.2, 0.02, 1e-4, 1e-9}) {
            Polytope p = named(name);
            std::normal_distribution<double> noise(0, much * p.circumradius);
            for (glm::dvec4& v : p.vertices)
                v += glm::dvec4(noise(random), noise(random), noise(random), noise(random));
            p.convex = true;  // as if its tolerance had let it pass
            for (int trial = 0; trial < 20; ++trial) {
                const Rotation orientation = trial < 10 ? randomRotation(random) : Rotation();
                slicer.slice(p, orientation, {-10, 21, p.circumradius / 10}, s);
                for (int i = 0; i < s.planes.count; ++i) {
                    for (auto f = s.faceBegin[i]; f < s.faceBegin[i + 1]; ++f) {
                        for (auto c = s.cornerBegin[f]; c < s.cornerBegin[f + 1]; ++c) {
                            ASSERT_LT(s.corners[c], s.vertexCount(i));
                            ASSERT_LT(s.cornerEdges[c], s.edgeCount(i));
                        }
                    }
                }
            }
        }
    }
}

}  // namespace
