#include "geometry/surface_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/index.hpp"

namespace oval4d::geometry {
namespace {

const std::vector<glm::dvec4> kCorners{{0, 0, 0, 1}, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 2, 0}};

JaggedArray facesOf(const std::vector<std::vector<std::uint32_t>>& loops) {
    JaggedArray faces;
    for (const auto& loop : loops) faces.add(loop);
    return faces;
}

TEST(SurfaceMesh, HasTheEdgesOfItsFaces) {
    const SurfaceMesh surface = makeSurfaceMesh("two triangles", kCorners, facesOf({{0, 1, 2}, {2, 1, 3}}));
    EXPECT_EQ(surface.name, "two triangles");
    EXPECT_EQ(surface.circumradius, 2);
    EXPECT_EQ(surface.edges.size(), 5U);
    EXPECT_EQ(surface.cells.size(), 0U);
    EXPECT_TRUE(surface.cellTypes.empty());
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = surface.faces[f][i], b = surface.faces[f][(i + 1) % 3];
            EXPECT_EQ(surface.edges[surface.faceEdges[f][i]],
                      (std::array<std::uint32_t, 2>{std::min(a, b), std::max(a, b)}));
        }
    }
    EXPECT_GT(memoryOf(surface), 4 * sizeof(glm::dvec4));
}

TEST(SurfaceMesh, SaysWhetherItsFacesAreFlatAndConvex) {
    const JaggedArray square = facesOf({{0, 1, 2, 3}});
    const auto convex = [&](const glm::dvec4& last) {
        return makeSurfaceMesh("s", {{0, 0, 0, 1}, {1, 0, 0, 1}, {1, 1, 0, 1}, last}, square).convexFaces;
    };
    EXPECT_TRUE(convex({0, 1, 0, 1}));
    EXPECT_FALSE(convex({0, 1, 0.5, 1})) << "not flat";
    EXPECT_FALSE(convex({0.7, 0.4, 0, 1})) << "dented";
}

TEST(SurfaceMesh, RefusesWhatIsNone) {
    const double infinite = std::numeric_limits<double>::infinity();
    const auto expectRefused = [](const std::vector<glm::dvec4>& vertices, const JaggedArray& faces, std::uint32_t face,
                                  const std::string& says) {
        try {
            makeSurfaceMesh("s", vertices, faces);
            FAIL() << "expected: " << says;
        } catch (const InvalidSurface& invalid) {
            EXPECT_EQ(invalid.what(), says);
            EXPECT_EQ(invalid.face, face) << says;
        }
    };
    expectRefused(kCorners, {}, kNone, "there are no 2-faces");
    expectRefused(kCorners, facesOf({{0, 1, 2}, {0, 1}}), 1, "2-face 1 has fewer than 3 vertices");
    expectRefused(kCorners, facesOf({{0, 1, 2}, {0, 1, 4}}), 1,
                  "2-face 1 lists vertex 4, but there are only 4 vertices");
    expectRefused(kCorners, facesOf({{0, 1, 2, 1}}), 0, "2-face 0 lists a vertex twice");
    expectRefused({{0, 0, 0, 1}, {1, 0, 0, 0}, {0, infinite, 0, 0}}, facesOf({{0, 1, 2}}), kNone,
                  "a vertex is not finite");
    expectRefused(std::vector(3, glm::dvec4(0)), facesOf({{0, 1, 2}}), kNone, "all vertices are at the origin");
}

TEST(SurfaceMesh, IsSeenInAFrameOfReference) {
    SurfaceMesh surface = makeSurfaceMesh("s", kCorners, facesOf({{0, 1, 2}}));
    surface.originInFile = {0, 0, 0, 5};
    const SurfaceMesh image = transformedTo(surface, {.pace = 3, .follow = {1, 0, 0}}, 77);
    EXPECT_EQ(image.vertices[0], glm::dvec4(-1, 0, 0, 3));
    EXPECT_EQ(image.originInFile, glm::dvec4(-5, 0, 0, 15));
    EXPECT_EQ(image.serial, 77U);
    EXPECT_EQ(image.edges, surface.edges);
    EXPECT_NEAR(image.circumradius, std::sqrt(10), 1e-12);
}

}  // namespace
}  // namespace oval4d::geometry
