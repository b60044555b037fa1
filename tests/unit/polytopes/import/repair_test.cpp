// Tests of the repairs of invalid 4OFF files.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "geometry/rotation.hpp"
#include "polytopes/import/import.hpp"
#include "polytopes/import/repair.hpp"
#include "unit/polytopes/import/import_support.hpp"

namespace oval4d::polytopes {
namespace {

using support::countsOf;
using support::importOff4;
using support::Lines;
using support::named;
using support::sound;
using support::warningsOf;

TEST(Repair, WarnsOfAWrongNumberOfEdges) {
    const ImportedPolytope imported = sound(importOff4(Lines(named("8-cell")).text(33)));
    EXPECT_EQ(warningsOf(imported), "the file states 33 edges, but its 2-faces have 32");
    EXPECT_EQ(warningsOf(sound(importOff4(Lines(named("8-cell")).text(32)))), "");
}

TEST(Repair, RemovesUnusedElements) {
    Lines lines(named("5-cell"));
    lines.vertices.insert(lines.vertices.begin(), {{9, 9, 9, 9}, {8, 9, 9, 9}});
    for (auto& face : lines.faces) {
        for (auto& v : face) v += 2;
    }
    lines.faces.push_back({0, 1, 2});
    const ImportedPolytope imported = sound(importOff4(lines.text()));
    EXPECT_EQ(imported.polytope.vertices, named("5-cell").vertices);
    EXPECT_EQ(imported.polytope.faces, named("5-cell").faces);
    EXPECT_EQ(warningsOf(imported),
              "1 2-face lies in no cell and was left out; 2 vertices lie on no 2-face and were left out");
}

// Files in which every cell has vertices and 2-faces of its own are imported, because some programs write such files.
TEST(Repair, MergesElementsGivenOncePerCell) {
    for (const char* name : {"8-cell", "24-cell", "600-cell"}) {
        const auto& original = named(name);
        Lines lines(original);
        lines.vertices.clear();
        lines.faces.clear();
        for (std::size_t c = 0; c < original.cellCount(); ++c) {
            for (auto& f : lines.cells[c]) {
                const auto loop = original.faces[f];
                f = static_cast<std::uint32_t>(lines.faces.size());
                auto& face = lines.faces.emplace_back();
                for (const auto v : loop) {
                    face.push_back(static_cast<std::uint32_t>(lines.vertices.size()));
                    lines.vertices.push_back(original.vertices[v]);
                }
            }
        }
        const std::size_t doubled = lines.vertices.size() - original.vertices.size();
        const ImportedPolytope imported = sound(importOff4(lines.text()));
        EXPECT_EQ(countsOf(imported.polytope), countsOf(original));
        EXPECT_EQ(warningsOf(imported),
                  std::to_string(doubled) + " vertices coincide with others and were merged with them; " +
                      std::to_string(original.faces.size()) +
                      " 2-faces are given once for each of the two cells, and the copies were merged");
    }
}

TEST(Repair, RemovesRepeatedCornersFromFaces) {
    Lines lines(named("8-cell"));
    lines.faces[0].insert(lines.faces[0].begin() + 1, lines.faces[0][0]);
    // The vertex loop of this 2-face goes around the 2-face twice.
    lines.faces[1].insert(lines.faces[1].end(), lines.faces[1].begin(), lines.faces[1].end());
    const ImportedPolytope imported = sound(importOff4(lines.text()));
    EXPECT_EQ(countsOf(imported.polytope), countsOf(named("8-cell")));
}

// Four points in a line become one vertex, in any order, although only neighbors are within the distance for merging.
// The four points replace a vertex of a 5-cell; each 2-face at this vertex has one of them.
TEST(Repair, MergesAChainOfVertices) {
    const Polytope& simplex = named("5-cell");
    const double distance = 1e-4;
    std::vector<double> steps{0, 0.8, 1.6, 2.4};
    do {
        PolygonSoup soup{simplex.vertices, simplex.faces, simplex.cells, {}, {}};
        soup.faceSourcePositions.resize(soup.faces.size());
        soup.cellSourcePositions.resize(soup.cells.size());
        const glm::dvec4 place = simplex.vertices[0];
        soup.vertices[0] = place - glm::dvec4(steps[0] * distance, 0, 0, 0);
        for (std::size_t i = 1; i < steps.size(); ++i)
            soup.vertices.push_back(place - glm::dvec4(steps[i] * distance, 0, 0, 0));
        std::uint32_t uses = 0;
        for (std::uint32_t& v : soup.faces.items) {
            if (v != 0) continue;
            if (const std::uint32_t point = uses++ % 4; point > 0) v = 4 + point;
        }
        std::vector<std::string> warnings;
        repair(soup, distance, warnings);
        EXPECT_EQ(warnings, std::vector<std::string>{"3 vertices coincide with others and were merged with them"});
        EXPECT_EQ(soup.vertices.size(), 5U);
        EXPECT_EQ(countsOf(build(soup, "5-cell")), countsOf(simplex));
    } while (std::next_permutation(steps.begin(), steps.end()));
}

TEST(Repair, MergesManyCopiesOfEachVertex) {
    Lines lines(named("5-cell"));
    const std::vector<glm::dvec4> vertices = lines.vertices;
    for (int copy = 0; copy < 200; ++copy)
        lines.vertices.insert(lines.vertices.end(), vertices.begin(), vertices.end());
    for (std::size_t f = 0; f < lines.faces.size(); ++f) {
        for (std::uint32_t& v : lines.faces[f]) v += static_cast<std::uint32_t>(5 * (17 * f % 201));
    }
    const ImportedPolytope imported = sound(importOff4(lines.text()));
    EXPECT_EQ(countsOf(imported.polytope), countsOf(named("5-cell")));
    EXPECT_EQ(warningsOf(imported), "1000 vertices coincide with others and were merged with them");
}

// A compound of three tesseracts, inscribed in the 24-cell (compare Coxeter, Regular Polytopes, §8.2), is imported.
// Each of its 24 vertices belongs to two tesseracts, and occurs twice in the file.
TEST(Repair, MergesTheVerticesOfACompound) {
    const auto& cube = named("8-cell");
    Lines lines(cube);
    // An isoclinic rotation by 60° maps the 24-cell to itself, and each of the three tesseracts to the next.
    for (const double turns : {1.0, 2.0}) {
        const double angle = turns * std::numbers::pi / 3;
        const glm::dquat left(std::cos(angle), std::sin(angle) * glm::normalize(glm::dvec3(1, 1, 1)));
        const geometry::Rotation rotation(left, glm::dquat(1, 0, 0, 0));
        Lines other(cube);
        for (auto& v : other.vertices) v = rotation(v);
        lines.add(other);
    }
    const ImportedPolytope imported = sound(importOff4(lines.text()));
    EXPECT_EQ(countsOf(imported.polytope), (std::array<std::size_t, 4>{24, 96, 72, 24}));
    EXPECT_EQ(warningsOf(imported), "24 vertices coincide with others and were merged with them");
    // The hypervolume is the sum of those of the three tesseracts, 16 each, although they overlap.
    std::mt19937 random(14);
    EXPECT_NEAR(support::hypervolumeBySlices(imported.polytope, support::randomRotation(random)), 48, 1e-6);
}

TEST(Repair, SplitsCellsOfSeveralPieces) {
    const auto& cube = named("8-cell");
    Lines lines(cube);
    const glm::dvec4 center = support::centerOfCell(cube, 0);
    const glm::dvec4 along = std::abs(center.x) > 0.5 ? glm::dvec4(0, 5, 0, 0) : glm::dvec4(5, 0, 0, 0);
    lines.add(Lines(cube), along);
    // Join the cells 0 of both polytopes to one cell; they lie in the same hyperplane.
    lines.cells[0].insert(lines.cells[0].end(), lines.cells[8].begin(), lines.cells[8].end());
    lines.cells.erase(lines.cells.begin() + 8);
    const ImportedPolytope imported = sound(importOff4(lines.text()));
    EXPECT_EQ(countsOf(imported.polytope), (std::array<std::size_t, 4>{32, 64, 48, 16}));
    EXPECT_EQ(warningsOf(imported), "1 cell consists of several pieces and was split into one cell for each piece");
}

}  // namespace
}  // namespace oval4d::polytopes
