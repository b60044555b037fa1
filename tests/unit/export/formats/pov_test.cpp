// Tests of scenes for POV-Ray.

#include <algorithm>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "unit/export/support.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::support;
using exports::ExportContentsKind;

/// A POV-Ray file with the slices of a polytope, and the scene from which it was made.
struct PovOfPolytope {
    slicing::SliceSet slices;
    scene::Scene scene;  ///< refers to `slices`
    std::string text;

    PovOfPolytope(const char* name, const geometry::Hyperplanes& planes, const scene::Look& look) {
        const slicing::Object object = objectOf(named(name));
        slicing::CellComplexSlicer().slice(named(name), {}, planes, slices);
        scene::Composer().compose(object, {}, slices, planes.first + (planes.count - 1) / 2, look, {}, scene);
        text = bytesOf(exports::exportScene(scene, object, {}, oval(), kUnhurried));
    }
    PovOfPolytope(const PovOfPolytope&) = delete;
    PovOfPolytope& operator=(const PovOfPolytope&) = delete;

    static exports::ExportRequest oval() {
        return {.format = exports::formatNamed("pov"), .contents = ExportContentsKind::oval};
    }
};

std::size_t occurrences(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

/// Returns the vectors "<x, y, z>" that directly follow `name` in a part of a file.
std::vector<glm::dvec3> vectorsAfter(const std::string& text, const std::string& name) {
    std::vector<glm::dvec3> found;
    for (auto at = text.find(name + '<'); at != std::string::npos; at = text.find(name + '<', at + 1)) {
        std::istringstream in(text.substr(at + name.size() + 1, 100));
        char comma = 0;
        glm::dvec3& v = found.emplace_back();
        in >> v.x >> comma >> v.y >> comma >> v.z;
        EXPECT_FALSE(in.fail()) << text.substr(at, 100);
    }
    return found;
}

/// Returns the vector that follows `name` in a part of a file. Expects that there is only one.
glm::dvec3 vectorAfter(const std::string& text, const std::string& name) {
    const auto found = vectorsAfter(text, name);
    EXPECT_EQ(found.size(), 1U) << name;
    return found.empty() ? glm::dvec3(0) : found.front();
}

/// Returns the vectors in the list `name` of the first mesh in a file.
std::vector<glm::dvec3> vectorsInList(const std::string& text, const std::string& name) {
    const auto begin = text.find(name + " { ");
    if (begin == std::string::npos) return {};
    return vectorsAfter(text.substr(begin, text.find('}', begin) - begin), "\n");
}

TEST(Pov, showsEachPointWhereThePictureShowsIt) {
    scene::Look look;
    look.orbit = {.azimuth = 0.4, .elevation = -0.3, .zoom = 1.5};
    const PovOfPolytope pov("24-cell", {-2, 5, 0.4}, look);
    const scene::Camera& camera = pov.scene.camera;
    const double aspect = static_cast<double>(pov.scene.viewport.width) / pov.scene.viewport.height;
    EXPECT_NE(camera.shiftY, 0) << "the view axis is not in the middle of the picture";
    const glm::dvec3 right = vectorAfter(pov.text, "Right = "), up = vectorAfter(pov.text, "Up = "),
                     eye = vectorAfter(pov.text, "location "), direction = vectorAfter(pov.text, "direction ");
    EXPECT_NE(pov.text.find("Aspect = 1.7777"), std::string::npos);
    const auto points = vectorsAfter(pov.text, "sphere { ");
    ASSERT_EQ(points.size(), pov.slices.vertices.size());
    for (const glm::dvec3& p : points) {
        // The ray through p meets the image at (x, y), where direction + x · right · aspect + y · up = t · (p − eye).
        const glm::dvec3 seen = glm::inverse(glm::dmat3(right * aspect, up, eye - p)) * -direction;
        const glm::dvec4 clip = camera.projection(aspect) * camera.view() * glm::dvec4(p, 1);
        EXPECT_GT(seen.z, 0) << "in front of the eye";
        EXPECT_NEAR(2 * seen.x, clip.x / clip.w, 1e-9);
        EXPECT_NEAR(2 * seen.y, clip.y / clip.w, 1e-9);
    }
    const glm::dvec3 light = vectorAfter(pov.text, "light_source { ") - vectorAfter(pov.text, "point_at ");
    const glm::dvec3 inView = glm::normalize(glm::dmat3(camera.view()) * light);
    EXPECT_NEAR(glm::distance(inView, pov.scene.style().light), 0, 1e-9);
}

TEST(Pov, hasTheBallsBarsAndFacesOfTheSlices) {
    // Three slices of the tesseract are cubes. The six faces of a cube belong to six cells.
    const PovOfPolytope pov("8-cell", {-1, 3, 0.5}, {});
    const auto balls = vectorsAfter(pov.text, "sphere { ");
    ASSERT_EQ(balls.size(), 24U);
    for (std::size_t i = 0; i < balls.size(); ++i) {
        const glm::dvec3 place = pov.scene.placements[i / 8].position + pov.scene.scale * pov.slices.vertices[i];
        EXPECT_NEAR(glm::distance(balls[i], place), 0, 1e-6);
    }
    const auto bars = vectorsAfter(pov.text, "cylinder { ");
    ASSERT_EQ(bars.size(), 36U);
    for (const glm::dvec3& end : bars)
        EXPECT_TRUE(std::ranges::find(balls, end) != balls.end()) << "a bar begins in a ball";
    EXPECT_EQ(occurrences(pov.text, "\nmesh2 {"), 3U);
    EXPECT_EQ(occurrences(pov.text, "vertex_vectors { 8,"), 3U);
    EXPECT_EQ(occurrences(pov.text, "texture_list { 6,"), 3U);
    EXPECT_EQ(occurrences(pov.text, "face_indices { 12,"), 3U);
    EXPECT_EQ(occurrences(pov.text, "normal_vectors"), 0U) << "faces are flat";
    EXPECT_EQ(occurrences(pov.text, " }\ndouble_illuminate\n}\n"), 3U) << "and as bright with the light behind them";
    EXPECT_EQ(occurrences(pov.text, "finish { Matte }"), 6U) << "each texture is declared once";
    EXPECT_EQ(occurrences(pov.text, ", 0.54> } finish { Matte }"), 6U) << "the opacity on a dark ground is 0.46";
    EXPECT_EQ(occurrences(pov.text, "finish { Shiny }"), 2U) << "of balls and bars";
}

TEST(Pov, hasOnlyWhatThePictureShows) {
    scene::Look look;
    look.parts.faces = look.parts.balls = look.parts.labels = false;
    look.background = scene::Background::white;
    const PovOfPolytope bars("8-cell", {-1, 3, 0.5}, look);
    EXPECT_EQ(occurrences(bars.text, "mesh2"), 0U);
    EXPECT_EQ(occurrences(bars.text, "Label"), 0U);
    EXPECT_EQ(occurrences(bars.text, "background { rgbt <1, 1, 1, 0> }"), 1U);
    EXPECT_EQ(occurrences(bars.text, "finish { Shiny }"), 1U) << "the joints of bars have the color of bars";
    EXPECT_EQ(occurrences(bars.text, "\nsphere {"), 24U);
    look.parts.bars = false;
    look.background = scene::Background::transparent;
    const PovOfPolytope nothing("8-cell", {-1, 3, 0.5}, look);
    EXPECT_EQ(occurrences(nothing.text, "\nsphere {") + occurrences(nothing.text, "\ncylinder {"), 0U);
    EXPECT_EQ(occurrences(nothing.text, "background { rgbt <1, 1, 1, 1> }"), 1U);
}

TEST(Pov, hasTheProjectionIfThePictureShowsIt) {
    scene::Look look;
    EXPECT_EQ(occurrences(PovOfPolytope("8-cell", {-1, 3, 0.5}, look).text, "// Projection"), 0U);
    look.projection.kind = scene::ProjectionKind::perspective;
    const PovOfPolytope pov("8-cell", {-1, 3, 0.5}, look);
    const auto at = pov.text.find("// Projection");
    ASSERT_NE(at, std::string::npos);
    // The projection consists of the tesseract, and of the cube in which the focus hyperplane cuts it.
    EXPECT_EQ(vectorsAfter(pov.text.substr(at), "\nsphere { ").size(), 16U + 8);
    EXPECT_EQ(vectorsAfter(pov.text.substr(at), "\ncylinder { ").size(), 32U + 12);
}

TEST(Pov, hasTheProjectionBehindTheSlicesThatItWouldCover) {
    scene::Look look;
    look.projection.kind = scene::ProjectionKind::perspective;
    look.view = scene::View::single;
    for (const double azimuth : {0.0, 1.4}) {
        look.orbit.azimuth = azimuth;
        const PovOfPolytope pov("8-cell", {-1, 3, 0.5}, look);
        const scene::Scene& s = pov.scene;
        const auto at = pov.text.find("// Projection");
        ASSERT_NE(at, std::string::npos);
        const auto slice = vectorsAfter(pov.text.substr(0, at), "\nsphere { ");
        const auto projection = vectorsAfter(pov.text.substr(at), "\nsphere { ");
        ASSERT_FALSE(slice.empty());
        ASSERT_GE(projection.size(), 16U);
        double farthest = 0, nearest = 1e9;
        for (const glm::dvec3& p : slice) farthest = std::max(farthest, glm::distance(p, s.camera.eye));
        for (std::size_t v = 0; v < 16; ++v) {
            const glm::dvec3 world =
                s.projectionPlacement.position + s.projection.scale * s.projection.elements.vertices[v];
            const glm::dvec3 wanted = world - s.camera.eye, found = projection[v] - s.camera.eye;
            EXPECT_LT(glm::distance(glm::normalize(found), glm::normalize(wanted)), 1e-5) << "the same image";
            if (azimuth == 0) {
                EXPECT_LT(glm::distance(found, wanted), 1e-5) << "the projection is beside the slice";
            }
            nearest = std::min(nearest, glm::length(found));
        }
        if (azimuth != 0) {
            EXPECT_GT(nearest, farthest);
        }
    }
}

TEST(Pov, fillsTheStarsOfTheProjection) {
    scene::Look look;
    look.parts.faces = false;
    look.parts.projectionFaces = true;
    look.projection.kind = scene::ProjectionKind::perspective;
    const PovOfPolytope pov("small stellated 120-cell", {0, 1, 1}, look);
    const std::size_t corners = pov.scene.projection.fill.corners.size();
    // A pentagram is divided into at least three convex polygons.
    EXPECT_GT(corners, 9 * pov.scene.projection.fill.faces.size());
    EXPECT_EQ(occurrences(pov.text, "\nmesh2 {"), 1U);
    EXPECT_EQ(occurrences(pov.text, "vertex_vectors { " + std::to_string(corners) + ","), 1U);
}

TEST(Pov, letsTheLightPassTwiceThroughFadedBallsAndBars) {
    scene::Look look;
    look.cellTypes.faded = {0};
    const PovOfPolytope pov("8-cell", {0, 1, 1}, look);
    // Faded elements have the opacity 1/4. A line of sight crosses two surfaces, so each surface transmits √(3/4) of
    // the light.
    EXPECT_EQ(occurrences(pov.text, ", 0.8660254> } finish { Shiny }"), 2U);
    EXPECT_EQ(occurrences(pov.text, ", 0.885> } finish { Matte }"), 6U) << "1 − 0.46 / 4";
}

TEST(Pov, hasLabelsInTheCharactersOfItsFonts) {
    const PovOfPolytope pov("8-cell", {-1, 3, 0.5}, {});
    EXPECT_EQ(occurrences(pov.text, "\nLabel(\""), 3U);
    EXPECT_EQ(occurrences(pov.text, "\nLabel(\"-0.50\", "), 1U);
    EXPECT_EQ(occurrences(pov.text, "\nLabel(\"w = 0"), 1U);
    EXPECT_TRUE(std::ranges::all_of(pov.text, [](char c) { return static_cast<unsigned char>(c) < 0x80; }));
}

TEST(Pov, hasSmoothSurfacesOfFields) {
    const SlicedBall ball({0, 1, 0.5});
    const std::string text = bytesOf(ball.exported(PovOfPolytope::oval()));
    EXPECT_EQ(occurrences(text, "mesh2 {"), 1U) << "the ball has no caps";
    EXPECT_EQ(occurrences(text, "double_illuminate"), 0U);
    const auto points = vectorsInList(text, "vertex_vectors"), normals = vectorsInList(text, "normal_vectors");
    ASSERT_GT(points.size(), 1000U);
    ASSERT_EQ(normals.size(), points.size());
    const glm::dvec3 center = ball.scene.placements.front().position;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 fromCenter = (points[i] - center) / ball.scene.scale;
        EXPECT_NEAR(glm::length(fromCenter), 1, 0.01);
        EXPECT_GT(glm::dot(glm::normalize(fromCenter), normals[i]), 0.99);
    }
}

// A field has flat caps where its inside meets the border of the box. The field w < 0 has no level set in the slice w =
// −0.5, but fills the box.
TEST(Pov, hasFlatCapsOfFields) {
    auto read = fields::fieldFromFormula("half", "w < 0", {glm::dvec4(-1), glm::dvec4(1)});
    ASSERT_TRUE(read) << read.error().message;
    const slicing::Object object = std::make_shared<const fields::Field>(std::move(*read));
    const geometry::Hyperplanes planes{-1, 1, 0.5};
    slicing::SurfaceDetail detail;
    slicing::setUniformDetail(slicing::infoOf(object).circumradius, planes, slicing::Quality::file, detail);
    slicing::SliceSet slices;
    slicing::Slicer().slice(object, {}, planes, {}, detail, slices);
    scene::Scene scene;
    scene::Composer().compose(object, {}, slices, -1, {}, {}, scene);
    const std::string text = bytesOf(exports::exportScene(scene, object, {}, PovOfPolytope::oval(), kUnhurried));
    EXPECT_EQ(occurrences(text, "mesh2 {"), 1U);
    EXPECT_EQ(occurrences(text, "normal_vectors"), 0U);
}

TEST(Pov, tellsThatFogIsLeftOut) {
    SlicedBall ball({0, 1, 0.5});
    const auto warnings = [&] {
        return std::get<exports::ExportedFile>(ball.exported(PovOfPolytope::oval())).warnings;
    };
    EXPECT_TRUE(warnings().empty());
    ball.scene.look.field.fog = {{.value = 0}, {.value = 1, .opacity = 1}};
    EXPECT_EQ(warnings(), std::vector<std::string>{"the fog is left out"});
}

}  // namespace
