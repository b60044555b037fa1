#include "pipeline/pipeline.hpp"

#include <atomic>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "pipeline/cost.hpp"
#include "scene/pick_level.hpp"
#include "session/session.hpp"
#include "slicing/slice_edges.hpp"
#include "unit/polytopes/support.hpp"
#include "unit/slicing/field_support.hpp"

namespace oval4d::pipeline {
namespace {

constexpr scene::Viewport kViewport{640, 360};

session::State stateWith(const slicing::Object& object) {
    session::State state = session::initialState();
    state.source = state.object = object;
    state.slices.spacing = slicing::infoOf(object).circumradius / 10;
    return state;
}

// Returns the answers at points all over the picture, `step` pixels apart, one after another.
std::string answersAt(Pipeline& pipeline, const session::State& state, int step = 40) {
    std::string answers;
    for (int x = step / 2; x < kViewport.width; x += step) {
        for (int y = step / 2; y < kViewport.height; y += step)
            answers += pipeline.describePoint(state, 3, {}, kViewport, glm::dvec2(x, y)) + "\n";
    }
    return answers;
}

TEST(Pipeline, PointsAtTheSlicesOfEachState) {
    std::mt19937 random(4);
    Pipeline used(nullptr, nullptr);
    session::State state = stateWith(support::shared("24-cell"));
    const auto check = [&](const char* what) {
        Pipeline fresh(nullptr, nullptr);
        const std::string answers = answersAt(used, state);
        EXPECT_EQ(answers, answersAt(fresh, state)) << what;
        EXPECT_NE(answers.find(R"("element":"cell")"), std::string::npos) << what;
    };
    check("at first");
    state.orientation = support::randomRotation(random);
    check("turned");
    state.slices.spacing *= 0.7;
    check("other hyperplanes");
    state.look.projection.kind = scene::ProjectionKind::perspective;
    check("with the projection");
    state.source = state.object = support::shared("16-cell");
    check("another object");
}

TEST(Pipeline, PointsAtAStateAfterOneWhoseSlicesAreTooLarge) {
    Pipeline pipeline(nullptr, nullptr, {.fillSteps = 0, .sliceEdges = 1000});
    const session::State small = stateWith(support::shared("5-cell"));
    const std::string answers = answersAt(pipeline, small);
    EXPECT_THROW(answersAt(pipeline, stateWith(support::shared("600-cell"))), slicing::TooManySliceEdges);
    EXPECT_EQ(answersAt(pipeline, small), answers);
}

// A point of a field is found on one ray, without the surfaces of the picture, and contours are kept for the next
// point.
TEST(Pipeline, PointsAtAFieldAlongOneRay) {
    std::atomic<int> evaluations = 0;
    const auto ball = [&evaluations](const glm::dvec4& p) {
        ++evaluations;
        return glm::dot(p, p) - 0.5;
    };
    const fields::Box box{glm::dvec4(-1), glm::dvec4(1)};
    session::State state = stateWith(std::make_shared<const fields::Field>(slicing::testField(ball, 4, box)));
    state.look.parts.coordinates = true;
    state.look.field.levels = {0};
    Pipeline pipeline(nullptr, nullptr);
    for (const scene::View view : {scene::View::oval, scene::View::matrix}) {
        state.look.view = view;
        const std::string answers = answersAt(pipeline, state, 10);
        EXPECT_NE(answers.find(R"("level":0,"cap":false,"place":[)"), std::string::npos);
        EXPECT_NE(answers.find(R"("value":0)"), std::string::npos);
        EXPECT_NE(answers.find(R"("element":)"), std::string::npos) << "the box is found, too";
        for (int x = 5; x < kViewport.width; x += 20) {
            evaluations = 0;
            pipeline.describePoint(state, 3, {}, kViewport, glm::dvec2(x, kViewport.height / 3.0));
            EXPECT_LT(evaluations, state.slices.count * (scene::kRaySamples + 500));
        }
    }
    EXPECT_LT(pointCost(state), geometryCost(state, slicing::Quality::full));
    state.look.parts.faces = false;
    evaluations = 0;
    EXPECT_EQ(answersAt(pipeline, state, 10).find(R"("level")"), std::string::npos);
    EXPECT_EQ(evaluations, 0) << "no surfaces are shown";
}

}  // namespace
}  // namespace oval4d::pipeline
