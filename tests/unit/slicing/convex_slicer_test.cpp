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

#include "unit/slicing/soundness.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::support;
using namespace oval4d::slicing;
using std::numbers::pi;

/// The elements of a slice, found by their source numbers. So neither the order of the elements nor the corner at which
/// a loop begins matters.
struct BySource {
    std::map<std::uint32_t, glm::dvec3> vertices;
    // Per edge: the source numbers of its ends (from which elements they were cut).
    std::map<std::uint32_t, std::set<std::uint32_t>> edges;
    /// Per face: the source numbers of its corners, each with that of the edge after the corner. The list begins with
    /// the least pair.
    std::map<std::uint32_t, std::vector<std::array<std::uint32_t, 2>>> faces;
};

BySource bySource(const SliceSet& s, int slice) {
    BySource out;
    const auto* vertexSource = s.vertexSource.data() + s.vertexBegin[slice];
    const auto* edgeSource = s.edgeSource.data() + s.edgeBegin[slice];
    for (auto v = s.vertexBegin[slice]; v < s.vertexBegin[slice + 1]; ++v)
        out.vertices[s.vertexSource[v]] = s.vertices[v];
    for (auto e = s.edgeBegin[slice]; e < s.edgeBegin[slice + 1]; ++e) {
        out.edges[s.edgeSource[e]] = {vertexSource[s.edges[e][0]], vertexSource[s.edges[e][1]]};
    }
    for (auto f = s.faceBegin[slice]; f < s.faceBegin[slice + 1]; ++f) {
        auto& loop = out.faces[s.faceSource[f]];
        for (auto i = s.cornerBegin[f]; i < s.cornerBegin[f + 1]; ++i) {
            loop.push_back({vertexSource[s.corners[i]], edgeSource[s.cornerEdges[i]]});
        }
        std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    }
    return out;
}

void expectSame(const SliceSet& s, const SliceSet& t) {
    ASSERT_EQ(s.planes.count, t.planes.count);
    for (int i = 0; i < s.planes.count; ++i) {
        const BySource one = bySource(s, i), other = bySource(t, i);
        EXPECT_EQ(sliceCounts(s, i), sliceCounts(t, i));
        EXPECT_EQ(one.vertices.size(), s.vertexCount(i)) << "two elements have one source";
        EXPECT_EQ(one.edges.size(), s.edgeCount(i)) << "two elements have one source";
        EXPECT_EQ(one.faces.size(), s.faceCount(i)) << "two elements have one source";
        ASSERT_EQ(one.vertices.size(), other.vertices.size());
        for (auto a = one.vertices.begin(), b = other.vertices.begin(); a != one.vertices.end(); ++a, ++b) {
            EXPECT_EQ(a->first, b->first);
            EXPECT_NEAR(glm::distance(a->second, b->second), 0, 1e-12);
        }
        EXPECT_EQ(one.edges, other.edges);
        EXPECT_EQ(one.faces, other.faces);
    }
}

/// Convex polytopes have the same slices whether they are cut by the method for convex polytopes or by the general
/// method.
class ConvexSlices : public testing::TestWithParam<const char*> {
  protected:
    // Expects that both methods, the one for convex polytopes and the general one, give the same slices of the
    // polytope. Returns how many of the slices contain vertices of the polytope.
    int expectSameAsGeneral(const geometry::Rotation& orientation, const geometry::Hyperplanes& planes) {
        slicer.slice(p, orientation, planes, s);
        generalSlicer.slice(general, orientation, planes, t);
        expectSame(s, t);
        int met = 0;
        for (int i = 0; i < planes.count; ++i) {
            const auto sources = std::span(s.vertexSource).subspan(s.vertexBegin[i], s.vertexCount(i));
            met += std::ranges::any_of(sources, [&](auto source) { return source >= p.edges.size(); }) ? 1 : 0;
        }
        return met;
    }

    const polytopes::Polytope& p = named(GetParam());
    polytopes::Polytope general = [this] {
        polytopes::Polytope other = p;
        other.convex = false;
        return other;
    }();
    std::mt19937 random{9};
    CellComplexSlicer slicer, generalSlicer;
    SliceSet s, t;
};

TEST_P(ConvexSlices, areThoseOfTheGeneralSlicer) {
    ASSERT_TRUE(p.convex);
    for (const int count : {21, 1, 101}) {
        for (int trial = 0; trial < 4; ++trial) {
            SCOPED_TRACE(testing::Message() << count << " slices, trial " << trial);
            expectSameAsGeneral(randomRotation(random), {-(count / 2), count, 1.8 * p.circumradius / count});
        }
    }
}

TEST_P(ConvexSlices, inHyperplanesThroughVerticesAreThoseOfTheGeneralSlicer) {
    std::set<int> met;
    for (int trial = 0; trial < 60; ++trial) {
        SCOPED_TRACE(testing::Message() << "trial " << trial);
        geometry::Rotation orientation;
        switch (trial % 4) {
            case 0:  // vertices in the plane yz stay in the hyperplane w = 0
                orientation = geometry::Rotation(
                    geometry::RotationAngles{geometry::Plane::xw, 0.1 + 0.37 * trial, 0.2 + 0.11 * trial});
                break;
            case 1:
                orientation = geometry::Rotation(
                    geometry::RotationAngles{geometry::kPlanes.at(random() % 6), 0.3 + 0.2 * trial, {}});
                break;
            case 2:
                orientation = ontoW(p.vertices[random() % p.vertices.size()]);
                break;
            default:
                orientation = randomRotation(random);
        }
        // The hyperplanes include one through the origin, or one through some vertex.
        const glm::dvec4 vertex = orientation(p.vertices[random() % p.vertices.size()]);
        const int count = trial % 3 == 0 ? 41 : 21;
        const double spacing = trial % 2 == 0 ? 1.9 * p.circumradius / count : std::abs(vertex.w) / (1 + trial % 5);
        if (spacing < 0.01 * p.circumradius) continue;
        met.insert(expectSameAsGeneral(orientation, {-(count / 2), count, spacing}));
        ASSERT_FALSE(HasFailure());
    }
    EXPECT_GE(met.size(), 2U) << "the trials have different numbers of slices with vertices";
}

INSTANTIATE_TEST_SUITE_P(Some, ConvexSlices,
                         testing::Values("5-cell", "8-cell", "24-cell", "120-cell", "600-cell", "snub 24-cell",
                                         "truncated 5-cell", "5,7-duoprism", "cuboctahedral prism"),
                         [](const auto& i) {
                             std::string name(i.param);
                             std::replace_if(name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
                             return "the_" + name;
                         });

/// Slices of a polytope are correct even if a hyperplane contains several coplanar 2-faces of a cell. The polytope is
/// an 8-cell whose squares are divided into triangles.
TEST(ConvexSlicer, handlesCellsWithSeveralFacesInAHyperplane) {
    const polytopes::Polytope& whole = named("8-cell");
    geometry::JaggedArray faces, cells;
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
    const polytopes::Polytope p = polytopes::makePolytope("halved", whole.vertices, faces, cells);
    ASSERT_TRUE(p.convex);
    const double side = 2 * std::abs(p.vertices[0].x);
    std::mt19937 random(18);
    CellComplexSlicer slicer;
    SliceSet s;
    for (int trial = 0; trial < 60; ++trial) {
        const geometry::Rotation orientation = geometry::Rotation(
            geometry::RotationAngles{geometry::Plane::xw, pi / 4 * (trial % 8), pi / 4 * (trial / 8 % 8)});
        slicer.slice(p, orientation, {-4, 9, trial % 2 == 0 ? side / 4 : side / std::numbers::sqrt2 / 4}, s);
        expectAllSound(p, s);
        for (int i = 0; i < s.planes.count; ++i) {
            EXPECT_NEAR(volumeOf(s, i), volumeOf(cutAt(whole, orientation, s.planes.w(i)), 0), 1e-9);
        }
        ASSERT_FALSE(HasFailure()) << "trial " << trial;
    }
}

TEST(ConvexSlicer, handlesManyElements) {
    Polygon polygon;
    for (int i = 0; i < 130; ++i) polygon.emplace_back(std::cos(2 * pi * i / 130), std::sin(2 * pi * i / 130));
    const polytopes::Polytope p = product(polygon, polygon);
    ASSERT_GT(p.edges.size(), 0x8000U);
    ASSERT_TRUE(p.convex);
    std::mt19937 random(17);
    CellComplexSlicer slicer;
    SliceSet s;
    slicer.slice(p, randomRotation(random), {-1, 3, 0.4}, s);
    for (int i = 0; i < 3; ++i) {
        const ElementsOfSlice c = sliceCounts(s, i);
        EXPECT_GT(c.faces, 100U);
        EXPECT_EQ(c.vertices + c.faces, c.edges + 2);
        EXPECT_GT(volumeOf(s, i), 0);
    }
}

/// The slices are the same on one and on two cores. Whether the second core is available depends on the other threads.
TEST(ConvexSlicer, givesTheSameSlicesOnOneAndOnTwoCores) {
    const polytopes::Polytope& p = named("omnitruncated 120-cell");
    polytopes::Polytope general = p;
    general.convex = false;
    std::mt19937 random(20);
    const geometry::Rotation orientation = randomRotation(random);
    const double step = p.circumradius / 10;
    // Hyperplanes on both sides of the center, on one side, outside the polytope, and a single hyperplane.
    for (const geometry::Hyperplanes& planes :
         {geometry::Hyperplanes{-6, 13, step}, {3, 10, step}, {12, 9, step}, {1, 1, step}}) {
        SliceSet expected;
        CellComplexSlicer().slice(general, orientation, planes, expected);
        std::vector<SliceSet> got(3);
        {
            std::vector<std::jthread> threads;
            for (SliceSet& mine : got)
                threads.emplace_back([&] { CellComplexSlicer().slice(p, orientation, planes, mine); });
        }
        for (const SliceSet& each : got) expectSame(each, expected);
        ASSERT_FALSE(HasFailure());
    }
}

/// Slices of polytopes that are not quite convex are valid data. With rounded vertices, a hyperplane may cut a 2-face
/// twice, and cells may be slightly nonconvex.
TEST(ConvexSlicer, isSafeForPolytopesThatAreNotQuiteConvex) {
    std::mt19937 random(3);
    CellComplexSlicer slicer;
    SliceSet s;
    for (const char* name : {"120-cell", "600-cell", "5-cell", "8-cell"}) {
        for (const double much : {0.2, 0.02, 1e-4, 1e-9}) {
            polytopes::Polytope p = named(name);
            std::normal_distribution<double> noise(0, much * p.circumradius);
            for (glm::dvec4& v : p.vertices)
                v += glm::dvec4(noise(random), noise(random), noise(random), noise(random));
            p.convex = true;  // as if the vertices were within the tolerance of the convexity test
            for (int trial = 0; trial < 20; ++trial) {
                const geometry::Rotation orientation = trial < 10 ? randomRotation(random) : geometry::Rotation();
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
