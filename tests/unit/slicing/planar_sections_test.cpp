// Tests of sections by planes: they are compared with the object's own inequalities and with each other.

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "geometry/point_cloud.hpp"
#include "slicing/planar_sections.hpp"
#include "slicing/slicer.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::slicing {
namespace {

using geometry::Rotation;
using polytopes::Polytope;
using support::named;
using support::objectOf;

PlanarSections sectionsOf(const Object& object, const Rotation& orientation, const glm::dvec4& point,
                          double spacing = 1) {
    Slicer slicer;
    SliceSet slices;
    slicer.sliceWithoutSurfaces(object, orientation, {0, 1, spacing, point.w}, slices);
    PlanarSections sections;
    PlanarSlicer planar;
    planar.slice(object, orientation, slices, 0, point, sections);
    return sections;
}

glm::dvec4 lift(const PlanarSection& section, const glm::dvec2& p, glm::dvec4 point) {
    point[section.axes[0]] = p.x;
    point[section.axes[1]] = p.y;
    return point;
}

double areaOf(const PlanarSection& section) {
    double twice = 0;
    const auto& boundary = section.boundary;
    for (std::size_t i = 0; i < boundary.size(); ++i) {
        const glm::dvec2 a = section.points[boundary[i]], b = section.points[boundary[(i + 1) % boundary.size()]];
        twice += a.x * b.y - a.y * b.x;
    }
    return std::abs(twice) / 2;
}

/// Returns the positions along `axis` at which the edges of a section cross the line through `point` parallel to
/// `axis`.
std::vector<double> crossingsOf(const PlanarSection& section, int axis, const glm::dvec4& point) {
    const int along = section.axes[0] == axis ? 0 : 1;
    const double level = point[section.axes[1 - along]];
    std::vector<double> list;
    for (const auto& [a, b] : section.edges) {
        const glm::dvec2 p = section.points[a], q = section.points[b];
        const double from = p[1 - along] - level, to = q[1 - along] - level;
        if ((from < 0) != (to < 0)) list.push_back(p[along] + from / (from - to) * (q[along] - p[along]));
    }
    std::ranges::sort(list);
    return list;
}

class PlanarSectionsOf : public testing::TestWithParam<const char*> {};

// The section of a convex polytope by a plane is the polygon that its cells bound. The polygon is closed, its points
// satisfy the inequalities of all cells, and each of its edges lies in the hyperplane of its cell.
TEST_P(PlanarSectionsOf, AreThePolygonsThatTheCellsBound) {
    const Polytope& p = named(GetParam());
    std::vector<glm::dvec4> normals;
    std::vector<double> offsets;
    findCellHyperplanes(objectOf(p), normals, offsets);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> coordinate(-0.25, 0.25);
    for (int turn = 0; turn < 12; ++turn) {
        const Rotation orientation = turn == 0 ? Rotation{} : support::randomRotation(random);
        const double r = p.circumradius;
        // Planes through the center of a polytope that is not rotated meet many elements in special ways.
        const glm::dvec4 point =
            turn < 2 ? glm::dvec4(0)
                     : r * glm::dvec4(coordinate(random), coordinate(random), coordinate(random), coordinate(random));
        const PlanarSections sections = sectionsOf(objectOf(p), orientation, point);
        const auto back = glm::transpose(orientation.matrix());
        for (std::size_t i = 0; i < sections.size(); ++i) {
            const PlanarSection& section = sections[i];
            SCOPED_TRACE(testing::Message() << "turn " << turn << ", plane " << i);
            ASSERT_EQ(section.axes, kPlaneAxes[i]);
            ASSERT_GE(section.points.size(), 3u);
            ASSERT_EQ(section.boundary.size(), section.points.size());
            ASSERT_EQ(section.edges.size(), section.points.size());
            ASSERT_GT(areaOf(section), 1e-3 * r * r);
            for (const glm::dvec2& at : section.points) {
                const glm::dvec4 own = back * lift(section, at, point);
                for (std::size_t c = 0; c < normals.size(); ++c) {
                    ASSERT_LE(glm::dot(normals[c], own) - offsets[c], 1e-8 * r * glm::length(normals[c]));
                }
            }
            for (std::size_t e = 0; e < section.edges.size(); ++e) {
                const std::uint32_t source = section.edgeSource[e];
                const std::uint32_t cell = source < p.cells.size() ? source : p.faceCells[source - p.cells.size()][0];
                for (const std::uint32_t end : section.edges[e]) {
                    const glm::dvec4 own = back * lift(section, section.points[end], point);
                    ASSERT_NEAR(glm::dot(normals[cell], own), offsets[cell], 1e-8 * r * glm::length(normals[cell]));
                }
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Polytopes, PlanarSectionsOf,
                         testing::Values("5-cell", "tesseract", "16-cell", "24-cell", "120-cell", "600-cell",
                                         "truncated tesseract", "5,7-duoprism", "snub 24-cell", "grand antiprism"));

// Sections by different planes agree where the planes meet. The planes xy and xz meet in a line parallel to x. Both
// sections cross this line in the same points.
TEST(PlanarSections, AgreeOnTheLinesInWhichTheyMeet) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> coordinate(-0.3, 0.3);
    for (const char* name : {"tesseract", "600-cell", "{5/2,5,3}", "{5,3,5/2}", "{3,3,5/2}"}) {
        const Polytope& p = named(name);
        const double r = p.circumradius;
        for (int turn = 0; turn < 8; ++turn) {
            SCOPED_TRACE(testing::Message() << name << ", turn " << turn);
            const Rotation orientation = support::randomRotation(random);
            const glm::dvec4 point =
                r * glm::dvec4(coordinate(random), coordinate(random), coordinate(random), coordinate(random));
            const PlanarSections sections = sectionsOf(objectOf(p), orientation, point);
            for (int axis = 0; axis < 4; ++axis) {
                std::vector<std::vector<double>> lists;
                for (const PlanarSection& section : sections) {
                    if (section.axes[0] == axis || section.axes[1] == axis)
                        lists.push_back(crossingsOf(section, axis, point));
                }
                ASSERT_EQ(lists.size(), 3u);
                for (const auto& list : lists) {
                    ASSERT_EQ(list.size(), lists[0].size());
                    ASSERT_GE(list.size(), 2u);
                    for (std::size_t i = 0; i < list.size(); ++i) ASSERT_NEAR(list[i], lists[0][i], 1e-7 * r);
                }
            }
        }
    }
}

TEST(PlanarSections, OfATesseractThroughItsCenterAreSquares) {
    const Polytope& p = named("tesseract");
    const double side = 2 * p.vertices[0].x;
    for (const PlanarSection& section : sectionsOf(objectOf(p), Rotation{}, glm::dvec4(0))) {
        EXPECT_EQ(section.points.size(), 4u);
        EXPECT_NEAR(areaOf(section), side * side, 1e-12);
        EXPECT_EQ(std::set(section.edgeSource.begin(), section.edgeSource.end()).size(), 4u);
    }
}

TEST(PlanarSections, InACellAreSectionsOfTheCell) {
    const Polytope& p = named("tesseract");
    const double half = std::abs(p.vertices[0].x);
    for (const double w : {half, -half}) {
        const PlanarSections sections = sectionsOf(objectOf(p), Rotation{}, {0, 0, 0, w});
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(areaOf(sections[i]), 4 * half * half, 1e-12);
    }
    for (const double x : {half, -half}) {
        const PlanarSections sections = sectionsOf(objectOf(p), Rotation{}, {x, 0, 0, 0});
        EXPECT_NEAR(areaOf(sections[2]), 4 * half * half, 1e-12);  // the plane yz cuts the cube x = const
    }
}

TEST(PlanarSections, BesideTheObjectAreEmpty) {
    const Polytope& p = named("24-cell");
    for (const PlanarSection& section : sectionsOf(objectOf(p), Rotation{}, glm::dvec4(2 * p.circumradius))) {
        EXPECT_TRUE(section.points.empty());
        EXPECT_TRUE(section.edges.empty());
        EXPECT_TRUE(section.boundary.empty());
    }
}

TEST(PlanarSections, OfACloudAreThePointsNearThePlane) {
    const auto cloud = std::make_shared<geometry::PointCloud>();
    std::mt19937 random(3);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    for (int i = 0; i < 4000; ++i)
        cloud->points.emplace_back(coordinate(random), coordinate(random), coordinate(random), coordinate(random));
    cloud->radii.assign(cloud->points.size(), 0);
    cloud->circumradius = 2;
    cloud->serial = geometry::nextSerial();
    const double spacing = 0.3;
    const glm::dvec4 point(0.1, -0.2, 0.3, 0.15);
    const PlanarSections sections = sectionsOf(Object(CloudPtr(cloud)), Rotation{}, point, spacing);
    for (const PlanarSection& section : sections) {
        std::set<std::uint32_t> expected;
        for (std::uint32_t i = 0; i < cloud->points.size(); ++i) {
            bool near = true;
            for (int axis = 0; axis < 4; ++axis) {
                const bool inPlane = axis == section.axes[0] || axis == section.axes[1];
                near = near && (inPlane || std::abs(cloud->points[i][axis] - point[axis]) <= spacing / 2);
            }
            if (near) expected.insert(i);
        }
        EXPECT_GT(expected.size(), 20u);
        EXPECT_EQ(std::set(section.pointSource.begin(), section.pointSource.end()), expected);
        EXPECT_EQ(section.ballOpacity.size(), section.points.size());
        for (const float opacity : section.ballOpacity) EXPECT_TRUE(opacity > 0.03F && opacity <= 1);
    }
}

}  // namespace
}  // namespace oval4d::slicing
