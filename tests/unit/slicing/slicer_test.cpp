#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "unit/slicing/soundness.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::support;
using namespace oval4d::slicing;
using std::numbers::pi;

class Slices : public testing::TestWithParam<polytopes::CatalogueEntry> {
  protected:
    const polytopes::Polytope& p = named(GetParam().name);
    CellComplexSlicer slicer;
    SliceSet s;
};

TEST_P(Slices, inRandomOrientationAreClosedConvexPolyhedra) {
    std::mt19937 random(11);
    const int trials = p.cells.size() > 100 ? 20 : 300;
    for (int i = 0; i < trials; ++i) {
        slicer.slice(p, randomRotation(random), {-10, 21, p.circumradius / 10}, s);
        expectAllSound(p, s);
        ASSERT_FALSE(HasFatalFailure()) << "trial " << i;
    }
}

// Slices through vertices, edges, 2-faces and cells are valid polyhedra. Quarter and eighth turns put these elements
// into hyperplanes, up to rounding errors.
TEST_P(Slices, throughVerticesEdgesFacesAndCellsAreSound) {
    std::mt19937 random(12);
    const int trials = p.cells.size() > 100 ? 30 : 400;
    for (int i = 0; i < trials; ++i) {
        geometry::Rotation orientation;
        for (int k = 0; k < 3; ++k) {
            const double step = pi / (i % 2 == 0 ? 2 : 4);
            const geometry::Plane plane = geometry::kPlanes.at(random() % 6);
            geometry::RotationAngles turn(plane, step * int(random() % 8));
            if (random() % 2 == 0) turn[orthogonalComplement(plane)] = step * int(random() % 8);
            orientation = geometry::Rotation(turn) * orientation;
        }
        const double spacing = i % 3 == 0 ? 0.25 : i % 3 == 1 ? std::numbers::sqrt2 / 4 : p.circumradius / 8;
        slicer.slice(p, orientation, {-8, 17, spacing}, s);
        expectAllSound(p, s);
        ASSERT_FALSE(HasFatalFailure()) << "trial " << i;
    }
}

TEST_P(Slices, haveVolumesThatIntegrateToTheHypervolume) {
    const std::map<std::string_view, double> known{{"5-cell", std::sqrt(5) / 96 * 16},
                                                   {"8-cell", 16.0},
                                                   {"16-cell", 16.0 / 6},
                                                   {"24-cell", 32.0},
                                                   {"120-cell", 15.0 / 4 * (105 + 47 * std::sqrt(5)) * 16},
                                                   {"600-cell", 25.0 / 4 * (2 + std::sqrt(5)) * 16}};
    std::mt19937 random(13);
    for (int trial = 0; trial < 3; ++trial) {
        const geometry::Rotation orientation = trial == 0 ? geometry::Rotation() : randomRotation(random);
        EXPECT_NEAR(hypervolumeBySlices(p, orientation) / known.at(p.name), 1, 1e-6);
    }
}

TEST_P(Slices, doNotDependOnTheOtherHyperplanes) {
    std::mt19937 random(14);
    const geometry::Rotation orientation = randomRotation(random);
    const double spacing = p.circumradius / 7.3;
    slicer.slice(p, orientation, {-9, 19, spacing}, s);
    SliceSet few;
    slicer.slice(p, orientation, {-1, 3, spacing}, few);
    for (int i = 0; i < 3; ++i) {
        ASSERT_EQ(sliceCounts(few, i), sliceCounts(s, i + 8));
        EXPECT_NEAR(volumeOf(few, i), volumeOf(s, i + 8), 1e-12 * std::pow(p.circumradius, 3));
    }
}

TEST_P(Slices, beyondTheCircumscribedSphereAreEmpty) {
    slicer.slice(p, geometry::Rotation(), {1, 5, 1.001 * p.circumradius}, s);
    for (int i = 0; i < 5; ++i) EXPECT_EQ(sliceCounts(s, i), (ElementsOfSlice{0, 0, 0}));
}

INSTANTIATE_TEST_SUITE_P(Regular, Slices, testing::ValuesIn(polytopes::catalogue().first(6)), [](const auto& i) {
    std::string name(i.param.name);
    std::replace(name.begin(), name.end(), '-', '_');
    return "the_" + name;
});

TEST(Sections, ofTheTesseractCellFirstAreCubes) {
    const polytopes::Polytope& p = named("8-cell");
    for (const double w : {-1.0, -0.3, 0.0, 0.9999, 1.0}) {
        const SliceSet s = cutAt(p, geometry::Rotation(), w);
        EXPECT_EQ(sliceCounts(s), (ElementsOfSlice{8, 12, 6})) << w;
        EXPECT_NEAR(volumeOf(s, 0), 8, 1e-12);
    }
    EXPECT_EQ(sliceCounts(cutAt(p, geometry::Rotation(), 1.0001)), (ElementsOfSlice{0, 0, 0}));
}

TEST(Sections, ofTheTesseractVertexFirst) {
    const polytopes::Polytope& p = named("8-cell");
    const geometry::Rotation orientation = ontoW({1, 1, 1, 1});
    EXPECT_EQ(sliceCounts(cutAt(p, orientation, 2)), (ElementsOfSlice{1, 0, 0}));
    EXPECT_EQ(sliceCounts(cutAt(p, orientation, 1.5)), (ElementsOfSlice{4, 6, 4}));  // the slice is a tetrahedron
    EXPECT_EQ(sliceCounts(cutAt(p, orientation, 1)), (ElementsOfSlice{4, 6, 4}));    // a section through four vertices
    // The slice is a truncated tetrahedron.
    EXPECT_EQ(sliceCounts(cutAt(p, orientation, 0.5)), (ElementsOfSlice{12, 18, 8}));
    const SliceSet middle = cutAt(p, orientation, 0);
    EXPECT_EQ(sliceCounts(middle), (ElementsOfSlice{6, 12, 8}));  // a regular octahedron through six vertices
    EXPECT_NEAR(volumeOf(middle, 0), std::numbers::sqrt2 / 3 * std::pow(2 * std::numbers::sqrt2, 3), 1e-10);
}

TEST(Sections, ofThe16CellAtZeroIsAnOctahedronOfSixVertices) {
    const polytopes::Polytope& p = named("16-cell");
    const SliceSet s = cutAt(p, geometry::Rotation(), 0);
    EXPECT_EQ(sliceCounts(s), (ElementsOfSlice{6, 12, 8}));
    for (const auto source : s.vertexSource) EXPECT_GE(source, p.edges.size());
    for (const auto source : s.edgeSource) EXPECT_GE(source, p.faces.size());
    for (const auto source : s.faceSource) EXPECT_GE(source, p.cells.size());
    // The section is a cell.
    EXPECT_EQ(sliceCounts(cutAt(p, ontoW({1, 1, 1, 1}), std::sqrt(2) / 2)), (ElementsOfSlice{4, 6, 4}));
}

TEST(Sections, ofThe24Cell) {
    const polytopes::Polytope& p = named("24-cell");
    // The slice is a rhombic dodecahedron.
    EXPECT_EQ(sliceCounts(cutAt(p, geometry::Rotation(), 0)), (ElementsOfSlice{14, 24, 12}));
    EXPECT_EQ(sliceCounts(cutAt(p, geometry::Rotation(), 1)), (ElementsOfSlice{8, 12, 6}));  // the slice is a cube
    const geometry::Rotation cellFirst = ontoW({1, 1, 0, 0});
    EXPECT_EQ(sliceCounts(cutAt(p, cellFirst, std::sqrt(2))), (ElementsOfSlice{6, 12, 8}));  // the section is a cell
    EXPECT_EQ(sliceCounts(cutAt(p, cellFirst, 0)), (ElementsOfSlice{12, 24, 14}));  // the slice is a cuboctahedron
}

TEST(Sections, ofThe600CellVertexFirstHaveTheKnownLayers) {
    const polytopes::Polytope& p = named("600-cell");
    const geometry::Rotation orientation = ontoW(p.vertices[77]);
    const double r = p.circumradius;
    const double phi = std::numbers::phi;
    const std::vector<std::pair<double, std::size_t>> layers{
        {1, 1}, {phi / 2, 12}, {0.5, 20}, {0.5 / phi, 12}, {0, 30}};
    for (const auto& [level, lying] : layers) {
        for (const double w : {r * level, -r * level}) {
            const SliceSet s = cutAt(p, orientation, w);
            const auto count = std::count_if(s.vertexSource.begin(), s.vertexSource.end(),
                                             [&](std::uint32_t source) { return source >= p.edges.size(); });
            EXPECT_EQ(static_cast<std::size_t>(count), lying) << level;
        }
    }
    EXPECT_EQ(sliceCounts(cutAt(p, orientation, r * phi / 2)),
              (ElementsOfSlice{12, 30, 20}));  // the slice is an icosahedron; its faces are 2-faces of the polytope
}

// The sections in the third and sixth figures of Kageyama's paper are exact. After R_yw(π/2), two vertices lie in w =
// 0; after four steps of the double rotation, a 2-face lies in w = 0. Because of rounding, their w are near 1e−16, with
// either sign.
TEST(Sections, ofThePapersPanelsAreExact) {
    const polytopes::Polytope& p = named("5-cell");
    geometry::Rotation quarter;
    for (int i = 0; i < 3; ++i)
        quarter = geometry::Rotation(geometry::RotationAngles{geometry::Plane::yw, pi / 6, {}}) * quarter;
    const SliceSet third = cutAt(p, quarter, 0);
    EXPECT_EQ(
        std::count_if(third.vertexSource.begin(), third.vertexSource.end(), [](auto source) { return source >= 10; }),
        2);
    EXPECT_EQ(sliceCounts(third), (ElementsOfSlice{4, 6, 4}));

    geometry::Rotation four;
    for (int i = 0; i < 4; ++i)
        four = geometry::Rotation(geometry::RotationAngles{geometry::Plane::xw, pi / 8, pi / std::sqrt(3) - pi / 8}) *
               four;
    const SliceSet sixth = cutAt(p, four, 0);
    EXPECT_EQ(sliceCounts(sixth), (ElementsOfSlice{4, 6, 4}));
    EXPECT_EQ(
        std::count_if(sixth.vertexSource.begin(), sixth.vertexSource.end(), [](auto source) { return source >= 10; }),
        3);
    EXPECT_EQ(std::count_if(sixth.faceSource.begin(), sixth.faceSource.end(), [](auto source) { return source >= 5; }),
              1);
    expectClosedConvexSolid(sixth, 0);
}

TEST(Symmetry, ofThePolytopePreservesTheSlices) {
    std::mt19937 random(15);
    // Multiplication by a vertex, as a unit quaternion, maps the 24-cell and the 600-cell to themselves. Quarter turns
    // map the tesseract and the 16-cell to themselves.
    for (const auto name : {"8-cell", "16-cell", "24-cell", "600-cell"}) {
        const polytopes::Polytope& p = named(name);
        const bool group = p.cells.size() % 24 == 0;
        for (int trial = 0; trial < 5; ++trial) {
            const auto quaternion = [&] {
                const auto& v = p.vertices[random() % p.vertices.size()];
                return glm::dquat(v.w, v.x, v.y, v.z);
            };
            const glm::dquat left = quaternion();
            const geometry::Rotation symmetry =
                group ? geometry::Rotation(left, quaternion())
                      : geometry::Rotation(geometry::RotationAngles{geometry::kPlanes.at(random() % 6), pi / 2,
                                                                    pi / 2 * int(random() % 4)});
            const geometry::Rotation orientation = randomRotation(random);
            SliceSet a;
            SliceSet b;
            CellComplexSlicer slicer;
            const geometry::Hyperplanes planes{-5, 11, p.circumradius / 5.5};
            slicer.slice(p, orientation, planes, a);
            slicer.slice(p, orientation * symmetry, planes, b);
            for (int i = 0; i < planes.count; ++i) {
                ASSERT_EQ(sliceCounts(a, i), sliceCounts(b, i)) << name;
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

TEST(CellComplexSlicer, reusesItsMemory) {
    const polytopes::Polytope& p = named("600-cell");
    CellComplexSlicer slicer;
    SliceSet s;
    std::mt19937 random(16);
    for (int i = 0; i < 50; ++i) slicer.slice(p, randomRotation(random), {-10, 21, p.circumradius / 10}, s);
    const auto* vertices = s.vertices.data();
    const auto capacity = s.vertices.capacity();
    slicer.slice(p, geometry::Rotation(), {-10, 21, p.circumradius / 10}, s);
    EXPECT_EQ(s.vertices.data(), vertices);
    EXPECT_EQ(s.vertices.capacity(), capacity);
}

}  // namespace
