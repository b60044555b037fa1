#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "scene/composer.hpp"
#include "unit/slicing/support.hpp"

namespace {

using namespace oval4d;
using scene::DensityPlot;

constexpr int kMiddleRow = (DensityPlot::kRows - 1) / 2;

std::vector<glm::dvec4> randomPoints(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<glm::dvec4> points;
    while (points.size() < count)
        points.push_back(glm::normalize(glm::dvec4(normal(random), normal(random), normal(random), normal(random))));
    return points;
}

DensityPlot densityOf(const std::vector<glm::dvec4>& points, const glm::dmat4& turn = glm::dmat4(1),
                      double radius = 1) {
    DensityPlot density;
    density.compute(points, turn, radius);
    return density;
}

std::uint32_t weightAt(const DensityPlot& density, int row, int column) {
    return density.weights()[DensityPlot::index(row, column)];
}

TEST(DensityPlot, EachColumnAddsUpToTheNumberOfVertices) {
    for (const std::size_t count : {0u, 1u, 301u, 5000u}) {
        const DensityPlot density = densityOf(randomPoints(count, 1));
        for (int column = 0; column < DensityPlot::kColumns; ++column) {
            std::uint32_t sum = 0;
            for (int row = 0; row < DensityPlot::kRows; ++row) sum += weightAt(density, row, column);
            ASSERT_EQ(sum, DensityPlot::kLineWeight * count) << "column " << column;
        }
    }
}

TEST(DensityPlot, DoesNotDependOnTheOrderOfVertices) {
    std::vector<glm::dvec4> points = randomPoints(1000, 2);
    const DensityPlot before = densityOf(points);
    std::shuffle(points.begin(), points.end(), std::mt19937(3));
    const DensityPlot after = densityOf(points);
    EXPECT_TRUE(std::ranges::equal(before.weights(), after.weights()));
}

TEST(DensityPlot, OneVertexIsALineFromAxisToAxis) {
    // With the circumradius 1, these coordinates are at the two ends of an axis, in its middle, and halfway between the
    // middle and an end.
    const glm::dvec4 point(1, -1, 0, 0.5);
    const DensityPlot density = densityOf({point});
    for (int k = 0; k < 4; ++k)
        EXPECT_EQ(weightAt(density, kMiddleRow - static_cast<int>(point[k] * kMiddleRow), k * DensityPlot::kGap),
                  DensityPlot::kLineWeight)
            << "axis " << k;
    // The mean row of every column lies on the line of the vertex, to within half a row.
    for (int column = 0; column < DensityPlot::kColumns; ++column) {
        const int gap = std::min(column / DensityPlot::kGap, 2);
        const double t = double(column - gap * DensityPlot::kGap) / DensityPlot::kGap;
        double mean = 0;
        for (int row = 0; row < DensityPlot::kRows; ++row) mean += row * double(weightAt(density, row, column));
        const double level = (1 - t) * point[gap] + t * point[gap + 1];
        EXPECT_NEAR(mean / DensityPlot::kLineWeight, kMiddleRow * (1 - level), 0.5 / DensityPlot::kLineWeight + 1e-6);
    }
}

TEST(DensityPlot, TurnsAndScalesTheVertices) {
    const auto points = randomPoints(500, 4);
    const geometry::Rotation turn(geometry::RotationAngles{geometry::Plane::xw, 0.7, 1.1});
    std::vector<glm::dvec4> turned;
    for (const glm::dvec4& p : points) turned.push_back(2.0 * (turn.matrix() * p));
    const DensityPlot a = densityOf(points, turn.matrix()), b = densityOf(turned, glm::dmat4(1), 2);
    std::uint32_t apart = 0;
    for (std::size_t i = 0; i < a.weights().size(); ++i)
        apart += a.weights()[i] > b.weights()[i] ? a.weights()[i] - b.weights()[i] : b.weights()[i] - a.weights()[i];
    EXPECT_LT(apart, 20u) << "but for a few on the boundaries of steps";
}

TEST(DensityPlot, OfACentrallySymmetricPolytopeIsItsMirrorImage) {
    for (const char* name : {"120-cell", "omnitruncated 24-cell"}) {
        const auto polytope = support::shared(name);
        for (const double angle : {0.0, 0.4}) {
            const geometry::Rotation turn(geometry::RotationAngles{geometry::Plane::xw, angle, 3 * angle});
            // Opposite vertices of the polytope are opposite only up to rounding. So the test uses exact opposites.
            std::vector<glm::dvec4> points;
            for (const glm::dvec4& p : polytope->vertices) {
                points.push_back(p);
                points.push_back(-p);
            }
            const DensityPlot density = densityOf(points, turn.matrix(), polytope->circumradius);
            for (int row = 0; row < DensityPlot::kRows; ++row)
                for (int column = 0; column < DensityPlot::kColumns; ++column)
                    ASSERT_EQ(weightAt(density, row, column), weightAt(density, DensityPlot::kRows - 1 - row, column));
        }
    }
}

TEST(DensityPlot, TonesGrowWithTheWeights) {
    const DensityPlot density = densityOf(randomPoints(2000, 5));
    const auto weights = density.weights();
    const auto tones = density.tones();
    const std::uint32_t most = *std::ranges::max_element(weights);
    for (std::size_t i = 0; i < weights.size(); ++i) {
        EXPECT_NEAR(tones[i], 255 * std::sqrt(double(weights[i]) / most), 0.51);
        EXPECT_EQ(weights[i] == 0, tones[i] == 0);
    }
}

TEST(DensityPlot, KeepsItsMemory) {
    const auto points = randomPoints(1000, 6);
    DensityPlot density = densityOf(points);
    const std::uint32_t* weights = density.weights().data();
    const std::uint8_t* tones = density.tones().data();
    density.compute(points, geometry::Rotation(geometry::RotationAngles{geometry::Plane::xy, 1, {}}).matrix(), 1);
    EXPECT_EQ(density.weights().data(), weights);
    EXPECT_EQ(density.tones().data(), tones);
}

TEST(DensityPlot, IsShownForManyVerticesOnly) {
    const geometry::Rotation turn(geometry::RotationAngles{geometry::Plane::yw, 0.3, {}});
    slicing::SliceSet slices;
    const auto composed = [&](const char* name, const scene::Look& look) {
        const auto polytope = support::shared(name);
        slicing::CellComplexSlicer().slice(*polytope, turn, {-10, 21, polytope->circumradius / 10}, slices);
        scene::Scene scene;
        scene::Composer().compose(polytope, turn, slices, 0, look, {}, scene);
        return scene;
    };
    EXPECT_FALSE(composed("600-cell", {}).showsDensityStrip());  // it has 120 vertices
    scene::Look without;
    without.parts.coordinates = false;
    EXPECT_FALSE(composed("120-cell", without).showsDensityStrip());
    const scene::Scene scene = composed("120-cell", {});  // it has 600 vertices
    EXPECT_TRUE(scene.showsDensityStrip());
    const auto polytope = support::shared("120-cell");
    const DensityPlot alone = densityOf(polytope->vertices, turn.matrix(), polytope->circumradius);
    EXPECT_TRUE(std::ranges::equal(scene.plotTones, alone.tones()));
}

TEST(DensityPlot, FollowsPolytopeAndTurn) {
    scene::Composer composer;
    scene::Scene scene;
    slicing::SliceSet slices;
    const auto show = [&](const char* name, double angle) {
        const auto polytope = support::shared(name);
        const geometry::Rotation turn(geometry::RotationAngles{geometry::Plane::xw, angle, {}});
        slicing::CellComplexSlicer().slice(*polytope, turn, {-10, 21, polytope->circumradius / 10}, slices);
        composer.compose(polytope, turn, slices, 0, {}, {}, scene);
        const DensityPlot fresh = densityOf(polytope->vertices, turn.matrix(), polytope->circumradius);
        EXPECT_TRUE(std::ranges::equal(scene.plotTones, fresh.tones())) << name << ' ' << angle;
    };
    show("120-cell", 0.1);
    show("120-cell", 0.2);
    show("rectified 600-cell", 0.2);
    show("120-cell", 0.2);
}

}  // namespace
