#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "fields/array_field.hpp"
#include "session/load.hpp"
#include "session/object_loader.hpp"
#include "session/settings.hpp"
#include "unit/session/support.hpp"

namespace oval4d::session {
namespace {

// Returns a field that is a part of an array in the data folder, with samples from `least` to `least` + 15.
slicing::Object partOfArray(float least = 0, const std::string& variable = "v") {
    fields::FieldArray array;
    array.shape = {2, 2, 2, 2};
    array.box = {glm::dvec4(0), glm::dvec4(1)};
    std::vector<float> values(16);
    std::iota(values.begin(), values.end(), least);
    array.samples = fields::SampleStorage(std::move(values));
    auto field = fields::fieldFromArray("run", array);
    field->source = std::make_shared<const fields::FieldFileSource>(
        fields::FieldFileSource{"large.zarr", "", "tzyx", variable, "x*y", "", array.box, {}});
    return std::make_shared<const fields::Field>(std::move(*field));
}

TEST(Regions, TheCommandLoadsOneOfTheArrayOfTheField) {
    Session session;
    expectRefused(session, CommandLine{"region 0,1,0,1,0,1,0,1"}, ErrorCode::out_of_range,
                  "not a part of a larger array");
    session.current.source = session.current.object = partOfArray();
    expectRefused(session, CommandLine{"region 0,1"}, ErrorCode::bad_expression, "region must be eight numbers");
    const std::optional<fields::Box> region = fields::Box{{0, 0.25, 0, 3}, {1, 0.5, 1, 3}};
    const std::vector<std::pair<std::string, std::optional<fields::Box>>> cases{{"region 0,1,1/4,1/2,0,1,3,3", region},
                                                                                {":region all", std::nullopt}};
    for (const auto& [text, expected] : cases) {
        std::vector<LoadObject> loads;
        const FileReader reader = [&](const LoadObject& load, const Limits&) -> Result<ObjectWithWarnings> {
            loads.push_back(load);
            return ObjectWithWarnings{partOfArray(), {}};
        };
        ObjectLoader loader(Limits{}, support::cache(), ObjectLoader::LoadingMode::deferred, reader);
        Result<std::monostate> done = std::monostate{};
        EXPECT_EQ(ordersOf(session, CommandLine{text}, loader, done), 1);
        ASSERT_TRUE(done) << done.error().message;
        ASSERT_EQ(loads.size(), 1U);
        EXPECT_EQ(loads[0].name, "run");
        EXPECT_EQ(loads[0].dataName, "large.zarr");
        EXPECT_EQ(loads[0].axes, "tzyx");
        EXPECT_EQ(loads[0].variable, "v");
        EXPECT_EQ(loads[0].secondFormula, "x*y");
        EXPECT_EQ(loads[0].box, (fields::Box{glm::dvec4(0), glm::dvec4(1)}));
        EXPECT_EQ(loads[0].region, expected);
        EXPECT_TRUE(session.loaded.contains("run"));
    }
}

TEST(Regions, AnotherOneKeepsTheSettingsOfTheField) {
    const std::vector<double> initial{7.5}, ofNewPart{17.5}, chosen{3, 5};
    struct Case {
        std::string settings, variable;
        std::vector<double> levels;
        bool keeps;
    };
    for (const auto& [settings, variable, levels, keeps] :
         {Case{"set inside=below fog=0:0.5,1:0", "v", ofNewPart, true},
          Case{"set levels=3,5 inside=below fog=0:0.5,1:0", "v", chosen, true},
          Case{"set levels=3,5 inside=below fog=0:0.5,1:0", "another", ofNewPart, false}}) {
        Session session;
        ObjectLoader whole(Limits{}, support::cache());
        ASSERT_TRUE(replaceObject(session.current, partOfArray(0, variable), whole));
        EXPECT_EQ(session.current.look.field.levels, initial);
        line(session, settings);
        const auto before = session.current.look.field;
        const FileReader reader = [](const LoadObject&, const Limits&) -> Result<ObjectWithWarnings> {
            return ObjectWithWarnings{partOfArray(10), {}};
        };
        ObjectLoader loader(Limits{}, support::cache(), ObjectLoader::LoadingMode::immediate, reader);
        LoadObject load{"run", "", {}};
        load.dataName = "large.zarr";
        load.axes = "tzyx";
        load.variable = "v";
        load.secondFormula = "x*y";
        load.region = fields::Box{glm::dvec4(0), glm::dvec4(1)};
        const auto done = apply(session, load, Limits{}, loader);
        ASSERT_TRUE(done) << done.error().message;
        EXPECT_EQ(session.current.look.field.levels, levels) << settings;
        EXPECT_EQ(session.current.look.field.fog == before.fog, keeps) << settings;
        EXPECT_EQ(session.current.look.field.inside == before.inside, keeps) << settings;
        line(session, "undo");
        EXPECT_EQ(session.current.look.field, before);
    }
}

}  // namespace
}  // namespace oval4d::session
