#include "polytopes/construction/polyhedra.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

namespace oval4d::polytopes {
namespace {

TEST(NamedPolyhedra, haveVerticesOnASphereAndEdgesOfLengthTwo) {
    std::size_t convex = 0;
    for (const NamedPolyhedron& polyhedron : namedPolyhedra()) {
        SCOPED_TRACE(polyhedron.name);
        const auto vertices = verticesOf(polyhedron);
        ASSERT_GE(vertices.size(), 4U);
        glm::dvec3 sum(0);
        double nearest = 1e300;
        bool edges = true;
        for (const glm::dvec3& a : vertices) {
            sum += a;
            EXPECT_NEAR(glm::length(a), glm::length(vertices[0]), 1e-12);
            double error = 1e300;
            for (const glm::dvec3& b : vertices) {
                if (&a == &b) continue;
                nearest = std::min(nearest, glm::distance(a, b));
                error = std::min(error, std::abs(glm::distance(a, b) - 2));
            }
            edges = edges && error < 1e-12;
        }
        EXPECT_NEAR(glm::length(sum), 0, 1e-11);
        EXPECT_TRUE(edges);
        if (isConvex(polyhedron)) {
            EXPECT_NEAR(nearest, 2, 1e-12);
        }
        convex += isConvex(polyhedron) ? 1 : 0;
    }
    EXPECT_EQ(convex, 5U + 13);
}

TEST(Polygons, haveNouns) {
    EXPECT_EQ(polygonNoun({4, 1}), "square");
    EXPECT_EQ(polygonNoun({9, 1}), "enneagon");
    EXPECT_EQ(polygonNoun({17, 1}), "17-gon");
    EXPECT_EQ(polygonNoun({5, 2}), "pentagram");
    EXPECT_EQ(polygonNoun({7, 2}), "7/2-gon");
    for (int n = 3; n < 30; ++n) EXPECT_EQ(polygonNamed(polygonNoun({n, 1})), (RegularPolygon{n, 1}));
}

}  // namespace
}  // namespace oval4d::polytopes
