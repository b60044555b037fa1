#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "geometry/catalogue.hpp"
#include "geometry/slicer.hpp"
#include "geometry_support.hpp"

namespace {

using namespace oval4d::geometry;
using namespace oval4d::geometry::support;
using std::numbers::pi;

const Polytope& named(std::string_view name) { return *polytopeOf(*findEntry(name)); }

struct Counts {
    std::size_t vertices, edges, faces;
    bool operator==(const Counts&) const = default;
};
std::ostream& operator<<(std::ostream& os, const Counts& c) {
    return os << c.vertices << '/' << c.edges << '/' << c.faces;
}
Counts countsOf(const SliceSet& s, int i = 0) { return {s.vertexCount(i), s.edgeCount(i), s.faceCount(i)}; }

/// All that must hold for a slice of a convex polytope that is a solid.
void expectClosedConvexSolid(const SliceSet& s, int slice) {
    const Counts c = countsOf(s, slice);
    ASSERT_EQ(c.vertices + c.faces, c.edges + 2) << c;
    glm::dvec3 centre(0);
    for (auto v = s.vertexBegin[slice]; v < s.vertexBegin[slice + 1]; ++v) centre += s.vertices[v] / double(c.vertices);
    std::map<std::uint32_t, int> passes;
    std::size_t sides = 0;
    for (auto f = s.faceBegin[slice]; f < s.faceBegin[slice + 1]; ++f) {
        const auto begin = s.cornerBegin[f];
        const auto end = s.cornerBegin[f + 1];
        ASSERT_GE(end - begin, 3U);
        glm::dvec3 normal(0);
        for (auto i = begin; i < end; ++i) {
            const auto next = i + 1 == end ? begin : i + 1;
            const auto& edge = s.edges[s.edgeBegin[slice] + s.cornerEdges[i]];
            ASSERT_EQ(std::set({edge[0], edge[1]}), std::set({s.corners[i], s.corners[next]}));
            ASSERT_NE(edge[0], edge[1]);
            passes[s.cornerEdges[i]] += edge[0] == s.corners[i] ? 1 : -1;
            ++sides;
            normal += glm::cross(corner(s, slice, i) - centre, corner(s, slice, next) - centre);
        }
        // Outward and flat: no vertex of the slice lies beyond the face.
        const double size = glm::length(normal);
        if (size < 1e-9) continue;
        ASSERT_GT(glm::dot(normal, corner(s, slice, begin) - centre), 0);
        for (auto v = s.vertexBegin[slice]; v < s.vertexBegin[slice + 1]; ++v) {
            ASSERT_LT(glm::dot(normal / size, s.vertices[v] - corner(s, slice, begin)), 1e-8);
        }
    }
    ASSERT_EQ(sides, 2 * c.edges);
    ASSERT_EQ(passes.size(), c.edges);
    for (const auto& [edge, sum] : passes) ASSERT_EQ(sum, 0) << "edge " << edge;
}

/// Every element says truly which 4-D element it was cut from.
void expectTrueOrigins(const Polytope& p, const SliceSet& s, int slice) {
    const auto place = [&](std::uint32_t v) { return glm::dvec4(s.vertices[v], s.planes.w(slice)); };
    const auto verticesOfEdgeOrVertex = [&](std::uint32_t of) {
        return of < p.edges.size() ? std::set<std::uint32_t>{p.edges[of][0], p.edges[of][1]}
                                   : std::set<std::uint32_t>{std::uint32_t(of - p.edges.size())};
    };
    const auto verticesOfFace = [&](std::uint32_t f) {
        return std::set<std::uint32_t>(p.faces[f].begin(), p.faces[f].end());
    };
    const auto contains = [](const auto& big, const auto& small) {
        return std::includes(big.begin(), big.end(), small.begin(), small.end());
    };
    for (auto v = s.vertexBegin[slice]; v < s.vertexBegin[slice + 1]; ++v) {
        const auto ends = verticesOfEdgeOrVertex(s.vertexOf[v]);
        const glm::dvec4 a = s.turned[*ends.begin()];
        const glm::dvec4 b = s.turned[*ends.rbegin()];
        ASSERT_NEAR(glm::distance(a, place(v)) + glm::distance(place(v), b), glm::distance(a, b), 1e-8);
    }
    for (auto e = s.edgeBegin[slice]; e < s.edgeBegin[slice + 1]; ++e) {
        const auto of = s.edgeOf[e];
        const auto whole =
            of < p.faces.size() ? verticesOfFace(of) : verticesOfEdgeOrVertex(std::uint32_t(of - p.faces.size()));
        for (const auto end : s.edges[e]) {
            ASSERT_TRUE(contains(whole, verticesOfEdgeOrVertex(s.vertexOf[s.vertexBegin[slice] + end])));
        }
    }
    for (auto f = s.faceBegin[slice]; f < s.faceBegin[slice + 1]; ++f) {
        const auto of = s.faceOf[f];
        std::set<std::uint32_t> whole;
        if (of < p.cells.size()) {
            for (const auto face : p.cells[of]) whole.merge(verticesOfFace(face));
        } else {
            whole = verticesOfFace(std::uint32_t(of - p.cells.size()));
        }
        for (auto i = s.cornerBegin[f]; i < s.cornerBegin[f + 1]; ++i) {
            ASSERT_TRUE(contains(whole, verticesOfEdgeOrVertex(s.vertexOf[s.vertexBegin[slice] + s.corners[i]])));
        }
    }
}

void expectAllSound(const Polytope& p, const SliceSet& s) {
    for (int i = 0; i < s.planes.count; ++i) {
        expectTrueOrigins(p, s, i);
        if (s.faceCount(i) > 1) expectClosedConvexSolid(s, i);
        if (testing::Test::HasFatalFailure()) return;
    }
}

class Slices : public testing::TestWithParam<CatalogueEntry> {
  protected:
    const Polytope& p = named(GetParam().name);
    Slicer slicer;
    SliceSet s;
};

TEST_P(Slices, ofRandomRotationsAreClosedConvexSolidsWithEulersFormula) {
    std::mt19937 random(11);
    const int trials = p.cells.size() > 100 ? 20 : 300;
    for (int i = 0; i < trials; ++i) {
        slicer.slice(p, randomRotation(random), {-10, 21, p.circumradius / 10}, s);
        expectAllSound(p, s);
        ASSERT_FALSE(HasFatalFailure()) << "trial " << i;
    }
}

// Quarter and eighth turns put vertices, edges, 2-faces and cells into hyperplanes, with noise in the last digits.
TEST_P(Slices, ofTurnsThatAlignElementsWithHyperplanesAreSound) {
    std::mt19937 random(12);
    const int trials = p.cells.size() > 100 ? 30 : 400;
    for (int i = 0; i < trials; ++i) {
        Rotation orientation;
        for (int k = 0; k < 3; ++k) {
            const double step = pi / (i % 2 == 0 ? 2 : 4);
            Turn turn{kPlanes.at(random() % 6), step * int(random() % 8), std::nullopt};
            if (random() % 2 == 0) turn.beta = step * int(random() % 8);
            orientation = Rotation(turn) * orientation;
        }
        const double spacing = i % 3 == 0 ? 0.25 : i % 3 == 1 ? std::numbers::sqrt2 / 4 : p.circumradius / 8;
        slicer.slice(p, orientation, {-8, 17, spacing}, s);
        expectAllSound(p, s);
        ASSERT_FALSE(HasFatalFailure()) << "trial " << i;
    }
}

TEST_P(Slices, volumesAddUpToTheHypervolume) {
    const std::map<std::string_view, double> known{{"5-cell", std::sqrt(5) / 96 * 16},
                                                   {"8-cell", 16.0},
                                                   {"16-cell", 16.0 / 6},
                                                   {"24-cell", 32.0},
                                                   {"120-cell", 15.0 / 4 * (105 + 47 * std::sqrt(5)) * 16},
                                                   {"600-cell", 25.0 / 4 * (2 + std::sqrt(5)) * 16}};
    std::mt19937 random(13);
    for (int trial = 0; trial < 3; ++trial) {
        const Rotation orientation = trial == 0 ? Rotation() : randomRotation(random);
        EXPECT_NEAR(hypervolumeBySlices(p, orientation) / known.at(p.name), 1, 1e-6);
    }
}

TEST_P(Slices, doNotDependOnTheCompanyTheyAreCutIn) {
    std::mt19937 random(14);
    const Rotation orientation = randomRotation(random);
    const double spacing = p.circumradius / 7.3;
    slicer.slice(p, orientation, {-9, 19, spacing}, s);
    SliceSet few;
    slicer.slice(p, orientation, {-1, 3, spacing}, few);
    for (int i = 0; i < 3; ++i) {
        ASSERT_EQ(countsOf(few, i), countsOf(s, i + 8));
        EXPECT_NEAR(volumeOf(few, i), volumeOf(s, i + 8), 1e-12 * std::pow(p.circumradius, 3));
    }
}

TEST_P(Slices, beyondTheCircumscribedSphereAreEmpty) {
    slicer.slice(p, Rotation(), {1, 5, 1.001 * p.circumradius}, s);
    for (int i = 0; i < 5; ++i) EXPECT_EQ(countsOf(s, i), (Counts{0, 0, 0}));
}

INSTANTIATE_TEST_SUITE_P(Regular, Slices, testing::ValuesIn(catalogue().first(6)), [](const auto& i) {
    std::string name(i.param.name);
    std::replace(name.begin(), name.end(), '-', '_');
    return "the_" + name;
});

TEST(Sections, ofTheTesseractCellFirstAreCubes) {
    const Polytope& p = named("8-cell");
    for (const double w : {-1.0, -0.3, 0.0, 0.9999, 1.0}) {
        const SliceSet s = cutAt(p, Rotation(), w);
        EXPECT_EQ(countsOf(s), (Counts{8, 12, 6})) << w;
        EXPECT_NEAR(volumeOf(s, 0), 8, 1e-12);
    }
    EXPECT_EQ(countsOf(cutAt(p, Rotation(), 1.0001)), (Counts{0, 0, 0}));
}

TEST(Sections, ofTheTesseractVertexFirst) {
    const Polytope& p = named("8-cell");
    const Rotation orientation = ontoW({1, 1, 1, 1});
    EXPECT_EQ(countsOf(cutAt(p, orientation, 2)), (Counts{1, 0, 0}));
    EXPECT_EQ(countsOf(cutAt(p, orientation, 1.5)), (Counts{4, 6, 4}));    // tetrahedron
    EXPECT_EQ(countsOf(cutAt(p, orientation, 1)), (Counts{4, 6, 4}));      // through four vertices
    EXPECT_EQ(countsOf(cutAt(p, orientation, 0.5)), (Counts{12, 18, 8}));  // truncated tetrahedron
    const SliceSet middle = cutAt(p, orientation, 0);
    EXPECT_EQ(countsOf(middle), (Counts{6, 12, 8}));  // a regular octahedron through six vertices
    EXPECT_NEAR(volumeOf(middle, 0), std::numbers::sqrt2 / 3 * std::pow(2 * std::numbers::sqrt2, 3), 1e-10);
}

TEST(Sections, ofThe16CellAtZeroIsAnOctahedronOfSixVertices) {
    const Polytope& p = named("16-cell");
    const SliceSet s = cutAt(p, Rotation(), 0);
    EXPECT_EQ(countsOf(s), (Counts{6, 12, 8}));
    for (const auto of : s.vertexOf) EXPECT_GE(of, p.edges.size());
    for (const auto of : s.edgeOf) EXPECT_GE(of, p.faces.size());
    for (const auto of : s.faceOf) EXPECT_GE(of, p.cells.size());
    EXPECT_EQ(countsOf(cutAt(p, ontoW({1, 1, 1, 1}), std::sqrt(2) / 2)), (Counts{4, 6, 4}));  // a whole cell
}

TEST(Sections, ofThe24Cell) {
    const Polytope& p = named("24-cell");
    EXPECT_EQ(countsOf(cutAt(p, Rotation(), 0)), (Counts{14, 24, 12}));  // rhombic dodecahedron
    EXPECT_EQ(countsOf(cutAt(p, Rotation(), 1)), (Counts{8, 12, 6}));    // cube
    const Rotation cellFirst = ontoW({1, 1, 0, 0});
    EXPECT_EQ(countsOf(cutAt(p, cellFirst, std::sqrt(2))), (Counts{6, 12, 8}));  // the cell itself
    EXPECT_EQ(countsOf(cutAt(p, cellFirst, 0)), (Counts{12, 24, 14}));           // cuboctahedron
}

TEST(Sections, ofThe600CellVertexFirstHaveTheKnownLayers) {
    const Polytope& p = named("600-cell");
    const Rotation orientation = ontoW(p.vertices[77]);
    const double r = p.circumradius;
    const double phi = std::numbers::phi;
    const std::vector<std::pair<double, std::size_t>> layers{
        {1, 1}, {phi / 2, 12}, {0.5, 20}, {0.5 / phi, 12}, {0, 30}};
    for (const auto& [level, lying] : layers) {
        for (const double w : {r * level, -r * level}) {
            const SliceSet s = cutAt(p, orientation, w);
            const auto count = std::count_if(s.vertexOf.begin(), s.vertexOf.end(),
                                             [&](std::uint32_t of) { return of >= p.edges.size(); });
            EXPECT_EQ(static_cast<std::size_t>(count), lying) << level;
        }
    }
    EXPECT_EQ(countsOf(cutAt(p, orientation, r * phi / 2)), (Counts{12, 30, 20}));  // an icosahedron of whole faces
}

// The paper's third and sixth figures: after R_yw(π/2) two vertices lie in w = 0, after four steps of the double
// rotation a 2-face does; rounding leaves them near 1e−16 on either side.
TEST(Sections, ofThePapersPanelsAreExact) {
    const Polytope& p = named("5-cell");
    Rotation quarter;
    for (int i = 0; i < 3; ++i) quarter = Rotation(Turn{Plane::yw, pi / 6, {}}) * quarter;
    const SliceSet third = cutAt(p, quarter, 0);
    EXPECT_EQ(std::count_if(third.vertexOf.begin(), third.vertexOf.end(), [](auto of) { return of >= 10; }), 2);
    EXPECT_EQ(countsOf(third), (Counts{4, 6, 4}));

    Rotation four;
    for (int i = 0; i < 4; ++i) four = Rotation(Turn{Plane::xw, pi / 8, pi / std::sqrt(3) - pi / 8}) * four;
    const SliceSet sixth = cutAt(p, four, 0);
    EXPECT_EQ(countsOf(sixth), (Counts{4, 6, 4}));
    EXPECT_EQ(std::count_if(sixth.vertexOf.begin(), sixth.vertexOf.end(), [](auto of) { return of >= 10; }), 3);
    EXPECT_EQ(std::count_if(sixth.faceOf.begin(), sixth.faceOf.end(), [](auto of) { return of >= 5; }), 1);
    expectClosedConvexSolid(sixth, 0);
}

TEST(Symmetry, ofThePolytopeLeavesTheSlicesAlone) {
    std::mt19937 random(15);
    // A vertex of the 24-cell or 600-cell, as a unit quaternion, maps the polytope to itself by multiplication;
    // quarter turns map the tesseract and the 16-cell to themselves.
    for (const auto name : {"8-cell", "16-cell", "24-cell", "600-cell"}) {
        const Polytope& p = named(name);
        const bool group = p.cells.size() % 24 == 0;
        for (int trial = 0; trial < 5; ++trial) {
            const auto quaternion = [&] {
                const auto& v = p.vertices[random() % p.vertices.size()];
                return glm::dquat(v.w, v.x, v.y, v.z);
            };
            const glm::dquat left = quaternion();
            const Rotation symmetry =
                group ? Rotation(left, quaternion())
                      : Rotation(Turn{kPlanes.at(random() % 6), pi / 2, pi / 2 * int(random() % 4)});
            const Rotation orientation = randomRotation(random);
            SliceSet a;
            SliceSet b;
            Slicer slicer;
            const Hyperplanes planes{-5, 11, p.circumradius / 5.5};
            slicer.slice(p, orientation, planes, a);
            slicer.slice(p, orientation * symmetry, planes, b);
            for (int i = 0; i < planes.count; ++i) {
                ASSERT_EQ(countsOf(a, i), countsOf(b, i)) << name;
                for (auto v = a.vertexBegin[i]; v < a.vertexBegin[i + 1]; ++v) {
                    double nearest = 1e9;
                    for (auto u = b.vertexBegin[i]; u < b.vertexBegin[i + 1]; ++u) {
                        nearest = std::min(nearest, glm::distance(a.vertices[v], b.vertices[u]));
                    }
                    ASSERT_LT(nearest, 1e-9) << name;
                }
            }
        }
    }
}

TEST(Slicer, keepsItsMemory) {
    const Polytope& p = named("600-cell");
    Slicer slicer;
    SliceSet s;
    std::mt19937 random(16);
    for (int i = 0; i < 50; ++i) slicer.slice(p, randomRotation(random), {-10, 21, p.circumradius / 10}, s);
    const auto* vertices = s.vertices.data();
    const auto capacity = s.vertices.capacity();
    slicer.slice(p, Rotation(), {-10, 21, p.circumradius / 10}, s);
    EXPECT_EQ(s.vertices.data(), vertices);
    EXPECT_EQ(s.vertices.capacity(), capacity);
}

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
        EXPECT_EQ(countsOf(s, i), countsOf(t, i));
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
TEST(Slicer, TakesCellsThatStandOnSeveralFaces) {
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

TEST(Slicer, CutsConvexPolytopesOfManyElements) {
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
        const Counts c = countsOf(s, i);
        EXPECT_GT(c.faces, 100U);
        EXPECT_EQ(c.vertices + c.faces, c.edges + 2);
        EXPECT_GT(volumeOf(s, i), 0);
    }
}

/// A 2-face whose corners on a straight side waver by rounding is cut twice there, and a cell may have a dent or a
/// bump; that is nobody's harm.
TEST(Slicer, TakesConvexPolytopesThatAreNotQuite) {
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
