#include "session/field_replacement.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "fields/array_field.hpp"
#include "session/load.hpp"
#include "session/object_loader.hpp"
#include "session/settings.hpp"
#include "unit/session/support.hpp"

namespace oval4d::session {
namespace {

// Returns a resolution level of an image in the data folder. The box of the finest level is from 0 to 8 along each
// axis. Samples of a coarser level lie in the middle of samples of the finest level.
fields::Field levelOfImage(std::uint32_t level, std::uint32_t finer, float greatest) {
    const double margin = (static_cast<double>(1U << level) - 1) / 2;
    fields::FieldArray array;
    array.shape = {2, 2, 2, 2};
    array.box = {glm::dvec4(margin), glm::dvec4(8 - margin)};
    std::vector<float> values(16);
    values.back() = greatest;
    array.samples = fields::SampleStorage(std::move(values));
    array.imageLevel = {level, 4, finer};
    fields::Field field = *fields::fieldFromArray("run", array);
    field.source = std::make_shared<const fields::FieldFileSource>(
        fields::FieldFileSource{"image", "", "tzyx", "", "", "", {}, fields::Box{glm::dvec4(0), glm::dvec4(9)}});
    return field;
}

slicing::Object objectOf(const fields::Field& field) { return std::make_shared<const fields::Field>(field); }

// Loads a field, as a `load` message does.
void load(Session& session, const slicing::Object& field) {
    const FileReader reader = [&](const LoadObject&, const Limits&) -> Result<ObjectWithWarnings> {
        return ObjectWithWarnings{field, {}};
    };
    ObjectLoader loader(Limits{}, support::cache(), ObjectLoader::LoadingMode::immediate, reader);
    LoadObject command = loadCommandFor("run", *slicing::fieldIn(field)->source);
    const auto done = apply(session, command, Limits{}, loader);
    ASSERT_TRUE(done) << done.error().message;
}

TEST(FieldReplacement, TheNextLevelIsLoadedLikeTheOneThatIsShown) {
    Session session;
    EXPECT_FALSE(loadCommandForFinerLevel(session.current)) << "no field";
    load(session, objectOf(levelOfImage(2, 1, 6)));
    const auto next = loadCommandForFinerLevel(session.current);
    ASSERT_TRUE(next);
    EXPECT_EQ(next->name, "run");
    EXPECT_EQ(next->dataName, "image");
    EXPECT_EQ(next->axes, "tzyx");
    EXPECT_EQ(next->region, (fields::Box{glm::dvec4(0), glm::dvec4(9)}));
    EXPECT_EQ(next->finer, (FinerImageLevel{1, 3}));
    load(session, objectOf(levelOfImage(2, 0, 6)));
    EXPECT_FALSE(loadCommandForFinerLevel(session.current)) << "no finer level fits into memory";
    fields::Field growing = levelOfImage(2, 1, 6);
    growing.source.reset();
    session.current.source = session.current.object = objectOf(growing);
    EXPECT_FALSE(loadCommandForFinerLevel(session.current)) << "it is no longer the array in the data folder";
}

TEST(FieldReplacement, AFinerLevelKeepsSettingsAndHistory) {
    const slicing::Object coarse = objectOf(levelOfImage(2, 2, 6)), fine = objectOf(levelOfImage(1, 1, 8));
    Session session;
    line(session, "set slices=11");
    load(session, coarse);
    press(session, "r");
    line(session, "set levels=2,4 pace=2 focus=2");
    line(session, "set spacing=0.37");
    press(session, "ru");
    const Session before = session;
    replaceField(session, coarse, fine, FieldReplacementKind::finer);
    EXPECT_EQ(session.revision, before.revision + 1);
    EXPECT_EQ(session.undoSteps.size(), before.undoSteps.size());
    EXPECT_EQ(session.redoSteps.size(), before.redoSteps.size());
    EXPECT_EQ(session.loaded.at("run"), fine);
    EXPECT_EQ(session.current.source, fine);
    EXPECT_NE(session.current.object, fine) << "it has another pace";
    EXPECT_EQ(session.current.object, session.redoSteps.back().object) << "states with one image keep one image";
    State same = session.current;
    same.source = before.current.source;
    same.object = before.current.object;
    EXPECT_EQ(same, before.current);
    int replaced = 0;
    for (const State& step : session.undoSteps) replaced += step.source == fine ? 1 : 0;
    EXPECT_EQ(replaced, 3);
    while (apply(session, Undo{})) EXPECT_NE(session.current.source, coarse);
    EXPECT_EQ(slicing::infoOf(session.current.source).name, "5-cell");
}

TEST(FieldReplacement, SlicesThatSpanTheFieldSpanTheFinerOne) {
    const slicing::Object coarse = objectOf(levelOfImage(2, 2, 6)), fine = objectOf(levelOfImage(1, 1, 8));
    Session session;
    load(session, coarse);
    ASSERT_TRUE(slicesSpanObject(session.current));
    replaceField(session, coarse, fine, FieldReplacementKind::finer);
    EXPECT_NE(slicing::initialSliceExtent(fine), slicing::initialSliceExtent(coarse));
    EXPECT_TRUE(slicesSpanObject(session.current));
}

TEST(FieldReplacement, AFieldThatIsNotShownIsReplacedAmongTheLoadedOnes) {
    const slicing::Object coarse = objectOf(levelOfImage(2, 2, 6)), fine = objectOf(levelOfImage(1, 1, 8));
    Session session;
    load(session, coarse);
    line(session, "polytope 24-cell");
    const State shown = session.current;
    const std::uint64_t revision = session.revision;
    replaceField(session, coarse, fine, FieldReplacementKind::finer);
    EXPECT_EQ(session.current, shown);
    EXPECT_EQ(session.revision, revision);
    EXPECT_EQ(session.loaded.at("run"), fine);
    line(session, "undo");
    EXPECT_EQ(session.current.source, fine);
}

TEST(FieldReplacement, AnotherRegionHasInitialLevelsAfterAFinerLevel) {
    fields::Field level = levelOfImage(1, 1, 8);
    level.initialLevel = 3;  // the server sets this when it loads from the data folder
    const slicing::Object coarse = objectOf(levelOfImage(2, 2, 6)), fine = objectOf(level);
    Session session;
    load(session, coarse);
    replaceField(session, coarse, fine, FieldReplacementKind::finer);
    EXPECT_EQ(session.current.look.field.levels, std::vector<double>{3});
    load(session, objectOf(levelOfImage(0, 0, 10)));
    EXPECT_EQ(session.current.look.field.levels, std::vector<double>{5}) << "nobody has changed them";
}

TEST(FieldReplacement, AfterTheLastLevelNoneFollows) {
    const slicing::Object field = objectOf(levelOfImage(2, 2, 6)), last = withoutFinerLevels(field);
    EXPECT_EQ(slicing::fieldIn(last)->imageLevel, (fields::MultiscaleImageLevel{2, 4, 0}));
    EXPECT_EQ(slicing::fieldIn(last)->array, slicing::fieldIn(field)->array);
    EXPECT_NE(slicing::infoOf(last).serial, slicing::infoOf(field).serial);
}

}  // namespace
}  // namespace oval4d::session
