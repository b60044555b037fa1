// Tests of the bounds of stored settings. All values that the server accepts, even at the bounds, can be read from the
// store. Values beyond the bounds count as values of a later version.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fields/array_field.hpp"
#include "session/settings.hpp"
#include "store/cbor.hpp"
#include "store/object_list.hpp"
#include "unit/store/object_table.hpp"
#include "unit/store/support.hpp"

namespace oval4d::store {
namespace {

using session::Session;

// Returns the session after encoding and decoding it.
Session readAgain(const Session& session) {
    ObjectTable table;
    return decodeSession(encodeWhole(session, 1000, table.keyOf), "", table.objectOf, support::cache());
}

// Returns a field of an array.
slicing::Object fieldOf(const fields::Shape& shape, const fields::Box& box, const std::vector<float>& samples) {
    fields::FieldArray array;
    array.shape = shape;
    array.box = box;
    array.samples = fields::SampleStorage(std::vector<float>(samples));
    return std::make_shared<const fields::Field>(*fields::fieldFromArray("array", array));
}

TEST(Codec, ReadsBoxesOfAnySizeThatFieldsMayHave) {
    for (const double size : {1e16, 1e30}) {
        const fields::Box box{glm::dvec4(-size), glm::dvec4(size)};
        Session session;
        session::LoadObject load{"wide", "formula", "x+y+z+w"};
        load.box = box;
        session::must(session, load);
        EXPECT_TRUE(same(session, readAgain(session))) << size;
        const std::string record = encodeObjectRecord(fieldOf({2, 2, 2, 2}, box, std::vector<float>(16)));
        EXPECT_EQ(encodeObjectRecord(decodeObjectRecord(record)), record) << size;
    }
    EXPECT_THROW(decodeObjectRecord(
                     encodeCbor({kRecordVersion, "a", "x", nlohmann::json::parse("[[-1e31,-1,-1,-1],[1e31,1,1,1]]"),
                                 nlohmann::json::array()})),
                 UnreadableRecord);
}

TEST(Codec, ReadsFieldsWithSamplesBeyondAllLevels) {
    for (const float sample : {1e35F, -1e35F, 3e38F}) {
        Session session;
        session::ObjectLoader loader({}, support::cache());
        const fields::Box box{glm::dvec4(-1), glm::dvec4(1)};
        const auto field = fieldOf({2, 2, 2, 2}, box, std::vector<float>(16, sample));
        ASSERT_TRUE(session::replaceObject(session.current, field, loader));
        EXPECT_EQ(session.current.look.field.levels, std::vector{std::copysign(slicing::kMaxLevel, double{sample})});
        EXPECT_TRUE(same(session, readAgain(session))) << sample;
    }
}

// A session can be read after its field has got a second time step. This changes the proportions of the domain, and so
// the bounds of the settings.
TEST(Codec, ReadsSessionsWhoseFieldHasGrown) {
    struct Array {
        std::size_t samples;  // number of samples along x, y and z
        glm::dvec4 max;       // upper end of the array's box
    };
    for (const auto& [samples, max] : {Array{2, {1, 1, 1, 0}}, Array{1, {0, 0, 0, 100}}}) {
        const session::FileReader reader = [&](const session::LoadObject&, const session::Limits&) {
            const fields::Shape shape{samples, samples, samples, 1};
            const std::vector<float> values(samples * samples * samples, 1.F);
            return Result<session::ObjectWithWarnings>({fieldOf(shape, {glm::dvec4(0), max}, values), {}});
        };
        for (const bool alongW : {false, true}) {
            Session session;
            session::LoadObject load{"run", "npy", ""};
            const auto execute = [&] {
                session::ObjectLoader loader({}, support::cache(), session::ObjectLoader::LoadingMode::deferred,
                                             reader);
                Result<std::monostate> done = std::monostate{};
                session::ordersOf(session, load, loader, done);
                EXPECT_TRUE(done);
            };
            execute();
            const double radius = slicing::infoOf(session.current.object).circumradius;
            session::ChangeSettings set;
            set.spacing = 9 * radius;
            if (alongW) set.offset = -9 * radius;
            set.focusPoint = glm::dvec4(9, -9, 9, -9) * radius;
            if (slicing::infoOf(session.current.object).cellTypes.size() > 1) set.hidden = {{1}};
            session::must(session, set);
            load.append = true;
            execute();
            const session::State& state = session.current;
            const double grown = slicing::infoOf(state.object).circumradius;
            EXPECT_NE(grown, radius);
            EXPECT_LE(state.slices.spacing, session::kMaxSpacing * grown);
            EXPECT_LE(std::abs(state.slices.offset), session::kMaxOffset * grown);
            EXPECT_LE(std::abs(state.look.focusPoint.y), session::kMaxOffset * grown);
            EXPECT_TRUE(same(session, readAgain(session))) << samples;
        }
    }
}

// A session can be read after its file was replaced. The bounds of the settings and the kinds of cells are then those
// of the box in the new file.
TEST(Codec, ReadsSessionsWhoseFileHasBeenReplaced) {
    const auto fieldInFile = [](const glm::dvec4& end) -> slicing::Object {
        fields::FieldArray array;
        array.shape = {2, 2, 2, 2};
        array.box = {-end, end};
        array.samples = fields::SampleStorage(std::vector<float>(16));
        fields::Field field = *fields::fieldFromArray("run", array);
        fields::FieldFileSource source;
        source.dataName = "run.npy";
        field.source = std::make_shared<const fields::FieldFileSource>(std::move(source));
        return std::make_shared<const fields::Field>(std::move(field));
    };
    Session session;
    session::ObjectLoader loader({}, support::cache());
    ASSERT_TRUE(session::replaceObject(session.current, fieldInFile({1, 2, 3, 4}), loader));
    const geometry::ObjectInfo& info = slicing::infoOf(session.current.object);
    ASSERT_GT(info.cellTypes.size(), 1U);
    session.current.look.cellTypes.hidden = {static_cast<std::uint32_t>(info.cellTypes.size() - 1)};
    session.current.look.focusPoint.y = -info.circumradius;
    session.current.slices.offset = info.circumradius;
    ObjectTable table;
    const std::string record = encodeWhole(session, 1000, table.keyOf);
    for (const double size : {1e-4, 1.0, 1e8}) {
        SCOPED_TRACE(size);
        const slicing::Object other = fieldInFile(glm::dvec4(size));
        const auto openFile = [&](const std::string& /*key*/) { return std::optional(other); };
        const session::State state = decodeSession(record, "", openFile, support::cache()).current;
        const double radius = slicing::infoOf(other).circumradius, reach = session::kMaxOffset * radius;
        EXPECT_EQ(state.source, other);
        EXPECT_GE(state.slices.spacing, session::kMinSpacing * radius);
        EXPECT_LE(state.slices.spacing, session::kMaxSpacing * radius);
        EXPECT_LE(std::abs(state.slices.offset), reach);
        EXPECT_LE(std::abs(state.look.focusPoint.y), reach);
        for (const std::uint32_t type : state.look.cellTypes.hidden)
            EXPECT_LT(type, slicing::infoOf(other).cellTypes.size());
    }
}

TEST(Codec, ReadsTheFocusPointAtItsBoundsFarFromTheOrigin) {
    Session session;
    constexpr double kFar = 99'999'999'999'990;
    session::must(session, session::LoadObject{"far", "cloud",
                                               "99999999999990 1.001 0 0\n"
                                               "99999999999990 -1.001 0 0\n"});
    const geometry::ObjectInfo& info = slicing::infoOf(session.current.object);
    ASSERT_EQ(info.originInFile, glm::dvec4(kFar, 0, 0, 0));
    const double reach = session::kMaxOffset * info.circumradius;
    ASSERT_GT(kFar + reach - kFar, reach * (1 + 1e-6)) << "the sum is rounded up";
    session::ChangeSettings set;
    set.focusPoint = glm::dvec4(kFar + reach, 0, 0, 0);
    session::must(session, set);
    EXPECT_EQ(session.current.look.focusPoint.x, reach);
    EXPECT_TRUE(same(session, readAgain(session)));
}

// Values beyond the bounds throw NewerVersionRecord, because a later version may have wider bounds. Clients keep a
// session of a later version, but forget an unreadable session.
TEST(Codec, TakesValuesBeyondItsBoundsForThoseOfALaterVersion) {
    using session::State;
    const auto expectLater = [](auto change) {
        Session session;
        change(session.current);
        EXPECT_THROW(readAgain(session), NewerVersionRecord);
    };
    expectLater([](State& state) { state.alpha = 7; });
    expectLater([](State& state) { state.slices.count = 200'001; });
    expectLater([](State& state) { state.slices.spacing = 1e9; });
    expectLater([](State& state) { state.slices.spacing = 1e-9; });
    expectLater([](State& state) { state.slices.focus = session::kMaxFocus + 1; });
    expectLater([](State& state) { state.slices.offset = -1e9; });
    expectLater([](State& state) { state.look.focusPoint.y = 1e9; });
    expectLater([](State& state) { state.look.field.levels.assign(slicing::kMaxLevels + 1, 0.0); });
    expectLater([](State& state) {
        for (std::size_t i = 0; i <= slicing::kMaxFogControlPoints; ++i)
            state.look.field.fog.push_back({static_cast<double>(i), 0.5});
    });
    expectLater([](State& state) { state.referenceFrame.boost = glm::dvec3(0.7); });
    expectLater([](State& state) { state.look.highlight = slicing::Element{slicing::ElementKind::cell, 5}; });
    expectLater([](State& state) { state.look.cellTypes.hidden = {1'000}; });
}

// Too many vertices throw NewerVersionRecord, because a later version may have a higher limit.
TEST(Codec, TakesTooManyVerticesForThoseOfALaterVersion) {
    ObjectTable table;
    const auto list = nlohmann::json::array({nlohmann::json::array({"5-cell"})});
    const auto expectLater = [&](auto read) {
        try {
            read();
            FAIL() << "too many vertices were built";
        } catch (const NewerVersionRecord& fault) {
            EXPECT_NE(std::string(fault.what()).find("too many vertices"), std::string::npos) << fault.what();
        }
    };
    expectLater([&] { const ObjectListDecoder objects(list, table.objectOf, support::cache(), 4); });
    ObjectListDecoder objects(list, table.objectOf, support::cache(), 5);
    expectLater([&] { objects.transformedTo(objects.at(0), {.pace = 2}); });
}

TEST(Codec, ReadsALargeFieldInManyFramesOfReference) {
    constexpr std::size_t kSide = 32, kFrames = 300;
    const std::vector<float> samples(kSide * kSide * kSide * kSide, 1.F);
    const auto field = fieldOf({kSide, kSide, kSide, kSide}, {glm::dvec4(-1), glm::dvec4(1)}, samples);
    ASSERT_GT(kFrames * slicing::memoryOf(field), std::size_t{1'000'000'000}) << "the limit, if each counted in full";
    Session session;
    session::ObjectLoader loader({}, support::cache());
    ASSERT_TRUE(session::replaceObject(session.current, field, loader));
    for (std::size_t i = 1; i <= kFrames; ++i) session::line(session, "set pace=" + std::to_string(1 + 0.01 * i));
    EXPECT_EQ(readAgain(session).undoSteps.size(), session.undoSteps.size());
}

}  // namespace
}  // namespace oval4d::store
