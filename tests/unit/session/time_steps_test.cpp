#include "session/time_steps.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "fields/array_field.hpp"
#include "fields/formula_field.hpp"
#include "session/load.hpp"
#include "session/object_loader.hpp"
#include "unit/session/support.hpp"

namespace oval4d::session {
namespace {

// Returns a field of an array with the samples 0, 1, 2 ….
slicing::Object arrayOf(const fields::Shape& shape, const fields::Box& box = {glm::dvec4(0), {1, 1, 1, 3}}) {
    fields::FieldArray array;
    array.shape = shape;
    array.box = box;
    std::vector<float> values(fields::sampleCount(shape));
    std::iota(values.begin(), values.end(), 0.F);
    array.samples = fields::SampleStorage(std::move(values));
    auto field = fields::fieldFromArray("run", array);
    return std::make_shared<const fields::Field>(std::move(*field));
}

TEST(Load, TimeStepsAreAddedAtTheEndOfW) {
    const slicing::Object field = arrayOf({2, 2, 2, 4});
    const auto grown = appendTimeSteps(field, arrayOf({2, 2, 2, 2}), {});
    ASSERT_TRUE(grown) << grown.error().message;
    const fields::ArrayFunction& array = *slicing::fieldIn(*grown)->array;
    EXPECT_EQ(array.shape(), (fields::Shape{2, 2, 2, 6}));
    EXPECT_EQ(array.box().max, glm::dvec4(1, 1, 1, 5));
    EXPECT_EQ(array.samples()[31], 31);
    EXPECT_EQ(array.samples()[32], 0);
    EXPECT_EQ(array.samples()[47], 15);
    const auto first = appendTimeSteps(arrayOf({2, 2, 2, 1}, {glm::dvec4(0), {1, 1, 1, 0}}), arrayOf({2, 2, 2, 1}), {});
    ASSERT_TRUE(first);
    EXPECT_EQ(slicing::fieldIn(*first)->array->box().max.w, 1);
    for (const slicing::Object& wrong : {arrayOf({2, 2, 3, 1}), slicing::Object(support::shared("24-cell"))}) {
        const auto refused = appendTimeSteps(field, wrong, {});
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().code, ErrorCode::bad_field);
    }
    EXPECT_TRUE(appendTimeSteps(field, arrayOf({2, 2, 2, 1}), {.maxFieldBytes = 160}));
    const auto large = appendTimeSteps(field, arrayOf({2, 2, 2, 1}), {.maxFieldBytes = 159});
    ASSERT_FALSE(large);
    EXPECT_EQ(large.error().code, ErrorCode::too_large);
    EXPECT_EQ(large.error().message,
              "of 2 × 2 × 2 samples, at most 4 moments are allowed (--max-field-bytes), but the field would have 5; it "
              "stays as it was");
}

TEST(Load, UnitsStayWhenTheFieldGrows) {
    fields::Field field = *slicing::fieldIn(arrayOf({2, 2, 2, 4}));
    field.units = {"m", "m", "m", "s"};
    field.quantity = {"temperature", "K"};
    const auto grown =
        appendTimeSteps(slicing::Object(std::make_shared<const fields::Field>(field)), arrayOf({2, 2, 2, 1}), {});
    ASSERT_TRUE(grown) << grown.error().message;
    EXPECT_EQ(slicing::fieldIn(*grown)->units, field.units);
    EXPECT_EQ(slicing::fieldIn(*grown)->quantity, field.quantity);
}

TEST(Load, TheHistoryGrowsWithTheField) {
    const FileReader reader = [](const LoadObject& load, const Limits& /*limits*/) -> Result<ObjectWithWarnings> {
        return ObjectWithWarnings{arrayOf({2, 2, 2, load.append ? std::size_t{1} : 4}), {}};
    };
    Session session;
    const auto execute = [&](const LoadObject& load) {
        ObjectLoader loader(Limits{}, support::cache(), ObjectLoader::LoadingMode::deferred, reader);
        Result<std::monostate> done = std::monostate{};
        EXPECT_EQ(ordersOf(session, load, loader, done), load.append ? 2 : 1);
        EXPECT_TRUE(done);
    };
    LoadObject load{"run", "npy", ""};
    execute(load);
    press(session, "r");
    line(session, "set levels=3 slices=11");
    press(session, "ru");
    const Session before = session;
    load.append = true;
    execute(load);
    EXPECT_EQ(session.revision, before.revision + 1);
    EXPECT_EQ(session.undoSteps.size(), before.undoSteps.size());
    EXPECT_EQ(session.redoSteps.size(), before.redoSteps.size());
    for (const State* state : {&session.current, &session.undoSteps.back(), &session.redoSteps.back()}) {
        EXPECT_EQ(state->object, session.loaded.at("run"));
        EXPECT_EQ(slicing::fieldIn(state->object)->array->shape()[3], 5U);
    }
    EXPECT_EQ(session.undoSteps.front().object, before.undoSteps.front().object);
    State same = session.current;
    same.source = before.current.source;
    same.object = before.current.object;
    EXPECT_EQ(same, before.current);
    EXPECT_LT(unsharedMemoryOfObjects(session), 2 * unsharedMemoryOfObjects(before));
    line(session, "set pace=2");
    line(session, "focus 1");
    execute(load);
    EXPECT_EQ(session.current.object, session.undoSteps.back().object) << "states with one image keep one image";
    EXPECT_NE(session.current.object, session.loaded.at("run"));
    line(session, "polytope 24-cell");
    const State shown = session.current;
    execute(load);
    EXPECT_EQ(session.current, shown);
    EXPECT_EQ(slicing::fieldIn(session.loaded.at("run"))->array->shape()[3], 7U);
}

// Returns the field with a second array, whose samples are the negatives of the first.
slicing::Object withSecond(const slicing::Object& object) {
    fields::Field field = *slicing::fieldIn(object);
    fields::FieldArray second;
    second.shape = field.array->shape();
    second.box = field.array->box();
    std::vector<float> samples(field.array->samples().begin(), field.array->samples().end());
    for (float& sample : samples) sample = -sample;
    second.samples = fields::SampleStorage(std::move(samples));
    EXPECT_FALSE(fields::setSecondArray(field, second, "p"));
    return std::make_shared<const fields::Field>(std::move(field));
}

TEST(Load, TheSecondFunctionGrowsWithTheField) {
    const slicing::Object colored = withSecond(arrayOf({2, 2, 2, 4}));
    const auto longer = appendTimeSteps(colored, withSecond(arrayOf({2, 2, 2, 2})), {});
    ASSERT_TRUE(longer);
    const fields::Field& field = *slicing::fieldIn(*longer);
    EXPECT_EQ(field.second->variable, "p");
    ASSERT_EQ(field.second->array->shape()[3], 6U);
    for (std::size_t i = 0; i < 48; ++i) EXPECT_EQ(field.second->array->samples()[i], -field.array->samples()[i]);
    const auto refused = appendTimeSteps(colored, arrayOf({2, 2, 2, 1}), {});
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("values_variable"), std::string::npos) << refused.error().message;
    fields::Field byFormula = *slicing::fieldIn(arrayOf({2, 2, 2, 4}));
    EXPECT_FALSE(fields::setSecondFormula(byFormula, "x + t"));
    const auto kept =
        appendTimeSteps(slicing::Object(std::make_shared<const fields::Field>(byFormula)), arrayOf({2, 2, 2, 1}), {});
    ASSERT_TRUE(kept);
    EXPECT_EQ(slicing::fieldIn(*kept)->second->formula, "x + w");
    fields::FieldArray other;
    other.shape = {2, 2, 2, 3};
    other.box = byFormula.array->box();
    other.samples = fields::SampleStorage(std::vector<float>(24));
    const auto mismatch = fields::setSecondArray(byFormula, other, "p");
    ASSERT_TRUE(mismatch);
    EXPECT_NE(mismatch->message.find("2 × 2 × 2 × 3"), std::string::npos) << mismatch->message;
}

}  // namespace
}  // namespace oval4d::session
