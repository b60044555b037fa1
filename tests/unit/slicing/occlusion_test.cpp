// Tests of hidden elements: the projection of a nonconvex object leaves out what lies behind other cells.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "unit/slicing/occlusion_support.hpp"

namespace oval4d::slicing {
namespace {

using polytopes::Polytope;
using support::named;

/// Returns a random rotation of x, y and z, which does not change w.
geometry::Rotation randomRotationOfSpace(std::mt19937& random) {
    std::normal_distribution<double> normal;
    const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
    const glm::dquat q = glm::normalize(glm::dquat(w, x, y, z));
    return {q, glm::conjugate(q)};
}

/// Returns, for each box, how many of its vertices are drawn.
std::vector<std::size_t> verticesOfBoxes(const Drawn& seen, std::size_t boxCount) {
    std::vector<std::size_t> counts(boxCount, 0);
    for (const std::uint32_t v : seen.vertices) ++counts[v / 16];
    return counts;
}

TEST(Occlusion, LeavesOutABodyBehindALargerOne) {
    const Polytope p = boxes({cubeAt({0, 0, 0, 3}, 1), cubeAt({0.1, 0.2, -0.1, -3}, 0.5)});
    ASSERT_FALSE(p.convex);
    std::mt19937 random(21);
    for (const double inverse : {0.0, 1 / (3 * p.circumradius)}) {
        for (int round = 0; round < 4; ++round) {
            const geometry::Rotation turn = round == 0 ? geometry::Rotation() : randomRotationOfSpace(random);
            for (const bool cells : {false, true}) {
                const Drawn seen = drawn(p, turn, {.projection = {inverse}, .cells = cells, .culled = true});
                if (inverse == 0) {  // of the nearer box, the eye at infinity sees only the upper cell
                    EXPECT_EQ(seen.vertices.size(), 8U);
                    EXPECT_EQ(seen.edges.size(), 12U);
                    EXPECT_EQ(seen.faces.size(), cells ? 6U : 0U);
                }
                const auto counts = verticesOfBoxes(seen, 2);
                EXPECT_GE(counts[0], 8U);
                EXPECT_EQ(counts[1], 0U);
            }
        }
    }
    const Drawn whole = drawn(p, {}, {.projection = {0.0}});
    EXPECT_EQ(whole.vertices.size(), 32U);
}

TEST(Occlusion, KeepsABodyBehindASmallerOne) {
    const Polytope p = boxes({cubeAt({0, 0, 0, 3}, 1), cubeAt({0, 0, 0, -3}, 1.5)});
    const Drawn seen = drawn(p, {}, {.projection = {0.0}, .cells = true, .culled = true});
    EXPECT_EQ(seen.vertices.size(), 16U);
    EXPECT_EQ(seen.edges.size(), 24U);
    EXPECT_EQ(seen.faces.size(), 12U);
}

// An edge is divided where it vanishes behind a cell. In the projection, the nearer cube is |x|, |y|, |z| ≤ 1; the
// farther cube is 0.5 ≤ x ≤ 1.5 and |y|, |z| ≤ 0.5.
TEST(Occlusion, DividesEdgesWhereTheyVanishBehindACell) {
    const Polytope p = boxes({cubeAt({0, 0, 0, 3}, 1), cubeAt({1, 0, 0, -3}, 0.5)});
    std::mt19937 random(22);
    for (int round = 0; round < 4; ++round) {
        const geometry::Rotation turn = round == 0 ? geometry::Rotation() : randomRotationOfSpace(random);
        const Drawn bars = drawn(p, turn, {.projection = {0.0}, .culled = true});
        // The four edges with x = 0.5 are hidden, and so are their ends. Four others are hidden only in part.
        EXPECT_EQ(bars.edges.size(), 12U + 8U);
        EXPECT_EQ(bars.vertices.size(), 8U + 4U);
        // Only the square with x = 0.5 is wholly hidden. Of the sides of the other squares, the same parts are drawn.
        const Drawn cells = drawn(p, turn, {.projection = {0.0}, .cells = true, .culled = true});
        EXPECT_EQ(cells.faces.size(), 6U + 5U);
        EXPECT_EQ(cells.edges, bars.edges);
        EXPECT_EQ(cells.vertices, bars.vertices);
    }
}

TEST(Occlusion, CutsBarsOffWhereTheyVanishBehindACell) {
    const Polytope p = boxes({cubeAt({0, 0, 0, 3}, 1), cubeAt({1, 0, 0, -3}, 0.5)});
    const Bars bars = barsOf(p, {}, {.projection = {0.0}, .culled = true});
    EXPECT_EQ(bars, barsOf(p, {}, {.projection = {0.0}, .cells = true, .culled = true}));
    std::size_t cut = 0;
    for (const auto& [edge, ends] : bars) {
        if (p.edges[edge][0] < 16) continue;  // of the nearer cube
        const auto [least, most] = std::minmax(ends[0].x, ends[1].x);
        EXPECT_NEAR(most, 1.5, 1e-8);
        if (most - least < 0.1) continue;
        EXPECT_NEAR(least, 1, 1e-8);
        ++cut;
    }
    EXPECT_EQ(cut, 4U);

    Projector projector;
    for (const bool cells : {false, true}) {
        const SliceSet parts = projectionWith(projector, p, {}, {.projection = {0.0}, .cells = cells, .culled = true});
        // 12 vertices are seen, 4 bars are cut off, and 4 corners of squares are hidden.
        ASSERT_EQ(parts.vertices.size(), 12U + 4U + (cells ? 4U : 0U));
        ASSERT_EQ(parts.ballOpacity.size(), parts.vertices.size());
        EXPECT_EQ(parts.ballScale, std::vector<float>(parts.vertices.size(), 1));
        EXPECT_EQ(std::ranges::count(parts.ballOpacity, 1.0F), 12);
        for (std::size_t v = 0; v < parts.vertices.size(); ++v) {
            if (parts.vertexSource[v] >= p.edges.size()) continue;
            EXPECT_FALSE(parts.hasBall(v));
            EXPECT_NEAR(parts.vertices[v].x, 1, 1e-8);
        }
    }
}

// A bar that passes behind two cubes is drawn before, between and behind them.
TEST(Occlusion, DrawsSeveralPartsOfABar) {
    const Polytope p =
        boxes({cubeAt({-2, 0, 0, 3}, 1), cubeAt({2, 0, 0, 3}, 1), {{-4, -0.5, -0.5, -3}, {4, 0.5, 0.5, -2}}});
    const Bars bars = barsOf(p, {}, {.projection = {0.0}, .culled = true});
    for (std::uint32_t e = 0; e < p.edges.size(); ++e) {
        const glm::dvec4 &a = p.vertices[p.edges[e][0]], &b = p.vertices[p.edges[e][1]];
        if (a.w > -1 || a.w < -2.5 || std::abs(a.x - b.x) < 1) continue;
        std::vector<double> ends;
        const auto [first, last] = bars.equal_range(e);
        for (auto bar = first; bar != last; ++bar) {
            ends.push_back(bar->second[0].x);
            ends.push_back(bar->second[1].x);
        }
        std::ranges::sort(ends);
        const std::vector<double> expected{-4, -3, -1, 1, 3, 4};
        ASSERT_EQ(ends.size(), expected.size());
        for (std::size_t i = 0; i < ends.size(); ++i) EXPECT_NEAR(ends[i], expected[i], 1e-8);
    }
}

// There are no gaps between neighboring cells: two boxes side by side hide what lies behind their common boundary, even
// if it runs along this boundary.
TEST(Occlusion, HasNoGapsBetweenNeighboringCells) {
    const Polytope p = boxes({{{-2, -2, -2, 2}, {0, 2, 2, 3}},
                              {{0, -2, -2, 2}, {2, 2, 2, 3}},
                              cubeAt({0, 0, 0, -3}, 1),
                              cubeAt({0.5, 0, 0, -6}, 0.5)});  // this cube has edges with x = 0
    for (const bool cells : {false, true}) {
        const auto counts = verticesOfBoxes(drawn(p, {}, {.projection = {0.0}, .cells = cells, .culled = true}), 4);
        EXPECT_EQ(counts[0], 8U);
        EXPECT_EQ(counts[1], 8U);
        EXPECT_EQ(counts[2], 0U);
        EXPECT_EQ(counts[3], 0U);
    }
}

// A face is drawn if only a part of it can be seen through a window. Four bars hide the sides of the square z = 2 of a
// cube, but not its middle. Then a lid covers the middle.
TEST(Occlusion, KeepsAFaceThatIsSeenThroughAWindow) {
    std::vector<TestBox> parts{cubeAt({0, 0, 0, -8}, 2),
                               {{-3, -3, 1, 0}, {3, -1, 3, 1}},
                               {{-3, 1, 1, 0}, {3, 3, 3, 1}},
                               {{-3, -3, 1, 3}, {-1, 3, 3, 4}},
                               {{1, -3, 1, 3}, {3, 3, 3, 4}}};
    const auto squareIsDrawn = [](const Polytope& p, const geometry::Rotation& turn) {
        const Drawn seen = drawn(p, turn, {.projection = {0.0}, .cells = true, .culled = true});
        const auto isSquare = [&](std::uint32_t f) {
            return f < 24 && std::ranges::all_of(
                                 p.faces[f],
                                 [&](std::uint32_t v) {
                                     return std::abs(p.vertices[v].z - 2) < 1e-9 &&
                                            std::abs(p.vertices[v].w + 6) < 1e-9;
                                 });
        };
        return std::ranges::any_of(seen.faces, isSquare);
    };
    std::mt19937 random(23);
    const geometry::Rotation turn = randomRotationOfSpace(random);
    const Polytope open = boxes(parts);
    EXPECT_TRUE(squareIsDrawn(open, {}));
    EXPECT_TRUE(squareIsDrawn(open, turn));
    parts.push_back({{-1.5, -1.5, 1, 6}, {1.5, 1.5, 3, 7}});
    const Polytope closed = boxes(parts);
    EXPECT_FALSE(squareIsDrawn(closed, {}));
    EXPECT_FALSE(squareIsDrawn(closed, turn));
}

TEST(Occlusion, LeavesOutOnlyCellsTurnedAwayIfStepsAreTooFew) {
    const Polytope p = boxes({cubeAt({0, 0, 0, 3}, 1), cubeAt({0, 0, 0, -3}, 0.5)});
    Projector projector;
    for (const std::size_t steps : {0U, 10U, 500U}) {
        const Drawn seen =
            drawnWith(projector, p, {}, {.projection = {0.0}, .cells = true, .culled = true, .occlusionSteps = steps});
        EXPECT_TRUE(projector.exceededOcclusionSteps()) << steps;
        EXPECT_EQ(seen.vertices.size(), 16U) << steps;
        EXPECT_EQ(seen.edges.size(), 24U) << steps;
        EXPECT_EQ(seen.faces.size(), 12U) << steps;
    }
    drawnWith(projector, p, {}, {.projection = {0.0}, .cells = true, .occlusionSteps = 0});
    EXPECT_FALSE(projector.exceededOcclusionSteps()) << "nothing is to be left out";
    drawnWith(projector, p, {}, {.projection = {0.0}, .cells = true, .culled = true});
    EXPECT_FALSE(projector.exceededOcclusionSteps());
    drawnWith(projector, named("tesseract"), {}, {.projection = {0.0}, .culled = true, .occlusionSteps = 0});
    EXPECT_FALSE(projector.exceededOcclusionSteps()) << "a convex polytope needs no steps";
}

TEST(Occlusion, IsNotSoughtForConvexPolytopes) {
    std::mt19937 random(24);
    for (const char* name : {"tesseract", "600-cell", "3,5-duoprism"}) {
        const Polytope& p = named(name);
        const geometry::Rotation turn = support::randomRotation(random);
        for (const bool cells : {false, true}) {
            const Projector::ProjectionOptions options{
                .projection = {0.5 / p.circumradius}, .cells = cells, .culled = true, .occlusionSteps = 0};
            Projector::ProjectionOptions unlimited = options;
            unlimited.occlusionSteps = ~std::size_t{0};
            EXPECT_EQ(drawn(p, turn, options), drawn(p, turn, unlimited)) << name;
        }
    }
}

TEST(Occlusion, NeverLeavesOutWhatARaySees) {
    std::mt19937 random(25);
    std::uniform_real_distribution<double> part(0.01, 0.99);
    std::size_t seenPoints = 0, hiddenPoints = 0;
    for (const char* name : {"small stellated 120-cell", "grand 600-cell"}) {
        SCOPED_TRACE(name);
        const Polytope& p = named(name);
        const auto cellsOfEdge = cellsOfEdges(p);
        for (const double inverse : {0.0, 0.5 / p.circumradius}) {
            const geometry::Rotation turn = support::randomRotation(random);
            const RayCaster rays(p, turn, inverse);
            const Drawn cells = drawn(p, turn, {.projection = {inverse}, .cells = true, .culled = true});
            const Bars bars = barsOf(p, turn, {.projection = {inverse}, .culled = true});
            for (int sample = 0; sample < (support::kSanitized ? 20 : 100); ++sample) {
                const auto e = static_cast<std::uint32_t>(random() % p.edges.size());
                const auto [a, b] = p.edges[e];
                const double t = part(random);
                const glm::dvec4 point = (1 - t) * rays.vertex(a) + t * rays.vertex(b);
                const bool edgeIsSeen = rays.sees(point, cellsOfEdge[e]);
                ++(edgeIsSeen ? seenPoints : hiddenPoints);
                ASSERT_EQ(isDrawnAt(bars, e, ProjectionToHyperplane{inverse}(point)), edgeIsSeen) << e;
                ASSERT_TRUE(!edgeIsSeen || cells.edges.contains(e)) << e;

                const auto f = static_cast<std::uint32_t>(random() % p.faces.size());
                const auto loop = p.faces[f];
                glm::dvec4 middle(0);
                for (const std::uint32_t v : loop) middle += rays.vertex(v) / static_cast<double>(loop.size());
                const std::size_t side = random() % loop.size();
                const double outward = std::sqrt(part(random)), along = part(random);
                const glm::dvec4 onSide =
                    (1 - along) * rays.vertex(loop[side]) + along * rays.vertex(loop[(side + 1) % loop.size()]);
                const bool faceIsSeen =
                    rays.sees(middle + outward * (onSide - middle), {p.faceCells[f].begin(), p.faceCells[f].end()});
                ++(faceIsSeen ? seenPoints : hiddenPoints);
                ASSERT_TRUE(!faceIsSeen || cells.faces.contains(f)) << f;
            }
        }
    }
    EXPECT_GT(seenPoints, 0U);
    EXPECT_GT(hiddenPoints, 0U);
}

TEST(Occlusion, DoesNotDependOnHowTheProjectionIsTurned) {
    std::mt19937 random(26);
    const Polytope& p = named("great stellated 120-cell");
    const geometry::Rotation turn = support::randomRotation(random);
    for (const double inverse : {0.0, 0.4 / p.circumradius}) {
        const Projector::ProjectionOptions options{.projection = {inverse}, .cells = true, .culled = true};
        const Drawn seen = drawn(p, turn, options);
        EXPECT_FALSE(seen.faces.empty());
        for (int round = 0; round < 2; ++round)
            EXPECT_EQ(drawn(p, randomRotationOfSpace(random) * turn, options), seen);
    }
}

TEST(Occlusion, IsFoundAnewWhenAnythingChanges) {
    const Polytope behind = boxes({cubeAt({0, 0, 0, 3}, 1), cubeAt({0, 0, 0, -3}, 0.5)});
    const Polytope beside = boxes({cubeAt({0, 0, 0, 3}, 1), cubeAt({5, 0, 0, -3}, 0.5)});
    std::mt19937 random(27);
    const geometry::Rotation turn = support::randomRotation(random);
    const std::vector<std::uint32_t> none, first{0};
    Projector projector;
    for (const Polytope* p : {&behind, &beside, &behind}) {
        for (const double inverse : {0.0, 0.5 / p->circumradius}) {
            for (const geometry::Rotation& orientation : {geometry::Rotation(), turn}) {
                for (const bool cells : {true, false}) {
                    for (const std::vector<std::uint32_t>& hiddenTypes : {none, first}) {
                        for (const std::size_t steps : {OcclusionFinder::kDefaultSteps, std::size_t{0}}) {
                            const Projector::ProjectionOptions options{.projection = {inverse},
                                                                       .cells = cells,
                                                                       .culled = true,
                                                                       .hiddenTypes = hiddenTypes,
                                                                       .occlusionSteps = steps};
                            EXPECT_EQ(drawnWith(projector, *p, orientation, options), drawn(*p, orientation, options));
                            EXPECT_EQ(drawnWith(projector, *p, orientation, options), drawn(*p, orientation, options));
                        }
                    }
                }
            }
        }
    }
}

}  // namespace
}  // namespace oval4d::slicing
