// Tests of picking: which element a picture shows at a pixel.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <random>
#include <utility>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "fields/formula_field.hpp"
#include "geometry/point_cloud.hpp"
#include "scene/composer.hpp"
#include "scene/density_strip_lines.hpp"
#include "scene/pick.hpp"
#include "slicing/slicer.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::scene {
namespace {

using slicing::ElementKind;

// A picture, and the element that it shows at a pixel.
struct Picture {
    slicing::Object object;
    slicing::SliceSet slices;
    Composer composer;
    Scene scene;

    Picture(const char* name, const Look& look, const geometry::Rotation& orientation, int count = 21)
        : Picture(support::shared(name), look, orientation, count) {}
    Picture(slicing::Object shown, const Look& look, const geometry::Rotation& orientation, int count = 21)
        : object(std::move(shown)) {
        const double radius = slicing::infoOf(object).circumradius;
        slicing::Slicer().sliceWithoutSurfaces(object, orientation,
                                               {-(count - 1) / 2, count, 2 * radius / std::max(count - 1, 1)}, slices);
        composer.compose(object, orientation, slices, 0, look, {1280, 720}, scene);
    }

    // Returns the pixel of a point in world space, counted from the upper left corner, and the depth of the point.
    glm::dvec3 project(const glm::dvec3& world) const {
        const glm::dvec4 clip = scene.camera.projection(1280.0 / 720) * scene.camera.view() * glm::dvec4(world, 1);
        return {(clip.x / clip.w + 1) / 2 * 1280, (1 - clip.y / clip.w) / 2 * 720, clip.w};
    }
    std::optional<PickedElement> at(const glm::dvec3& pixel) { return pickElement(scene, object, {pixel.x, pixel.y}); }
};

TEST(Pick, FindsTheVertexThatIsNearestToTheViewer) {
    std::mt19937 random(5);
    for (const char* name : {"5-cell", "24-cell", "600-cell"}) {
        Picture picture(name, {}, support::randomRotation(random));
        for (std::size_t i = 0; i < picture.scene.placements.size(); ++i) {
            // A slice cannot hide its own vertex that is nearest to the eye.
            std::optional<std::uint32_t> nearest;
            glm::dvec3 pixel(0, 0, 1e9);
            for (std::uint32_t v = picture.slices.vertexBegin[i]; v < picture.slices.vertexBegin[i + 1]; ++v) {
                const glm::dvec3 p = picture.project(picture.scene.placements[i].position +
                                                     picture.scene.scale * picture.slices.vertices[v]);
                if (p.z >= pixel.z) continue;
                pixel = p;
                nearest = v;
            }
            if (!nearest) continue;
            const auto hit = picture.at(pixel);
            ASSERT_TRUE(hit) << name << ", slice " << i;
            if (hit->in != PickLocation::slice || hit->slice != i) continue;  // another slice is in front of the vertex
            EXPECT_EQ(hit->element, (slicing::Element{ElementKind::edge, picture.slices.vertexSource[*nearest]}));
        }
    }
}

// At a point of a panel of the matrix, the element of the panel's section is found. The 4-D point that the panel shows
// lies in the plane of the panel.
TEST(Pick, FindsTheElementsOfPlanarSections) {
    std::mt19937 random(8);
    Look look;
    look.view = View::matrix;
    look.focusPoint = {0.05, -0.1, 0.15};
    for (const char* name : {"5-cell", "24-cell", "grand antiprism"}) {
        Picture picture(name, look, support::randomRotation(random));
        const SectionMatrixLayout& layout = picture.scene.matrix;
        const SectionMatrix& matrix = picture.scene.sectionMatrix;
        const auto counts = slicing::elementCounts(picture.object);
        const double scale = layout.panel / 2 / SectionMatrixLayout::kReach / picture.scene.circumradius;
        for (const slicing::PlanarSection& section : matrix.sections) {
            for (const bool transposed : {false, true}) {
                const int row = section.axes[transposed ? 0 : 1], column = section.axes[transposed ? 1 : 0];
                const auto pixelOf = [&](const glm::dvec2& p) {
                    const glm::dvec2 at = layout.center(row, column) + scale * (transposed ? glm::dvec2(p.y, p.x) : p);
                    return glm::dvec3(720 * at.x, 720 * (1 - at.y), 0);
                };
                for (std::size_t e = 0; e < section.edges.size(); ++e) {
                    const glm::dvec2 a = section.points[section.edges[e][0]], b = section.points[section.edges[e][1]];
                    // The points at the ends of a short edge hide the edge.
                    if (glm::distance(a, b) * scale * 720 < 20) continue;
                    const auto hit = picture.at(pixelOf(0.5 * (a + b)));
                    ASSERT_TRUE(hit) << name;
                    EXPECT_EQ(hit->in, PickLocation::matrix);
                    EXPECT_EQ(hit->element, (slicing::Element{ElementKind::cell, section.edgeSource[e]}));
                    const auto end = picture.at(pixelOf(a));
                    ASSERT_TRUE(end);
                    EXPECT_EQ(end->element.kind, ElementKind::face) << "points are cut from 2-faces";
                    EXPECT_LT(end->element.index, counts[2]);
                }
                const glm::dvec3 pixel = pixelOf(section.points[0]);
                const auto point = matrixPointAt(picture.scene, {pixel.x, pixel.y});
                ASSERT_TRUE(point);
                glm::dvec4 expected = matrix.point;
                expected[section.axes[0]] = section.points[0].x;
                expected[section.axes[1]] = section.points[0].y;
                EXPECT_LT(glm::distance(*point, expected), 1e-9);
            }
        }
        Look zoomed = look;
        zoomed.orbit.zoom = 20;
        Picture near(name, zoomed, {});
        const glm::dvec2 corner = near.scene.matrix.center(3, 0) + glm::dvec2(0.49 * near.scene.matrix.panel);
        EXPECT_FALSE(near.at({720 * corner.x, 720 * (1 - corner.y), 0})) << "panels cover the slice behind them";
        EXPECT_TRUE(near.at({720 * (near.scene.matrix.left - 0.05), 360, 0}));
        // The panels on the diagonal have only names. The slice is to the left of the matrix.
        const glm::dvec2 diagonal = layout.center(1, 1);
        EXPECT_FALSE(matrixPointAt(picture.scene, {720 * diagonal.x, 720 * (1 - diagonal.y)}));
        EXPECT_FALSE(matrixPointAt(picture.scene, {720 * layout.left - 1, 360}));
    }
}

TEST(Pick, FindsPointsOfACloudInTheMatrixAsFarAsTheyAreDrawn) {
    Look look;
    look.view = View::matrix;
    const auto cloud = std::make_shared<const geometry::PointCloud>(
        geometry::makePointCloud("dots", {{0, 0, 0, 0}, {1, 0, 0, 0}, {-1, 0, 0, 0}}, {0.5, 0, 0}));
    Picture picture(cloud, look, {}, 1);
    const SectionMatrixLayout& layout = picture.scene.matrix;
    ASSERT_EQ(picture.scene.sectionMatrix.sections[0].ballScale.size(), 3U);
    const double radius = layout.pointRadius * picture.scene.sectionMatrix.sections[0].ballScale[0];
    ASSERT_GT(radius * 720, 6) << "larger than what is found in any case";
    const auto at = [&](double distance) {
        const glm::dvec2 place = layout.center(1, 0) + glm::dvec2(0, distance);
        return picture.at({720 * place.x, 720 * (1 - place.y), 0});
    };
    const auto hit = at(0.9 * radius);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->in, PickLocation::matrix);
    EXPECT_EQ(hit->element, (slicing::Element{ElementKind::vertex, 0}));
    EXPECT_FALSE(at(1.1 * radius));
}

TEST(Pick, FindsFacesBarsAndNothing) {
    std::mt19937 random(6);
    Look look;
    look.view = View::single;
    look.parts.balls = look.parts.bars = false;
    for (int round = 0; round < 20; ++round) {
        Picture picture("120-cell", look, support::randomRotation(random));
        const std::size_t focus = 10;
        const auto& s = picture.slices;
        int found = 0;
        for (std::uint32_t f = s.faceBegin[focus]; f < s.faceBegin[focus + 1]; ++f) {
            glm::dvec3 center(0), area(0);
            const std::uint32_t begin = s.cornerBegin[f], end = s.cornerBegin[f + 1];
            const glm::dvec3 first = support::corner(s, focus, begin);
            for (std::uint32_t c = begin; c < end; ++c) {
                center += support::corner(s, focus, c) / static_cast<double>(end - begin);
                if (c + 1 < end)
                    area += glm::cross(support::corner(s, focus, c) - first, support::corner(s, focus, c + 1) - first);
            }
            const glm::dvec3 world = picture.scene.scale * center;
            // The face is turned away from the viewer.
            if (glm::dot(area, picture.scene.camera.eye - world) <= 0) continue;
            const auto hit = picture.at(picture.project(world));
            ASSERT_TRUE(hit);
            EXPECT_EQ(hit->element, (slicing::Element{ElementKind::cell, s.faceSource[f]}));
            EXPECT_EQ(hit->slice, focus);
            ++found;
        }
        EXPECT_GT(found, 5);
        EXPECT_FALSE(picture.at({2, 2, 0})) << "the corner of the picture is empty";
    }
    look.parts.faces = false;
    look.parts.bars = true;
    Picture picture("tesseract", look, {});
    const auto& s = picture.slices;
    for (std::uint32_t e = s.edgeBegin[10]; e < s.edgeBegin[11]; ++e) {
        const auto& [a, b] = s.edges[e];
        const glm::dvec3 middle = 0.5 * (s.vertices[s.vertexBegin[10] + a] + s.vertices[s.vertexBegin[10] + b]);
        const auto hit = picture.at(picture.project(picture.scene.scale * middle));
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->element.kind, ElementKind::face) << "the bars of a slice are cut from 2-faces";
    }
}

TEST(Pick, FindsNoFaceInTheHoleOfAFace) {
    Look look;
    look.view = View::single;
    look.parts.balls = look.parts.bars = false;
    Picture picture("8-cell", look, {}, 1);
    slicing::SliceSet& s = picture.slices;
    s.vertices = {{-0.9, -0.9, 0}, {0.9, -0.9, 0}, {0.9, 0.9, 0}, {-0.9, 0.9, 0},
                  {-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}};
    s.vertexBegin = {0, 8};
    s.edgeBegin = {0, 0};
    s.faceBegin = {0, 2};
    s.cornerBegin = {0, 4, 8};
    s.corners = {0, 1, 2, 3, 4, 7, 6, 5};  // a square, and a smaller square in the opposite direction inside it
    s.faceSource = {3, 3};
    EXPECT_FALSE(picture.at(picture.project(glm::dvec3(0))));
    const auto hit = picture.at(picture.project(picture.scene.scale * glm::dvec3(0.7, 0, 0)));
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->element, (slicing::Element{ElementKind::cell, 3}));
}

// The box of a field has bars and balls, but no faces. So the bars behind the front of the box are found.
TEST(Pick, FindsNoFacesOfTheBoxOfAField) {
    Look look;
    look.view = View::single;
    look.field.levels = {0.25};
    auto field = fields::fieldFromFormula("ball", "x^2+y^2+z^2+w^2", {glm::dvec4(-1), glm::dvec4(1)});
    Picture picture(std::make_shared<const fields::Field>(*std::move(field)), look, {}, 1);
    const auto& s = picture.slices;
    ASSERT_EQ(s.faceCount(0), 6U) << "the slice of the box is a cube";
    EXPECT_FALSE(picture.at(picture.project(glm::dvec3(0)))) << "the middle of the cube";
    for (std::uint32_t e = 0; e < s.edges.size(); ++e) {
        const glm::dvec3 middle = 0.5 * (s.vertices[s.edges[e][0]] + s.vertices[s.edges[e][1]]);
        const auto hit = picture.at(picture.project(picture.scene.scale * middle));
        ASSERT_TRUE(hit) << e;
        EXPECT_EQ(hit->element.kind, ElementKind::face) << "the bars of a slice are cut from 2-faces";
    }
}

TEST(Pick, FindsTheProjectionsElementsAndTheCoordinatesColumns) {
    Look look;
    look.projection.kind = ProjectionKind::perspective;
    std::mt19937 random(7);
    Picture picture("24-cell", look, support::randomRotation(random));
    const ObjectProjection& projection = picture.scene.projection;
    int found = 0;
    for (std::uint32_t v = 0; v < projection.elements.vertexBegin[1]; ++v) {
        const auto hit = picture.at(picture.project(picture.scene.projectionPlacement.position +
                                                    projection.scale * projection.elements.vertices[v]));
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->in, PickLocation::projection);
        found +=
            hit->element == slicing::Element{ElementKind::vertex, projection.elements.vertexSource[v] - 96} ? 1 : 0;
    }
    EXPECT_GE(found, 12) << "at least the nearer half of the 24 vertices";
    const ParallelCoordinatesLayout& layout = picture.scene.coordinates;
    for (int i = 0; i < 24; ++i) {
        const double x = layout.left + (i % layout.perRow) * layout.columnStep + 1.5 * layout.lineStep;
        const int row = i / layout.perRow;
        const double y = layout.zero - row * layout.rowStep + 0.5 * layout.amplitude;
        const auto hit = picture.at({x * 720, (1 - y) * 720, 0});
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->in, PickLocation::coordinates);
        EXPECT_EQ(hit->element, (slicing::Element{ElementKind::vertex, static_cast<std::size_t>(i)}));
    }
}

TEST(Pick, FindsWhatIsInASliceBeforeTheProjectionFromEverywhere) {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> elevation(-1, 1);
    std::size_t behind = 0;  // the number of pixels at which both slices and the projection show an element
    for (const View view : {View::oval, View::single, View::strip, View::grid}) {
        for (const double azimuth : {-1.2, 0.6, 1.2}) {
            Look look;
            look.view = view;
            look.orbit.azimuth = azimuth;
            look.orbit.elevation = elevation(random);
            look.projection.kind = ProjectionKind::perspective;
            look.parts.coordinates = false;
            look.parts.projectionFaces = true;
            Picture picture("24-cell", look, support::randomRotation(random));
            for (int y = 20; y < 720; y += 40) {
                for (int x = 20; x < 1280; x += 40) {
                    const glm::dvec3 pixel(x, y, 0);
                    picture.scene.projectionPlacement.shown = true;
                    const auto found = picture.at(pixel);
                    picture.scene.projectionPlacement.shown = false;
                    const auto inSlice = picture.at(pixel);
                    if (!inSlice) continue;
                    ASSERT_TRUE(found);
                    EXPECT_EQ(found->in, PickLocation::slice) << x << ", " << y;
                    EXPECT_EQ(found->element, inSlice->element);
                    EXPECT_EQ(found->slice, inSlice->slice);
                    const glm::dvec3 center = picture.project(picture.scene.projectionPlacement.position);
                    const double radius = picture.scene.projectionPlacement.radius * 360 /
                                          std::tan(picture.scene.camera.fieldOfView / 2) / center.z;
                    behind += center.z > 0 && glm::distance(glm::dvec2(center), glm::dvec2(pixel)) < radius ? 1 : 0;
                }
            }
        }
    }
    EXPECT_GT(behind, 20U);
}

// Returns the height of a vertex's line in a density strip, in viewport heights from the lower edge. `along` is the
// position in the strip: 0 on the axis x, 1 on y, 2 on z and 3 on w.
double lineHeight(const Picture& picture, std::size_t vertex, double along) {
    const int axis = std::min(static_cast<int>(along), 2);
    const glm::dvec4 at = picture.slices.rotatedVertices[vertex] / picture.scene.circumradius;
    const ParallelCoordinatesLayout& layout = picture.scene.coordinates;
    return layout.zero + layout.amplitude * (at[axis] + (along - axis) * (at[axis + 1] - at[axis]));
}

// Returns the vertex that is found in a density strip at the position `along` (see lineHeight()) and at this height, in
// viewport heights from the lower edge.
std::optional<std::size_t> vertexInStrip(Picture& picture, double along, double height) {
    const ParallelCoordinatesLayout& layout = picture.scene.coordinates;
    const double x = layout.left + layout.lineWidth / 2 + along * layout.lineStep;
    const auto hit = picture.at({x * 720, (1 - height) * 720, 0});
    if (!hit || hit->in != PickLocation::coordinates) return std::nullopt;
    EXPECT_EQ(hit->element.kind, ElementKind::vertex);
    return hit->element.index;
}

TEST(Pick, FindsTheVertexWithTheNearestLineInADensityStrip) {
    std::mt19937 random(9);
    Picture picture("120-cell", {}, support::randomRotation(random));
    ASSERT_TRUE(picture.scene.coordinates.isDensityStrip);
    for (std::size_t v = 0; v < 600; v += 37) {
        for (const double along : {0.0, 0.3, 1.0, 1.5, 2.9, 3.0}) {
            const double height = lineHeight(picture, v, along);
            const auto found = vertexInStrip(picture, along, height);
            ASSERT_TRUE(found) << v << " at " << along;
            EXPECT_LE(*found, v);  // a vertex with a smaller index is found if its line is at the same place
            EXPECT_NEAR(lineHeight(picture, *found, along), height, 2e-6);
        }
    }
    // At any other height, the vertex with the nearest line is found.
    for (const double height : {-0.9, -0.33, 0.0, 0.41, 0.87}) {
        const double at = picture.scene.coordinates.zero + height * picture.scene.coordinates.amplitude;
        double least = 1;
        for (std::size_t v = 0; v < 600; ++v) least = std::min(least, std::abs(lineHeight(picture, v, 1.2) - at));
        const auto found = vertexInStrip(picture, 1.2, at);
        ASSERT_EQ(found.has_value(), least <= kLineReach);
        if (!found) continue;
        EXPECT_NEAR(std::abs(lineHeight(picture, *found, 1.2) - at), least, 2e-6);
    }
}

TEST(Pick, FindsTheFirstOfTheVerticesWithTheSameCoordinateInADensityStrip) {
    Picture picture("120-cell", {}, {});
    std::size_t later = 0;
    for (std::size_t v = 0; v < 600; v += 11) {
        for (const double along : {0.0, 1.0, 3.0}) {
            const double height = lineHeight(picture, v, along);
            std::size_t first = 0;
            while (std::abs(lineHeight(picture, first, along) - height) > 1e-9) ++first;
            EXPECT_EQ(vertexInStrip(picture, along, height), first);
            later += first < v ? 1 : 0;
        }
    }
    EXPECT_GT(later, 50U);
}

TEST(Pick, FindsNoVertexBesideADensityStrip) {
    std::mt19937 random(10);
    Picture picture("120-cell", {}, support::randomRotation(random));
    const ParallelCoordinatesLayout& layout = picture.scene.coordinates;
    for (const double side : {-1.0, 1.0}) {
        EXPECT_FALSE(vertexInStrip(picture, 1.5, layout.zero + side * (layout.amplitude + 1.1 * kLineReach)));
        const double beyond = 1.5 + side * (1.5 + 1.1 * kLineReach / layout.lineStep);
        EXPECT_FALSE(vertexInStrip(picture, beyond, lineHeight(picture, 5, 1.5 + side * 1.5)));
    }
    Look hidden;
    hidden.parts.coordinates = false;
    Picture without("120-cell", hidden, {});
    EXPECT_FALSE(vertexInStrip(without, 1.5, layout.zero));
}

TEST(Pick, PrefersTheLinesThatAreDrawnOverADensityStrip) {
    std::mt19937 random(11);
    const geometry::Rotation orientation = support::randomRotation(random);
    Look look;
    Picture plain("120-cell", look, orientation);
    look.highlight = slicing::Element{ElementKind::vertex, 123};
    Picture lit("120-cell", look, orientation);
    const double height = lineHeight(lit, 123, 0.6), width = lit.scene.coordinates.lineWidth;
    for (const double above : {-0.9, 0.9}) {
        EXPECT_NE(vertexInStrip(plain, 0.6, height + above * width), 123U) << "another line is nearer";
        EXPECT_EQ(vertexInStrip(lit, 0.6, height + above * width), 123U);
    }
    for (const double above : {-1.1, 1.1}) {
        EXPECT_EQ(vertexInStrip(lit, 0.6, height + above * width), vertexInStrip(plain, 0.6, height + above * width));
    }
}

}  // namespace
}  // namespace oval4d::scene
