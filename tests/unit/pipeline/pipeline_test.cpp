#include "pipeline/pipeline.hpp"

#include <atomic>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pipeline/cost.hpp"
#include "scene/pick_level.hpp"
#include "slicing/projector.hpp"
#include "slicing/slice_edges.hpp"
#include "slicing/slicer.hpp"
#include "unit/polytopes/support.hpp"
#include "unit/slicing/field_support.hpp"

namespace oval4d::pipeline {
namespace {

constexpr scene::Viewport kViewport{640, 360};

scene::PictureRequest pictureOf(const slicing::Object& object) {
    scene::PictureRequest picture;
    picture.source = picture.object = object;
    picture.planes.spacing = slicing::infoOf(object).circumradius / 10;
    picture.viewport = kViewport;
    return picture;
}

// Returns the answers at points all over the picture, one after another. The points are `step` pixels apart.
std::string answersAt(Pipeline& pipeline, const scene::PictureRequest& picture, int step = 40) {
    std::string answers;
    for (int x = step / 2; x < kViewport.width; x += step) {
        for (int y = step / 2; y < kViewport.height; y += step)
            answers += pipeline.describePoint(picture, 3, {}, glm::dvec2(x, y)) + "\n";
    }
    return answers;
}

TEST(Pipeline, PointsAtTheSlicesOfEachState) {
    std::mt19937 random(4);
    Pipeline used(nullptr, nullptr);
    scene::PictureRequest picture = pictureOf(support::shared("24-cell"));
    const auto check = [&](const char* what) {
        Pipeline fresh(nullptr, nullptr);
        const std::string answers = answersAt(used, picture);
        EXPECT_EQ(answers, answersAt(fresh, picture)) << what;
        EXPECT_NE(answers.find(R"("element":"cell")"), std::string::npos) << what;
    };
    check("at first");
    picture.orientation = support::randomRotation(random);
    check("turned");
    picture.planes.spacing *= 0.7;
    check("other hyperplanes");
    picture.look.projection.kind = scene::ProjectionKind::perspective;
    check("with the projection");
    picture.source = picture.object = support::shared("16-cell");
    check("another object");
}

TEST(Pipeline, PointsAtAStateAfterOneWhoseSlicesAreTooLarge) {
    Pipeline pipeline(nullptr, nullptr, {.fillSteps = 0, .sliceEdges = 1000});
    const scene::PictureRequest small = pictureOf(support::shared("5-cell"));
    const std::string answers = answersAt(pipeline, small);
    EXPECT_THROW(answersAt(pipeline, pictureOf(support::shared("600-cell"))), slicing::TooManySliceEdges);
    EXPECT_EQ(answersAt(pipeline, small), answers);
}

TEST(Pipeline, NamesTheFocusSectionOnce) {
    std::mt19937 random(4);
    Pipeline pipeline(nullptr, nullptr), other(nullptr, nullptr);
    scene::PictureRequest picture = pictureOf(support::shared("24-cell"));
    slicing::NamedSection section = pipeline.nameFocusSection(picture);
    const slicing::SliceAndHullNames names = section.names;
    EXPECT_NE(names.slice, "");
    slicing::SliceSet slices;
    pipeline.slice(picture, slices);
    EXPECT_EQ(other.nameFocusSection(picture, &slices).names, names) << "without cutting the focus slice again";
    section.names = {"kept", "known"};  // names that the pipeline would not find
    pipeline.reuseFocusSectionNames(section);
    picture.look.orbit.zoom = 2;
    EXPECT_EQ(pipeline.nameFocusSection(picture).names, section.names);
    std::string message;
    pipeline.writeSlices(picture, slices, 1, {}, wire::Encoding::json, message);
    EXPECT_NE(message.find(R"("section":{"name":"kept","vertices":"known"})"), std::string::npos);
    const auto expectNamedAnew = [&](const char* what, auto change) {
        scene::PictureRequest changed = picture;
        change(changed);
        pipeline.reuseFocusSectionNames(section);
        EXPECT_NE(pipeline.nameFocusSection(changed).names, section.names) << what;
        EXPECT_EQ(pipeline.nameFocusSection(picture).names, names) << what;
    };
    expectNamedAnew("turned", [&](scene::PictureRequest& p) { p.orientation = support::randomRotation(random); });
    expectNamedAnew("another focus", [](scene::PictureRequest& p) { p.focus = 1; });
    expectNamedAnew("another object", [](scene::PictureRequest& p) { p.object = support::shared("16-cell"); });
}

TEST(Pipeline, LeavesOutWhatLiesBehindOtherCellsUpToTheLimit) {
    scene::PictureRequest picture = pictureOf(support::shared("small stellated 120-cell"));
    std::mt19937 random(6);
    picture.orientation = support::randomRotation(random);
    picture.look.projection.kind = scene::ProjectionKind::perspective;
    picture.look.parts.back = false;
    const slicing::Object& object = picture.object;
    const double circumradius = slicing::infoOf(object).circumradius;
    slicing::SliceSet slices, parts;
    slicing::Slicer().sliceWithoutSurfaces(object, picture.orientation, picture.planes, slices);
    for (const std::size_t steps : {std::size_t{1}, slicing::OcclusionFinder::kDefaultSteps}) {
        std::vector<std::uint32_t> cells;
        slicing::Projector().project(
            object, picture.orientation, slices,
            {.projection = {1 / (picture.look.projection.eye * circumradius)}, .culled = true, .occlusionSteps = steps},
            parts, cells);
        Pipeline pipeline(nullptr, nullptr, {.occlusionSteps = steps});
        std::string text;
        pipeline.writeSlices(picture, slices, 1, {}, wire::Encoding::json, text);
        const nlohmann::json message = nlohmann::json::parse(text);
        const auto& whole = message["projection"]["parts"][0];
        EXPECT_EQ(whole["vertices"].size(), parts.vertexCount(0));
        EXPECT_EQ(whole["edges"].size(), parts.edgeCount(0));
        Pipeline pointing(nullptr, nullptr, {.occlusionSteps = steps});
        EXPECT_EQ(answersAt(pointing, picture), answersAt(pipeline, picture));
    }
}

// Pointing at a field evaluates the function along one ray, without extracting the surfaces of the picture. Contours
// are kept for the next point.
TEST(Pipeline, PointsAtAFieldAlongOneRay) {
    std::atomic<int> evaluations = 0;
    const auto ball = [&evaluations](const glm::dvec4& p) {
        ++evaluations;
        return glm::dot(p, p) - 0.5;
    };
    const fields::Box box{glm::dvec4(-1), glm::dvec4(1)};
    scene::PictureRequest picture = pictureOf(std::make_shared<const fields::Field>(slicing::testField(ball, 4, box)));
    picture.look.parts.coordinates = true;
    picture.look.field.levels = {0};
    Pipeline pipeline(nullptr, nullptr);
    for (const scene::View view : {scene::View::oval, scene::View::matrix}) {
        picture.look.view = view;
        const std::string answers = answersAt(pipeline, picture, 10);
        EXPECT_NE(answers.find(R"("level":0,"cap":false,"place":[)"), std::string::npos);
        EXPECT_NE(answers.find(R"("value":0)"), std::string::npos);
        EXPECT_NE(answers.find(R"("element":)"), std::string::npos) << "the box is found, too";
        for (int x = 5; x < kViewport.width; x += 20) {
            evaluations = 0;
            pipeline.describePoint(picture, 3, {}, glm::dvec2(x, kViewport.height / 3.0));
            EXPECT_LT(evaluations, picture.planes.count * (scene::kRaySamples + 500));
        }
    }
    EXPECT_LT(pointDescriptionCost(picture), geometryCost(picture));
    picture.look.parts.faces = false;
    evaluations = 0;
    EXPECT_EQ(answersAt(pipeline, picture, 10).find(R"("level")"), std::string::npos);
    EXPECT_EQ(evaluations, 0) << "no surfaces are shown";
}

}  // namespace
}  // namespace oval4d::pipeline
