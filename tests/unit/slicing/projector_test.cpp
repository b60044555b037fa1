// Tests of the projections of whole objects and of their slices, and of the hyperplanes of cells.

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "geometry/point_cloud.hpp"
#include "slicing/projector.hpp"
#include "slicing/slicer.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::slicing {
namespace {

using polytopes::Polytope;
using support::named;
using support::objectOf;

/// Returns, for each cell, the set of its vertices.
std::vector<std::set<std::uint32_t>> verticesOfCells(const Polytope& p) {
    std::vector<std::set<std::uint32_t>> all(p.cells.size());
    for (std::size_t c = 0; c < all.size(); ++c) {
        for (const auto f : p.cells[c]) all[c].insert(p.faces[f].begin(), p.faces[f].end());
    }
    return all;
}

TEST(CellHyperplanes, SupportConvexPolytopesFromOutside) {
    for (const char* name : {"5-cell", "tesseract", "24-cell", "600-cell", "truncated 120-cell", "5,7-duoprism"}) {
        SCOPED_TRACE(name);
        const Polytope& p = named(name);
        std::vector<glm::dvec4> normals;
        std::vector<double> offsets;
        findCellHyperplanes(objectOf(p), normals, offsets);
        ASSERT_EQ(normals.size(), p.cells.size());
        const auto vertices = verticesOfCells(p);
        glm::dvec4 sum(0);
        for (std::size_t c = 0; c < normals.size(); ++c) {
            const double length = glm::length(normals[c]);
            ASSERT_GT(length, 0);
            sum += normals[c];
            for (std::uint32_t v = 0; v < p.vertices.size(); ++v) {
                const double height = (glm::dot(normals[c], p.vertices[v]) - offsets[c]) / length;
                if (vertices[c].contains(v)) {
                    ASSERT_NEAR(height, 0, 1e-9);
                } else {
                    ASSERT_LT(height, -1e-6);
                }
            }
        }
        // The area vectors of a closed surface add up to zero (Minkowski).
        EXPECT_LT(glm::length(sum), 1e-9 * glm::length(normals[0]) * static_cast<double>(normals.size()));
    }
}

TEST(CellHyperplanes, GiveTheHypervolumeOfRegularPolytopes) {
    // The hypervolume of the polytope is the sum over its cells of volume · height / 4 (Coxeter, Regular Polytopes,
    // table I). The length of a cell's normal is six times the volume of the cell, so the offset is six times volume ·
    // height.
    const auto hypervolume = [](const char* name) {
        std::vector<glm::dvec4> normals;
        std::vector<double> offsets;
        findCellHyperplanes(objectOf(named(name)), normals, offsets);
        double sum = 0;
        for (const double offset : offsets) sum += offset / 24;
        return sum;
    };
    const auto edge = [](const char* name) {
        const Polytope& p = named(name);
        return glm::distance(p.vertices[p.edges[0][0]], p.vertices[p.edges[0][1]]);
    };
    const std::array<std::pair<const char*, double>, 4> expected{
        {{"5-cell", std::sqrt(5.0) / 96}, {"tesseract", 1}, {"16-cell", 1.0 / 6}, {"24-cell", 2}}};
    for (const auto& [name, ofUnitEdge] : expected)
        EXPECT_NEAR(hypervolume(name) / std::pow(edge(name), 4), ofUnitEdge, 1e-9) << name;
}

struct Projected {
    SliceSet slices, parts;
    std::vector<std::uint32_t> faceCells;
};

Projected projected(const Object& object, const geometry::Rotation& turn, const Projector::ProjectionOptions& options,
                    geometry::Hyperplanes planes) {
    Projected out;
    Slicer().sliceWithoutSurfaces(object, turn, planes, out.slices);
    Projector().project(object, turn, out.slices, options, out.parts, out.faceCells);
    return out;
}

geometry::Hyperplanes spanning(const Polytope& p) { return {-3, 7, p.circumradius / 3.5}; }

TEST(Projector, ProjectsAlongLinesThroughTheEye) {
    std::mt19937 random(5);
    const Polytope& p = named("24-cell");
    for (const double distance : {0.0, 1.1, 3.0, 100.0}) {
        const geometry::Rotation turn = support::randomRotation(random);
        const double inverse = distance > 0 ? 1 / (distance * p.circumradius) : 0;
        const auto all = projected(objectOf(p), turn, {.projection = {inverse}}, spanning(p));
        ASSERT_EQ(all.parts.vertices.size(), p.vertices.size());
        for (std::size_t v = 0; v < p.vertices.size(); ++v) {
            const glm::dvec4 point = turn(p.vertices[v]), image(all.parts.vertices[v], 0);
            // The line through a point and its image is parallel to w or, in perspective, passes through the eye.
            const glm::dvec4 way = point - image;
            const glm::dvec4 ray = distance > 0 ? image - glm::dvec4(0, 0, 0, 1 / inverse) : glm::dvec4(0, 0, 0, 1);
            EXPECT_NEAR(std::abs(glm::dot(way, ray)), glm::length(way) * glm::length(ray), 1e-9);
            EXPECT_EQ(all.parts.vertexSource[v], p.edges.size() + v);
        }
        EXPECT_EQ(all.parts.edges.size(), p.edges.size());
        EXPECT_TRUE(all.parts.faceSource.empty());
    }
}

TEST(Projector, PlacesSectionsInTheProjectedEdges) {
    std::mt19937 random(6);
    for (const char* name : {"5-cell", "120-cell", "great stellated 120-cell"}) {
        SCOPED_TRACE(name);
        const Polytope& p = named(name);
        const geometry::Rotation turn = support::randomRotation(random);
        const auto [slices, parts, cells] = projected(
            objectOf(p), turn, {.projection = {1 / (2 * p.circumradius)}, .firstSlice = 2, .endSlice = 6}, spanning(p));
        ASSERT_EQ(parts.vertexBegin.size(), 6U);  // the object, and four sections
        std::size_t tested = 0;
        for (int part = 1; part <= 4; ++part) {
            EXPECT_EQ(parts.vertexCount(part), slices.vertexCount(part + 1));
            EXPECT_EQ(parts.edgeCount(part), slices.edgeCount(part + 1));
            EXPECT_EQ(parts.faceCount(part), slices.faceCount(part + 1));
            for (auto v = parts.vertexBegin[part]; v < parts.vertexBegin[part + 1]; ++v) {
                const auto [a, b] = p.edges.at(parts.vertexSource[v]);
                const glm::dvec3 from = parts.vertices[a], to = parts.vertices[b];
                const double detour = glm::distance(from, parts.vertices[v]) + glm::distance(parts.vertices[v], to);
                ASSERT_NEAR(detour, glm::distance(from, to), 1e-9 * p.circumradius);
                ++tested;
            }
            for (auto f = parts.faceBegin[part]; f < parts.faceBegin[part + 1]; ++f) {
                ASSERT_EQ(cells[f], parts.faceSource[f]);
                ASSERT_GE(parts.cornerBegin[f + 1] - parts.cornerBegin[f], 3U);
            }
        }
        EXPECT_GT(tested, 0U);
    }
}

TEST(Projector, CullsWhatTheEyeCannotSee) {
    std::mt19937 random(7);
    for (const char* name : {"5-cell", "tesseract", "snub 24-cell", "120-cell", "3,5-duoprism"}) {
        const Polytope& p = named(name);
        for (const double inverse : {0.0, 0.6 / p.circumradius}) {
            for (int round = 0; round < 5; ++round) {
                SCOPED_TRACE(name);
                const geometry::Rotation turn = support::randomRotation(random);
                const auto [slices, parts, cells] =
                    projected(objectOf(p), turn, {.projection = {inverse}, .cells = true, .culled = true}, spanning(p));
                // An eye outside a convex polytope sees cells that form a topological ball: their Euler characteristic
                // is 1.
                const std::set<std::uint32_t> seen(cells.begin(), cells.end());
                const auto v = static_cast<long>(parts.vertices.size()), e = static_cast<long>(parts.edges.size());
                const auto f = static_cast<long>(parts.faceSource.size()), c = static_cast<long>(seen.size());
                EXPECT_EQ(v - e + f - c, 1) << v << ' ' << e << ' ' << f << ' ' << c;
                EXPECT_LT(c, static_cast<long>(p.cells.size()));
                for (std::size_t i = 0; i < parts.edges.size(); ++i) {
                    const auto [a, b] = parts.edges[i];
                    const auto& edge = p.edges.at(parts.edgeSource[i] - p.faces.size());
                    EXPECT_EQ(parts.vertexSource[a], p.edges.size() + edge[0]);
                    EXPECT_EQ(parts.vertexSource[b], p.edges.size() + edge[1]);
                }
            }
        }
    }
}

TEST(Projector, ShowsAllTwoFacesWithoutCulling) {
    const Polytope& p = named("tesseract");
    const auto [slices, parts, cells] = projected(objectOf(p), {}, {.projection = {0.2}, .cells = true}, spanning(p));
    ASSERT_EQ(parts.faceSource.size(), p.faces.size());
    for (std::size_t f = 0; f < p.faces.size(); ++f) {
        EXPECT_EQ(parts.faceSource[f], p.cells.size() + f);
        EXPECT_TRUE(cells[f] == p.faceCells[f][0] || cells[f] == p.faceCells[f][1]);
        ASSERT_EQ(parts.cornerBegin[f + 1] - parts.cornerBegin[f], p.faces[f].size());
        for (std::size_t i = 0; i < p.faces[f].size(); ++i) {
            EXPECT_EQ(parts.corners[parts.cornerBegin[f] + i], p.faces[f][i]);
            EXPECT_EQ(parts.cornerEdges[parts.cornerBegin[f] + i], p.faceEdges[f][i]);
        }
    }
}

TEST(Projector, ColorsTwoFacesOfHiddenCellsByTheirOtherCells) {
    const Polytope p = support::rectifiedFiveCell();
    std::mt19937 random(8);
    const geometry::Rotation turn = support::randomRotation(random);
    for (const std::uint32_t hidden : {0U, 1U}) {
        const std::vector<std::uint32_t> hiddenTypes{hidden};
        const auto [slices, parts, cells] =
            projected(objectOf(p), turn, {.projection = {0.2}, .cells = true, .hiddenTypes = hiddenTypes}, spanning(p));
        ASSERT_EQ(parts.faceSource.size(), p.faces.size());
        for (std::size_t f = 0; f < p.faces.size(); ++f) {
            const auto [first, second] = p.faceCells[f];
            EXPECT_TRUE(cells[f] == first || cells[f] == second);
            if (p.typeOfCell[first] == p.typeOfCell[second]) continue;
            EXPECT_NE(p.typeOfCell[cells[f]], hidden);
        }
    }
}

TEST(Projector, WritesTheLoopsOfTwoFacesThatCrossThemselves) {
    const Polytope& p = named("small stellated 120-cell");  // the 2-faces of this polytope are pentagrams
    const auto [slices, parts, cells] = projected(objectOf(p), {}, {.projection = {0.2}, .cells = true}, spanning(p));
    ASSERT_EQ(parts.faceSource.size(), p.faces.size());
    EXPECT_EQ(cells.size(), p.faces.size());
    for (std::size_t f = 0; f < p.faces.size(); ++f) {
        EXPECT_EQ(parts.faceSource[f], p.cells.size() + f);
        const std::vector<std::uint32_t> loop(parts.corners.begin() + parts.cornerBegin[f],
                                              parts.corners.begin() + parts.cornerBegin[f + 1]);
        EXPECT_TRUE(std::ranges::equal(loop, p.faces[f]));
    }
    EXPECT_EQ(parts.edges.size(), p.edges.size());
}

TEST(Projector, ShowsThePointsOfClouds) {
    const auto cloud = std::make_shared<const geometry::PointCloud>(
        geometry::makePointCloud("cloud", {{1, 0, 0, 0.5}, {0, 2, 0, -1}, {0, 0, 1, 0}}, {0, 0.5, 0}));
    const auto [slices, parts, cells] =
        projected(Object(cloud), {}, {.projection = {0.25}, .firstSlice = 3, .endSlice = 4}, {-3, 7, 0.2});
    ASSERT_EQ(parts.vertexCount(0), 3U);
    EXPECT_LT(glm::distance(parts.vertices[0], glm::dvec3(1 / (1 - 0.125), 0, 0)), 1e-12);
    EXPECT_EQ(parts.ballScale.size(), parts.vertices.size());
    // The point with w = 0, where the ball of the section covers that of the cloud.
    ASSERT_EQ(parts.vertexCount(1), 1U);
    EXPECT_EQ(parts.vertices[3], parts.vertices[2]);
}

}  // namespace
}  // namespace oval4d::slicing
