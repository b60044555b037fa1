// Tests of the slices of surfaces in R⁴.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "slicing/element.hpp"
#include "slicing/element_shape.hpp"
#include "slicing/object_bytes.hpp"
#include "slicing/planar_sections.hpp"
#include "slicing/projector.hpp"
#include "slicing/slice_edges.hpp"
#include "slicing/slicer.hpp"
#include "slicing/visibility.hpp"
#include "unit/polytopes/support.hpp"
#include "unit/slicing/surface_meshes.hpp"

namespace oval4d::slicing {
namespace {

using geometry::Hyperplanes;
using geometry::Plane;
using geometry::Rotation;
using geometry::SurfaceMesh;
using support::cliffordTorus;
using support::graphOfSquare;
using support::kleinBottle;

SliceSet cut(const Object& object, const Rotation& turn, const Hyperplanes& planes) {
    SliceSet slices;
    Slicer().sliceWithoutSurfaces(object, turn, planes, slices);
    return slices;
}

/// Returns, for each vertex of slice i, how many edges end at it.
std::vector<int> degreesIn(const SliceSet& slices, int i) {
    std::vector<int> degrees(slices.vertexCount(i));
    for (auto e = slices.edgeBegin[i]; e < slices.edgeBegin[i + 1]; ++e) {
        for (const std::uint32_t v : slices.edges[e]) ++degrees.at(v);
    }
    return degrees;
}

double lengthOf(const SliceSet& slices, int i) {
    double length = 0;
    const glm::dvec3* const points = slices.vertices.data() + slices.vertexBegin[i];
    for (auto e = slices.edgeBegin[i]; e < slices.edgeBegin[i + 1]; ++e)
        length += glm::distance(points[slices.edges[e][0]], points[slices.edges[e][1]]);
    return length;
}

TEST(SurfaceSlices, OfTheUnturnedTorusAreTwoPolygons) {
    const Hyperplanes planes{-3, 7, 0.2};
    const SliceSet slices = cut(cliffordTorus(12, 40), {}, planes);
    for (int i = 0; i < planes.count; ++i) {
        if (planes.w(i) == 0) continue;  // at w = 0, vertices lie in the hyperplane
        EXPECT_EQ(slices.vertexCount(i), 24U);
        EXPECT_EQ(slices.edgeCount(i), 24U);
        EXPECT_EQ(slices.faceCount(i), 0U);
        EXPECT_NEAR(lengthOf(slices, i), 2 * 12 * 2 * std::sqrt(0.5) * std::sin(std::numbers::pi / 12), 1e-12);
        for (auto v = slices.vertexBegin[i]; v < slices.vertexBegin[i + 1]; ++v) {
            const glm::dvec3 p = slices.vertices[v];
            EXPECT_NEAR(std::hypot(p.x, p.y), std::sqrt(0.5), 1e-12);
            EXPECT_NEAR(std::hypot(p.z, planes.w(i)), std::sqrt(0.5), 3e-3);
        }
    }
}

/// Slices of the Clifford torus lie on the torus. Along an edge of the mesh, one of the two angles is constant, and the
/// other one passes along a side of a polygon.
TEST(SurfaceSlices, LieOnTheCliffordTorus) {
    std::mt19937 random(31);
    constexpr std::uint32_t kSides = 24, kOtherSides = 30;
    const double radius = std::sqrt(0.5);
    const double least = radius * std::cos(std::numbers::pi / kSides),
                 otherLeast = radius * std::cos(std::numbers::pi / kOtherSides);
    const SurfacePtr torus = cliffordTorus(kSides, kOtherSides);
    for (int round = 0; round < 10; ++round) {
        const Rotation turn = support::randomRotation(random), back = turn.inverse();
        const Hyperplanes planes{-5, 11, 0.171};
        const SliceSet slices = cut(torus, turn, planes);
        EXPECT_GT(slices.totalCounts().edges, 100U);
        for (int i = 0; i < planes.count; ++i) {
            for (auto v = slices.vertexBegin[i]; v < slices.vertexBegin[i + 1]; ++v) {
                const glm::dvec4 p = back(glm::dvec4(slices.vertices[v], planes.w(i)));
                const double one = std::hypot(p.x, p.y), other = std::hypot(p.z, p.w);
                EXPECT_NEAR(std::max(one, other), radius, 1e-12);
                EXPECT_GE(one, least - 1e-12);
                EXPECT_GE(other, otherLeast - 1e-12);
            }
        }
    }
}

TEST(SurfaceSlices, OfClosedSurfacesAreClosedPolylines) {
    std::mt19937 random(32);
    for (const SurfacePtr& surface : {cliffordTorus(24, 30), cliffordTorus(3, 3), kleinBottle(20, 16)}) {
        const auto counts = elementCounts(surface);
        EXPECT_EQ(counts[0] + counts[2], counts[1]) << "the Euler characteristic is 0";
        EXPECT_EQ(counts[3], 0U);
        for (int round = 0; round < 10; ++round) {
            const Hyperplanes planes{-10, 21, surface->circumradius / 9.7};
            const SliceSet slices = cut(surface, support::randomRotation(random), planes);
            EXPECT_GT(slices.totalCounts().edges, 0U);
            EXPECT_EQ(slices.totalCounts().faces, 0U);
            for (int i = 0; i < planes.count; ++i) {
                for (const int degree : degreesIn(slices, i))
                    EXPECT_TRUE(degree == 2) << surface->name << ", slice " << i << ": " << degree;
            }
        }
    }
}

TEST(SurfaceSlices, EndAtTheBoundary) {
    std::mt19937 random(33);
    const SurfacePtr graph = graphOfSquare(9);
    std::vector<int> facesAt(graph->edges.size());
    for (const std::uint32_t e : graph->faceEdges.items) ++facesAt[e];
    for (int round = 0; round < 10; ++round) {
        const Hyperplanes planes{-10, 21, graph->circumradius / 9.7};
        const SliceSet slices = cut(graph, support::randomRotation(random), planes);
        for (int i = 0; i < planes.count; ++i) {
            const std::vector<int> degrees = degreesIn(slices, i);
            for (std::size_t v = 0; v < degrees.size(); ++v)
                EXPECT_EQ(degrees[v], facesAt.at(slices.vertexSource[slices.vertexBegin[i] + v]));
        }
    }
}

/// A rotation that does not change w turns each slice in place.
TEST(SurfaceSlices, TurnWithTheSurface) {
    std::mt19937 random(34);
    const SurfacePtr bottle = kleinBottle(14, 10);
    const Hyperplanes planes{-4, 9, 0.431};
    for (const Plane plane : {Plane::xy, Plane::xz, Plane::yz}) {
        const Rotation first = support::randomRotation(random), turn(geometry::RotationAngles{plane, 0.7, {}});
        const SliceSet before = cut(bottle, first, planes), after = cut(bottle, turn * first, planes);
        ASSERT_EQ(after.edges, before.edges);
        EXPECT_EQ(after.vertexSource, before.vertexSource);
        EXPECT_EQ(after.edgeSource, before.edgeSource);
        for (std::size_t v = 0; v < before.vertices.size(); ++v)
            EXPECT_LT(glm::distance(after.vertices[v], glm::dvec3(turn(glm::dvec4(before.vertices[v], 0)))), 1e-9);
    }
}

/// The slices of the torus have its symmetries: the symmetries map the slices to themselves.
TEST(SurfaceSlices, HaveTheSymmetriesOfTheTorus) {
    std::mt19937 random(35);
    const SurfacePtr torus = cliffordTorus(10, 14);
    const Hyperplanes planes{-4, 9, 0.231};
    const double pi = std::numbers::pi;
    for (const Rotation& symmetry : {Rotation(geometry::RotationAngles{Plane::xy, 2 * pi / 10, {}}),
                                     Rotation(geometry::RotationAngles{Plane::zw, 2 * pi / 14, {}})}) {
        const Rotation turn = support::randomRotation(random);
        const SliceSet one = cut(torus, turn, planes), other = cut(torus, turn * symmetry, planes);
        for (int i = 0; i < planes.count; ++i) {
            EXPECT_EQ(other.edgeCount(i), one.edgeCount(i));
            EXPECT_NEAR(lengthOf(other, i), lengthOf(one, i), 1e-9);
        }
    }
}

/// The lengths of the slices satisfy the coarea formula. Their integral over w is a sum over the 2-faces: of area times
/// the slope of w on the 2-face.
TEST(SurfaceSlices, HaveTheLengthsOfTheCoareaFormula) {
    std::mt19937 random(36);
    const SurfacePtr torus = cliffordTorus(11, 8);
    const int half = 2000;
    const Hyperplanes planes{-half, 2 * half + 1, 1.0001 / half};
    for (int round = 0; round < 3; ++round) {
        const Rotation turn = support::randomRotation(random);
        const SliceSet slices = cut(torus, turn, planes);
        double integral = 0, expected = 0;
        for (int i = 0; i < planes.count; ++i) integral += planes.spacing * lengthOf(slices, i);
        for (std::size_t f = 0; f < torus->faces.size(); ++f) {  // the 2-faces are rectangles
            const auto loop = torus->faces[f];
            const glm::dvec4 a = turn(torus->vertices[loop[1]] - torus->vertices[loop[0]]);
            const glm::dvec4 b = turn(torus->vertices[loop[3]] - torus->vertices[loop[0]]);
            expected += glm::length(a) * glm::length(b) * std::hypot(a.w / glm::length(a), b.w / glm::length(b));
        }
        EXPECT_NEAR(integral, expected, 1e-3 * expected);
    }
}

TEST(SurfaceSlices, ShowTheEdgesOfFacesInTheHyperplane) {
    // If both polygons have four sides, the torus in this orientation consists of 16 squares of a tesseract.
    const double eighth = std::numbers::pi / 4;
    const Rotation turn(geometry::RotationAngles{Plane::xy, eighth, eighth});
    const SliceSet slices = cut(cliffordTorus(4, 4), turn, {-1, 3, 0.5});
    EXPECT_EQ(slices.vertexCount(1), 8U);
    EXPECT_EQ(slices.edgeCount(1), 8U) << "two squares";
    for (const int side : {0, 2}) {
        EXPECT_EQ(slices.vertexCount(side), 8U);
        EXPECT_EQ(slices.edgeCount(side), 12U) << "the edges of a cube";
        EXPECT_EQ(slices.faceCount(side), 0U);
        for (auto e = slices.edgeBegin[side]; e < slices.edgeBegin[side + 1]; ++e)
            EXPECT_GE(slices.edgeSource[e], 16U) << "an edge in the hyperplane";
    }
}

TEST(SurfaceSlices, OfFacesThatAreNotFlat) {
    // The zeros of Im z² are the real and the imaginary axis.
    const SliceSet axes = cut(graphOfSquare(2), {}, {0, 1, 1});
    EXPECT_EQ(axes.vertexCount(0), 5U);
    EXPECT_EQ(axes.edgeCount(0), 4U);
    EXPECT_NEAR(lengthOf(axes, 0), 4 * std::sqrt(2), 1e-12);
    // The hyperplane cuts a saddle twice, or touches it in two corners.
    geometry::JaggedArray face;
    face.add(std::vector<std::uint32_t>{0, 1, 2, 3});
    const auto saddle = [&](double low) {
        return std::make_shared<const SurfaceMesh>(
            geometry::makeSurfaceMesh("saddle", {{1, 0, 0, 1}, {0, 1, 0, low}, {-1, 0, 0, 1}, {0, -1, 0, low}}, face));
    };
    const SliceSet twice = cut(saddle(-1), {}, {0, 1, 1});
    EXPECT_EQ(twice.vertexCount(0), 4U);
    EXPECT_EQ(degreesIn(twice, 0), (std::vector<int>{1, 1, 1, 1}));
    const SliceSet touched = cut(saddle(0), {}, {0, 1, 1});
    EXPECT_EQ(touched.vertexCount(0), 2U);
    EXPECT_EQ(touched.edgeCount(0), 0U);
}

TEST(SurfaceSlices, AreCountedBeforeTheyAreCut) {
    std::mt19937 random(37);
    const Object torus = cliffordTorus(24, 30);
    const Rotation turn = support::randomRotation(random);
    const Hyperplanes planes{-5, 11, 0.171};
    EXPECT_EQ(sliceEdgeBound(torus, turn, planes), cut(torus, turn, planes).totalCounts().edges);
}

TEST(SurfaceSlices, AlternateWithPolytopes) {
    Slicer slicer;
    SliceSet slices;
    const Hyperplanes planes{-2, 5, 0.3};
    slicer.sliceWithoutSurfaces(support::shared("24-cell"), {}, planes, slices);
    slicer.sliceWithoutSurfaces(cliffordTorus(9, 9), {}, planes, slices);
    const SliceSet alone = cut(cliffordTorus(9, 9), {}, planes);
    EXPECT_EQ(slices.vertices, alone.vertices);
    EXPECT_EQ(slices.edges, alone.edges);
    EXPECT_EQ(slices.faceBegin, alone.faceBegin);
    EXPECT_EQ(slices.totalCounts().faces, 0U);
    EXPECT_EQ(slices.cornerBegin.back(), 0U);
}

TEST(Surface, IsProjectedWithAllItsElements) {
    const SurfacePtr torus = cliffordTorus(8, 6);
    const SliceSet slices = cut(torus, {}, {-1, 3, 0.3});
    for (const bool faces : {false, true}) {
        for (const bool culled : {false, true}) {
            SliceSet projected;
            std::vector<std::uint32_t> faceCells;
            Projector().project(torus, {}, slices,
                                {.projection = {0.2}, .cells = faces, .culled = culled, .firstSlice = 0, .endSlice = 3},
                                projected, faceCells);
            EXPECT_EQ(projected.vertexBegin[1], 48U);
            EXPECT_EQ(projected.edgeBegin[1], 96U);
            EXPECT_EQ(projected.faceBegin[1], faces ? 48U : 0U);
            EXPECT_EQ(projected.faceBegin.back(), projected.faceBegin[1]) << "slices are curves";
            EXPECT_EQ(projected.vertexBegin.size(), 5U);
            ASSERT_EQ(faceCells.size(), projected.faceSource.size());
            for (std::uint32_t f = 0; f < faceCells.size(); ++f) {
                EXPECT_EQ(faceCells[f], f);
                EXPECT_EQ(projected.faceSource[f], f);
                const std::vector<std::uint32_t> loop(projected.corners.begin() + projected.cornerBegin[f],
                                                      projected.corners.begin() + projected.cornerBegin[f + 1]);
                EXPECT_TRUE(std::ranges::equal(loop, torus->faces[f]));
            }
        }
    }
}

TEST(Surface, HasPointsAsPlanarSections) {
    const Object torus = cliffordTorus(24, 30);
    const SliceSet slices = cut(torus, {}, {0, 1, 1, 0.1});
    PlanarSections sections;
    PlanarSlicer().slice(torus, {}, slices, 0, {0.2, 0.3, 0.1, 0.1}, sections);
    for (const PlanarSection& section : sections) {
        EXPECT_TRUE(section.edges.empty());
        EXPECT_TRUE(section.boundary.empty());
        for (const std::uint32_t source : section.pointSource) EXPECT_LT(source, elementCounts(torus)[2]);
    }
    // In the plane xz, y is 0.3 on the circle in xy, and w is 0.1 on the circle in zw.
    EXPECT_EQ(sections[1].points.size(), 4U);
    for (const glm::dvec2& p : sections[1].points) {
        EXPECT_NEAR(std::abs(p.x), std::sqrt(0.5 - 0.09), 1e-2);
        EXPECT_NEAR(std::abs(p.y), std::sqrt(0.5 - 0.01), 1e-2);
    }
}

TEST(Surface, HasElementsThatCanBeMeasuredAndTurnedTo) {
    const Object torus = cliffordTorus(4, 4);
    EXPECT_FALSE(elementToTurnTo(torus, ElementKind::cell, {}));
    for (const ElementKind kind : {ElementKind::vertex, ElementKind::edge, ElementKind::face}) {
        const auto element = elementToTurnTo(torus, kind, {});
        ASSERT_TRUE(element);
        SliceSet shape;
        writeElementAsSlice(torus, *element, {}, shape);
        EXPECT_EQ(shape.vertexCount(0), kind == ElementKind::face ? 4U : static_cast<std::size_t>(kind) + 1);
        EXPECT_EQ(shape.faceCount(0), 0U);
    }
    EXPECT_NEAR(measureElement(torus, {ElementKind::face, 5}).area.value(), 1, 1e-12);
    EXPECT_NEAR(measureElement(torus, {ElementKind::edge, 5}).length.value(), 1, 1e-12);
    VisibilityBySource visibilities;
    findVisibilities(torus, {}, visibilities);
    EXPECT_TRUE(visibilities.allVisible());
    EXPECT_GE(relativeBallRadius(cliffordTorus(100, 100)), 0.016);
}

TEST(Surface, BytesBringItBack) {
    SurfaceMesh bottle = *kleinBottle(8, 6);
    bottle.originInFile = {1, 2, 3, 4};
    const Object object = std::make_shared<const SurfaceMesh>(bottle);
    std::string bytes;
    MappedFiles files;
    encodeObject(object, bytes, files);
    const SurfaceMesh decoded = *std::get<SurfacePtr>(decodeObject(bytes));
    EXPECT_EQ(decoded.vertices, bottle.vertices);
    EXPECT_EQ(decoded.edges, bottle.edges);
    EXPECT_EQ(decoded.faces, bottle.faces);
    EXPECT_EQ(decoded.faceEdges, bottle.faceEdges);
    EXPECT_EQ(decoded.serial, bottle.serial);
    EXPECT_EQ(decoded.name, bottle.name);
    EXPECT_EQ(decoded.circumradius, bottle.circumradius);
    EXPECT_EQ(decoded.convexFaces, bottle.convexFaces);
    EXPECT_EQ(decoded.originInFile, bottle.originInFile);

    std::string parts;
    serialization::ByteWriter writer(parts);
    writeObjectContent(object, writer, files);
    const auto read = [&](std::string_view from, std::size_t maxVertices = 48) {
        serialization::ByteReader reader(from);
        return readObjectContent(reader, "again", maxVertices);
    };
    const Object again = read(parts);
    EXPECT_EQ(infoOf(again).name, "again");
    EXPECT_EQ(infoOf(again).originInFile, bottle.originInFile);
    EXPECT_EQ(std::get<SurfacePtr>(again)->faces, bottle.faces);
    EXPECT_EQ(std::get<SurfacePtr>(again)->edges, bottle.edges);
    EXPECT_THROW(read(parts, 47), std::runtime_error);
    for (std::size_t size = 0; size < parts.size(); size += 37)
        EXPECT_THROW(read(std::string_view(parts).substr(0, size)), std::runtime_error);
    bottle.faces.items.back() = 48;  // an invalid vertex index
    parts.clear();
    writeObjectContent(std::make_shared<const SurfaceMesh>(bottle), writer, files);
    EXPECT_THROW(read(parts), std::runtime_error);
}

}  // namespace
}  // namespace oval4d::slicing
