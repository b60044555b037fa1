// Tests of objects in moving frames of reference: their slices are compared with the exact linear map.

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "fields/field.hpp"
#include "fields/formula_field.hpp"
#include "geometry/point_cloud.hpp"
#include "polytopes/convexity.hpp"
#include "slicing/field_slicer.hpp"
#include "slicing/section_name.hpp"
#include "slicing/slicer.hpp"
#include "unit/slicing/field_support.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::slicing {
namespace {

using geometry::ReferenceFrame;
using support::randomRotation;

ReferenceFrame movingFrame(std::mt19937& random) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(-1, 1);
    const glm::dvec3 direction = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    return {std::exp(uniform(random)), glm::dvec3(uniform(random), uniform(random), uniform(random)),
            0.45 * (1 + uniform(random)) * direction};
}

polytopes::Polytope imageOfPolytope(const polytopes::Polytope& p, const ReferenceFrame& frame) {
    return polytopes::transformedTo(p, frame, geometry::nextSerial());
}

/// Returns the volume of a part of the hyperplane with this w: the points whose images by `inverse` lie in the 8-cell.
/// The volume is found by counting the points of a lattice.
double countedVolume(const glm::dmat4& inverse, double w, double reach) {
    constexpr int kSteps = 120;
    const double step = 2 * reach / kSteps;
    std::size_t inside = 0;
    for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j < kSteps; ++j) {
            for (int k = 0; k < kSteps; ++k) {
                const glm::dvec3 p = step * (glm::dvec3(i, j, k) + 0.5) - reach;
                const glm::dvec4 own = glm::abs(inverse * glm::dvec4(p, w));
                inside += std::max(std::max(own.x, own.y), std::max(own.z, own.w)) <= 1 ? 1 : 0;
            }
        }
    }
    return static_cast<double>(inside) * step * step * step;
}

// In a moving frame, the slices of an 8-cell |x|, |y|, |z|, |w| ≤ 1 are those of its image, which is given by
// half-spaces.
TEST(ReferenceFrames, SlicesOfAnEightCellAreThoseOfItsHalfSpaces) {
    std::mt19937 random(30);
    const auto& tesseract = support::named("8-cell");
    for (int trial = 0; trial < 20; ++trial) {
        const ReferenceFrame frame = movingFrame(random);
        const geometry::Rotation orientation = randomRotation(random);
        const auto image = imageOfPolytope(tesseract, frame);
        const glm::dmat4 inverse = frame.inverse() * orientation.inverse().matrix();
        EXPECT_NEAR(support::hypervolumeBySlices(image, orientation) / (16 * frame.pace), 1, 1e-6);
        for (const double w : {0.0, 0.3, -0.7}) {
            const SliceSet slice = support::cutAt(image, orientation, w);
            for (const glm::dvec3& vertex : slice.vertices) {
                const glm::dvec4 own = glm::abs(inverse * glm::dvec4(vertex, w));
                int walls = 0;
                for (int axis = 0; axis < 4; ++axis) {
                    EXPECT_LT(own[axis], 1 + 1e-9);
                    walls += own[axis] > 1 - 1e-9 ? 1 : 0;
                }
                EXPECT_GE(walls, 3) << "a vertex of the slice lies on three sides of the image";
            }
            if (trial >= 4) continue;
            const double counted = countedVolume(inverse, w, image.circumradius);
            EXPECT_NEAR(support::volumeOf(slice, 0), counted, 0.03 * counted + 0.01) << "trial " << trial;
        }
    }
}

TEST(ReferenceFrames, VerticesOfSlicesLieOnTheImagesOfTheirEdges) {
    std::mt19937 random(31);
    for (const char* name : {"5-cell", "24-cell", "5,7-duoprism", "snub 24-cell", "small stellated 120-cell"}) {
        const auto& p = support::named(name);
        for (int trial = 0; trial < 5; ++trial) {
            const ReferenceFrame frame = movingFrame(random);
            const geometry::Rotation orientation = randomRotation(random);
            const Object image = transformedTo(support::objectOf(p), frame);
            SliceSet slices;
            Slicer().sliceWithoutSurfaces(image, orientation, {-3, 7, infoOf(image).circumradius / 7}, slices);
            const glm::dmat4 inverse = frame.inverse() * orientation.inverse().matrix();
            EXPECT_FALSE(slices.vertices.empty()) << name;
            for (int i = 0; i < 7; ++i) {
                for (auto v = slices.vertexBegin[i]; v < slices.vertexBegin[i + 1]; ++v) {
                    if (slices.vertexSource[v] >= p.edges.size()) continue;
                    const auto& [a, b] = p.edges[slices.vertexSource[v]];
                    const glm::dvec4 own = inverse * glm::dvec4(slices.vertices[v], slices.planes.w(i));
                    const glm::dvec4 along = p.vertices[b] - p.vertices[a];
                    const double t = glm::dot(own - p.vertices[a], along) / glm::dot(along, along);
                    EXPECT_LT(glm::distance(own, p.vertices[a] + t * along), 1e-8 * p.circumradius) << name;
                    EXPECT_TRUE(t > -1e-8 && t < 1 + 1e-8) << name;
                }
            }
        }
    }
}

// An object in a moving frame has the same properties as a polytope built from the moved vertices. The test compares
// the properties that depend on the vertices, but that transformedTo() does not compute anew.
TEST(ReferenceFrames, ImagesHaveThePropertiesOfPolytopesBuiltFromTheirVertices) {
    std::mt19937 random(32);
    for (const char* name : {"8-cell", "24-cell", "rectified 600-cell", "3,5-duoprism", "grand 600-cell"}) {
        const auto& p = support::named(name);
        const ReferenceFrame frame = movingFrame(random);
        const auto image = imageOfPolytope(p, frame);
        const auto built = polytopes::makePolytope("built", image.vertices, image.faces, image.cells, p.typeOfCell);
        EXPECT_NEAR(image.circumradius, built.circumradius, 1e-12 * built.circumradius) << name;
        EXPECT_EQ(image.convex, built.convex) << name;
        EXPECT_EQ(image.convexFaces, built.convexFaces) << name;
        EXPECT_EQ(image.cellSigns, built.cellSigns) << name << ": the orientation of the boundary";
        EXPECT_NE(image.serial, p.serial);
        EXPECT_EQ(image.name, p.name);
        EXPECT_FALSE(image.rebuildableFromName) << "its name is that of another polytope";
    }
}

TEST(ReferenceFrames, TheDefaultFrameShowsTheObjectItself) {
    const Object object = support::objectOf(support::named("24-cell"));
    EXPECT_EQ(transformedTo(object, {}), object);
    EXPECT_NE(transformedTo(object, {2, {}, {}}), object);
}

TEST(ReferenceFrames, SectionsAreNamedByWhatTheyAre) {
    const auto nameIn = [](const ReferenceFrame& frame) {
        const Object image = transformedTo(support::objectOf(support::named("8-cell")), frame);
        EXPECT_TRUE(SectionNamer::mayHaveName(image, {}, 0));
        SliceSet slices;
        Slicer().sliceWithoutSurfaces(image, {}, {0, 1, 1}, slices);
        return std::string(SectionNamer().nameOfSlice(slices, 0));
    };
    EXPECT_EQ(nameIn({}), "cube");
    EXPECT_EQ(nameIn({3, {0.5, 0, 0}, {}}), "cube") << "a shear moves the sections, and leaves them as they are";
    EXPECT_EQ(nameIn({1, {}, {0.6, 0, 0}}), "cuboid") << "the boosted section is shorter than wide";
}

// A moving rod contracts: a rod of the length 2, which exists for a while, is seen in the frame of an observer who
// moves along it.
TEST(ReferenceFrames, RodsContract) {
    const auto rod =
        fields::fieldFromFormula("rod", "0*x-1", {glm::dvec4(-1, -0.1, -0.1, -4), glm::dvec4(1, 0.1, 0.1, 4)});
    ASSERT_TRUE(rod) << rod.error().message;
    for (const double v : {-0.9, 0.3, 0.6, 0.99}) {
        const double gamma = 1 / std::sqrt(1 - v * v);
        const fields::Field image = fields::transformedTo(*rod, {1, {}, {v, 0, 0}}, geometry::nextSerial());
        for (const double w : {-0.2, 0.0, 0.2}) {
            FieldSlicer slicer;
            SliceSet slices;
            const geometry::Hyperplanes planes{0, 1, 1, w};
            slicer.slice(image, {}, planes, {}, detailOf(image, planes, 48), slices);
            glm::dvec3 least(1e9), most(-1e9);
            for (const glm::dvec3& vertex : slices.vertices)
                least = glm::min(least, vertex), most = glm::max(most, vertex);
            EXPECT_NEAR(most.x - least.x, 2 / gamma, 1e-12) << "Lorentz contraction at the velocity " << v;
            EXPECT_NEAR(most.y - least.y, 0.2, 1e-12) << "not across the motion";
            EXPECT_NEAR(0.5 * (most.x + least.x), -v * w, 1e-12) << "the rod moves backward";
            if (gamma > 3) continue;  // the lattice spans the whole image, and is then too coarse for the rod
            const Measure body = measure(slices.surfaces[0], 0);
            EXPECT_EQ(body.unpaired, 0U);
            EXPECT_NEAR(body.volume, 2 / gamma * 0.04, 0.002 * 2 / gamma) << "the field is cut as its box is";
        }
    }
}

// In the frame of the barn, its two doors are closed at the same time, and the ladder fits between them. In the frame
// of the ladder, the barn is too short, and the doors are closed at different times.
TEST(ReferenceFrames, TheLadderAndTheBarnDisagreeAboutWhatIsSimultaneous) {
    const double v = 0.6, barn = 1.6;
    const glm::dvec4 front(0.5 * barn, 0, 0, 0), rear(-0.5 * barn, 0, 0, 0);
    const auto doors = geometry::makePointCloud("doors", {front, rear}, {0, 0});
    const auto seen = geometry::transformedTo(doors, {1, {}, {v, 0, 0}}, geometry::nextSerial());
    EXPECT_NEAR(seen.points[0].x - seen.points[1].x, 1.25 * barn, 1e-12);
    EXPECT_NEAR(seen.points[0].w, -1.25 * v * 0.5 * barn, 1e-12) << "the front door is closed first";
    EXPECT_NEAR(seen.points[1].w, 1.25 * v * 0.5 * barn, 1e-12);
}

TEST(ReferenceFrames, WhatIsFollowedHasEqualSlices) {
    const auto field =
        fields::fieldFromFormula("ball", "(x-0.3*t)^2 + y^2 + (z-0.1*t)^2 - 0.04", {glm::dvec4(-1.5), glm::dvec4(1.5)});
    ASSERT_TRUE(field) << field.error().message;
    for (const double pace : {0.5, 1.0, 2.0}) {
        for (const bool followed : {true, false}) {
            const ReferenceFrame frame{pace, followed ? glm::dvec3(0.3, 0, 0.1) : glm::dvec3(0), {}};
            const fields::Field image = fields::transformedTo(*field, frame, geometry::nextSerial());
            FieldSlicer slicer;
            SliceSet slices;
            const geometry::Hyperplanes planes{-3, 7, 0.4 * pace, 0};
            slicer.slice(image, {}, planes, {}, detailOf(image, planes, 128), slices);
            for (int i = 0; i < 7; ++i) {
                const SliceSurface& surface = slices.surfaces[static_cast<std::size_t>(i)];
                const Measure ball = measure(surface, 0);
                EXPECT_EQ(ball.unpaired, 0U);
                const double time = slices.planes.w(i) / pace;
                const glm::dvec3 expected = followed ? glm::dvec3(0) : glm::dvec3(0.3, 0, 0.1) * time;
                EXPECT_LT(glm::distance(ball.moment / ball.volume, expected), 0.002) << pace << ' ' << i;
                for (const float growth : surface.growth)
                    EXPECT_TRUE(!followed || std::abs(growth) < 1e-3F) << "what stands still does not grow";
            }
        }
    }
}

// In a moving frame, the surfaces of a field lie on the level. The values and normals at their points are those of the
// function at the points mapped back into its box.
TEST(ReferenceFrames, SurfacesOfFieldsLieOnTheLevel) {
    std::mt19937 random(33);
    const fields::Box box{glm::dvec4(-1, -1, -0.8, 0), glm::dvec4(1, 1.2, 1, 2)};
    const auto f = [](const glm::dvec4& p) { return p.x * p.x + p.y * p.y + 0.5 * p.z - 0.3 * p.w; };
    const auto gradient = [](const glm::dvec4& p) { return glm::dvec4(2 * p.x, 2 * p.y, 0.5, -0.3); };
    for (int trial = 0; trial < 6; ++trial) {
        const ReferenceFrame frame = movingFrame(random);
        const geometry::Rotation orientation = randomRotation(random);
        const fields::Field field = testField(f, 5, box);
        const fields::Field image = fields::transformedTo(field, frame, geometry::nextSerial());
        FieldSlicer slicer;
        SliceSet slices;
        const geometry::Hyperplanes planes{-2, 5, image.circumradius / 8, 0.01};
        slicer.slice(image, orientation, planes, {}, detailOf(image, planes, 160), slices);
        const glm::dmat4 inverse = frame.inverse() * orientation.inverse().matrix();
        std::size_t points = 0, onLevel = 0;
        for (int i = 0; i < 5; ++i) {
            const SliceSurface& surface = slices.surfaces[static_cast<std::size_t>(i)];
            EXPECT_EQ(measure(surface, 0).unpaired, 0U);
            for (std::size_t k = 0; k < surface.points.size(); ++k) {
                const glm::dvec4 own = box.center() + inverse * glm::dvec4(surface.points[k], slices.planes.w(i));
                EXPECT_NEAR(surface.values[k], f(own), 1e-4);
                const glm::dvec3 slope(glm::transpose(inverse) * gradient(own));
                EXPECT_LT(glm::distance(glm::normalize(slope), glm::dvec3(surface.normals[k])), 0.02);
                const glm::dvec4 toSide = glm::min(own - box.min, box.max - own);
                const double nearest = std::min(std::min(toSide.x, toSide.y), std::min(toSide.z, toSide.w));
                EXPECT_GT(nearest, -0.05) << "trial " << trial;
                ++points;
                onLevel += std::abs(f(own)) < 0.01 || std::abs(nearest) < 0.01 ? 1 : 0;
            }
        }
        EXPECT_GT(points, 50U);
        EXPECT_GT(onLevel, points * 9 / 10) << "one step of Newton's method leads there, except at edges";
    }
}

TEST(ReferenceFrames, TheMemoryOfAFunctionIsCountedOnce) {
    auto field = fields::fieldFromFormula("f", "x*y+z*w", {glm::dvec4(-1), glm::dvec4(1)});
    ASSERT_TRUE(field);
    const Object object = std::make_shared<const fields::Field>(*field);
    const Object image = transformedTo(object, {2, {}, {}});
    EXPECT_EQ(memoryOf(object) - memoryOf(image), field->function->memoryBytes());
    EXPECT_EQ(fieldIn(image)->function, field->function) << "nothing is sampled again";
    const Object polytope = support::objectOf(support::named("24-cell"));
    EXPECT_EQ(memoryOf(transformedTo(polytope, {2, {}, {}})), memoryOf(polytope));
}

}  // namespace
}  // namespace oval4d::slicing
