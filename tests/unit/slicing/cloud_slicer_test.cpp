// Tests of slices of point clouds.

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <set>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "geometry/point_cloud.hpp"
#include "slicing/object.hpp"
#include "slicing/object_bytes.hpp"
#include "slicing/slicer.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::slicing {
namespace {

using geometry::makePointCloud;
using geometry::PointCloud;

CloudPtr randomCloud(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    std::vector<glm::dvec4> points;
    std::vector<double> radii;
    for (std::size_t i = 0; i < count; ++i) {
        points.emplace_back(coordinate(random), coordinate(random), coordinate(random), coordinate(random));
        radii.push_back(i % 3 == 0 ? 0.01 * static_cast<double>(i % 7 + 1) : 0);
    }
    return std::make_shared<const PointCloud>(makePointCloud("cloud", points, radii));
}

TEST(CloudSlicer, showsEachPointInTheSliceNearestToIt) {
    std::mt19937 random(3);
    const CloudPtr cloud = randomCloud(500, 1);
    for (int round = 0; round < 20; ++round) {
        const geometry::Rotation turn = support::randomRotation(random);
        const geometry::Hyperplanes planes{-6, 13, 0.3};  // these hyperplanes reach beyond the cloud on both sides
        SliceSet slices;
        Slicer().sliceWithoutSurfaces(Object(cloud), turn, planes, slices);
        std::set<std::uint32_t> seen;
        for (int i = 0; i < planes.count; ++i) {
            for (auto v = slices.vertexBegin[i]; v < slices.vertexBegin[i + 1]; ++v) {
                const auto source = slices.vertexSource[v];
                EXPECT_TRUE(seen.insert(source).second);
                const glm::dvec4 point = turn(cloud->points[source]);
                EXPECT_LT(glm::distance(slices.vertices[v], glm::dvec3(point)), 1e-12);
                const double distance = std::abs(point.w - planes.w(i));
                EXPECT_LE(distance, planes.spacing / 2 + 1e-12);
                EXPECT_NEAR(slices.ballOpacity[v], 1 - 0.8 * distance / (planes.spacing / 2), 1e-6);
                if (cloud->radii[source] > 0) {
                    EXPECT_NEAR(slices.ballScale[v] * relativeBallRadius(Object(cloud)) * cloud->circumradius,
                                cloud->radii[source], 1e-6);
                } else {
                    EXPECT_EQ(slices.ballScale[v], 1);
                }
            }
            EXPECT_EQ(slices.edgeCount(i), 0U);
            EXPECT_EQ(slices.faceCount(i), 0U);
        }
        EXPECT_EQ(seen.size(), cloud->points.size());
    }
}

TEST(CloudSlicer, leavesOutWhatIsBeyondTheSlices) {
    const auto cloud = std::make_shared<const PointCloud>(
        makePointCloud("line", {{0, 0, 0, -3}, {0, 0, 0, 0.1}, {0, 0, 0, 3}}, {0, 0, 0}));
    SliceSet slices;
    Slicer().sliceWithoutSurfaces(Object(cloud), {}, {-1, 3, 1}, slices);
    EXPECT_EQ(slices.totalCounts().vertices, 1U);
    EXPECT_EQ(slices.vertexCount(1), 1U);
    EXPECT_EQ(slices.vertexSource[0], 1U);
    EXPECT_EQ(slices.rotatedVertices.size(), 3U);
}

TEST(CloudSlicer, alternatesWithPolytopes) {
    Slicer slicer;
    SliceSet slices;
    slicer.sliceWithoutSurfaces(Object(randomCloud(30, 2)), {}, {-2, 5, 0.5}, slices);
    slicer.sliceWithoutSurfaces(Object(support::shared("24-cell")), {}, {-2, 5, 0.5}, slices);
    EXPECT_TRUE(slices.ballScale.empty());
    EXPECT_TRUE(slices.ballOpacity.empty());
    EXPECT_GT(slices.totalCounts().faces, 0U);
}

TEST(CloudSlicer, anObjectTellsWhatItIs) {
    const Object object = randomCloud(100, 4);
    EXPECT_EQ(elementCounts(object), (std::array<std::size_t, 4>{100, 0, 0, 0}));
    EXPECT_EQ(infoOf(object).name, "cloud");
    EXPECT_TRUE(infoOf(object).cellTypes.empty());
    EXPECT_GT(memoryOf(object), 100 * sizeof(glm::dvec4));
    const auto [least, most] = rangeOfW(object, {});
    EXPECT_GE(least, -1);
    EXPECT_LE(most, 1);
}

TEST(CloudSlicer, bytesBringItBack) {
    const Object object = randomCloud(64, 5);
    const PointCloud& cloud = *std::get<CloudPtr>(object);
    std::string bytes;
    MappedFiles files;
    encodeObject(object, bytes, files);
    const Object whole = decodeObject(bytes);
    EXPECT_EQ(std::get<CloudPtr>(whole)->points, cloud.points);
    EXPECT_EQ(infoOf(whole).serial, cloud.serial);
    std::string parts;
    serialization::ByteWriter writer(parts);
    writeObjectContent(object, writer, files);
    serialization::ByteReader reader(parts);
    const Object again = readObjectContent(reader, "again", 64);
    EXPECT_EQ(std::get<CloudPtr>(again)->points, cloud.points);
    EXPECT_EQ(std::get<CloudPtr>(again)->radii, cloud.radii);
    EXPECT_EQ(infoOf(again).name, "again");
    serialization::ByteReader small(parts);
    EXPECT_THROW(readObjectContent(small, "again", 63), std::runtime_error);
    for (std::size_t size = 0; size < parts.size(); size += 37) {
        serialization::ByteReader cut(std::string_view(parts).substr(0, size));
        EXPECT_THROW(readObjectContent(cut, "again", 64), std::runtime_error);
    }
}

TEST(PointCloud, refusesWhatIsNone) {
    const double infinite = std::numeric_limits<double>::infinity();
    EXPECT_THROW(makePointCloud("c", {}, {}), std::invalid_argument);
    EXPECT_EQ(makePointCloud("c", {{0, 0, 0, 0}}, {0}).circumradius, 1) << "points at the origin are shown";
    EXPECT_EQ(makePointCloud("c", {{0, 0, 0, 0}, {0, 0, 0, 0}}, {0, 0.5}).circumradius, 0.5);
    EXPECT_THROW(makePointCloud("c", {{infinite, 0, 0, 0}}, {0}), std::invalid_argument);
    EXPECT_THROW(makePointCloud("c", {{1, 0, 0, 0}}, {-1}), std::invalid_argument);
    EXPECT_THROW(makePointCloud("c", {{1, 0, 0, 0}}, {}), std::invalid_argument);
    EXPECT_EQ(makePointCloud("c", {{0, 0, 3, 4}}, {0}).circumradius, 5);
}

}  // namespace
}  // namespace oval4d::slicing
