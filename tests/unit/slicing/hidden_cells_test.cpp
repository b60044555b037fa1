// What the projection leaves out if kinds of cells are hidden: the eye sees through them.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "unit/slicing/occlusion_support.hpp"

namespace oval4d::slicing {
namespace {

using polytopes::Polytope;
using support::named;

/// Returns a tesseract with edges of length 2 whose cells with the greatest w have the type 1, those with the least w
/// the type 2, and all others the type 0.
Polytope tesseractWithEnds() {
    Polytope p = boxes({cubeAt({0, 0, 0, 0}, 1)});
    p.cellTypes = {{"side"}, {"upper"}, {"lower"}};
    for (std::size_t c = 0; c < p.cells.size(); ++c) {
        double sum = 0, count = 0;
        for (const std::uint32_t f : p.cells[c]) {
            for (const std::uint32_t v : p.faces[f]) {
                sum += p.vertices[v].w;
                ++count;
            }
        }
        p.typeOfCell[c] = sum > 0.5 * count ? 1 : sum < -0.5 * count ? 2 : 0;
    }
    return p;
}

// The eye looks at the upper cell. If this cell is hidden, the eye sees the inner sides of all others.
TEST(HiddenCells, LetTheEyeSeeAConvexPolytopeFromInside) {
    const Polytope p = tesseractWithEnds();
    ASSERT_TRUE(p.convex);
    struct Case {
        std::vector<std::uint32_t> hiddenTypes;
        std::size_t vertices, edges, faces;
    };
    const Case cases[] = {{{}, 8, 12, 6},  {{1}, 16, 32, 24},  {{1, 2}, 16, 32, 24},
                          {{2}, 8, 12, 6}, {{0, 1}, 8, 12, 6}, {{0, 1, 2}, 0, 0, 0}};
    for (const auto& one : cases) {
        const Drawn seen = drawn(
            p, {},
            {.projection = {1 / (3 * p.circumradius)}, .cells = true, .culled = true, .hiddenTypes = one.hiddenTypes});
        EXPECT_EQ(seen.vertices.size(), one.vertices);
        EXPECT_EQ(seen.edges.size(), one.edges);
        EXPECT_EQ(seen.faces.size(), one.faces);
        const Drawn whole =
            drawn(p, {}, {.projection = {1 / (3 * p.circumradius)}, .cells = true, .hiddenTypes = one.hiddenTypes});
        EXPECT_EQ(whole.edges.size(), 32U) << "nothing is to be left out";
    }
}

TEST(HiddenCells, LeaveOnlyCellsTurnedAwayOutIfStepsAreTooFew) {
    const Polytope p = tesseractWithEnds();
    const std::vector<std::uint32_t> hiddenTypes{1};
    Projector projector;
    const Drawn seen = drawnWith(projector, p, {},
                                 {.projection = {1 / (3 * p.circumradius)},
                                  .cells = true,
                                  .culled = true,
                                  .hiddenTypes = hiddenTypes,
                                  .occlusionSteps = 10});
    EXPECT_TRUE(projector.exceededOcclusionSteps());
    EXPECT_EQ(seen.edges.size(), 12U);
}

TEST(HiddenCells, LeaveOutWhatNoRaySees) {
    std::mt19937 random(28);
    std::uniform_real_distribution<double> part(0.01, 0.99);
    std::size_t seenPoints = 0, hiddenPoints = 0;
    for (const char* name : {"truncated tesseract", "rectified 24-cell", "3,5-duoprism"}) {
        SCOPED_TRACE(name);
        const Polytope& p = named(name);
        const auto cellsOfEdge = cellsOfEdges(p);
        for (const std::uint32_t hidden : {0U, 1U}) {
            const std::vector<std::uint32_t> hiddenTypes{hidden};
            for (const double inverse : {0.0, 0.5 / p.circumradius}) {
                const geometry::Rotation turn = support::randomRotation(random);
                RayCaster rays(p, turn, inverse);
                rays.hide(hidden);
                const Bars bars =
                    barsOf(p, turn, {.projection = {inverse}, .culled = true, .hiddenTypes = hiddenTypes});
                for (std::uint32_t e = 0; e < p.edges.size(); ++e) {
                    const auto& own = cellsOfEdge[e];
                    const bool isShown = std::ranges::any_of(own, [&](auto c) { return p.typeOfCell[c] != hidden; });
                    const auto [a, b] = p.edges[e];
                    const double t = part(random);
                    const glm::dvec4 point = (1 - t) * rays.vertex(a) + t * rays.vertex(b);
                    const bool isSeen = isShown && rays.sees(point, own);
                    ++(isSeen ? seenPoints : hiddenPoints);
                    ASSERT_EQ(isDrawnAt(bars, e, ProjectionToHyperplane{inverse}(point)), isSeen) << e;
                    ASSERT_TRUE(isShown || !bars.contains(e)) << e;
                }
            }
        }
    }
    EXPECT_GT(seenPoints, 0U);
    EXPECT_GT(hiddenPoints, 0U);
}

}  // namespace
}  // namespace oval4d::slicing
