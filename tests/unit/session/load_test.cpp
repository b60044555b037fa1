// Tests of objects that are loaded into a session. Appended time steps are tested in time_steps_test.cpp.

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "fields/field.hpp"
#include "fields/readers/field_reader.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/surface_mesh.hpp"
#include "polytopes/catalogue/catalogue.hpp"
#include "session/load.hpp"
#include "session/object_loader.hpp"
#include "text/message_text.hpp"
#include "unit/session/support.hpp"

namespace oval4d::session {
namespace {

using support::kPentachoron;

TEST(Load, ShowsThePolytopeAndKeepsIt) {
    Session session;
    press(session, "rll");
    const State before = session.current;
    must(session, LoadObject{"mine", "off", kPentachoron});
    EXPECT_EQ(infoOf(session.current).name, "mine");
    EXPECT_EQ(session.current.orientation, before.orientation);
    EXPECT_EQ(session.current.slices.focus, 0);
    EXPECT_NEAR(session.current.slices.spacing, infoOf(session.current).circumradius / 10, 1e-12);
    press(session, "u");
    EXPECT_EQ(session.current, before);
    line(session, "polytope mine");
    EXPECT_EQ(infoOf(session.current).name, "mine");
    press(session, "n");
    EXPECT_EQ(infoOf(session.current).name, polytopes::catalogue().front().name);
    press(session, "N");
    EXPECT_EQ(infoOf(session.current).name, "mine");
    expectRefused(session, CommandLine{"polytope mined"}, ErrorCode::unknown_polytope, "did you mean 'mine'?");
}

TEST(Load, RefusesWhatItCannotRead) {
    Session session;
    press(session, "r");
    expectRefused(session, LoadObject{"mine", "off", "4OFF\n5 10 10 5\nx"}, ErrorCode::bad_polytope,
                  "line 2: the file is too short");
    expectRefused(session, LoadObject{"mine", "stl", "solid"}, ErrorCode::unsupported_format,
                  "'stl' cannot be read; allowed formats: off (4OFF), points, cloud, formula, npy, ");
    expectRefused(session, LoadObject{"tesseract", "off", kPentachoron}, ErrorCode::bad_polytope,
                  "a name of the catalogue");
    expectRefused(session, LoadObject{"a\nb", "off", kPentachoron}, ErrorCode::bad_message, "printable");
    expectRefused(session, LoadObject{"mine", "off", kPentachoron}, ErrorCode::too_large, "at most 4 are allowed",
                  Limits{.maxVertices = 4});
}

TEST(Load, AcceptsEveryFormatOfFields) {
    ASSERT_FALSE(fields::fieldFormats().empty());
    for (const fields::FieldFileFormat& format : fields::fieldFormats()) {
        const std::string name(format.name);
        EXPECT_FALSE(checkLoad(LoadObject{"mine", name, "AAAA"}, {})) << name;
        EXPECT_TRUE(isArrayFormat(name)) << name;
        EXPECT_FALSE(buildsHull(name)) << name;
    }
}

TEST(Load, TheFirstWordTellsTheFormat) {
    EXPECT_EQ(detectTextFormat(kPentachoron), "off");
    EXPECT_EQ(detectTextFormat("1 0 0 0\n"), "points");
    EXPECT_EQ(detectTextFormat(""), "points");
    for (const char* keyword : {"4OFF", "4off5", "STCN4OFF", "OFF", "COFF", "4nOFF"})
        EXPECT_EQ(detectTextFormat(std::string(keyword) + " 10 10 5\n"), "off") << keyword;
    for (const char* header : {"offset x y z w", "cutoff,x,y,z,w", "Coffee, by taste", "Offline run of May"})
        EXPECT_EQ(detectTextFormat(std::string(header) + "\n0 1 2 3 4\n"), "points") << header;
    for (const std::string keyword : {"CLOUD", "cloud", "# from a simulation\nCLOUD # of two points"}) {
        const std::string text = keyword + "\n1 0 0 0\n0 1 0 0 0.25\n";
        ASSERT_EQ(detectTextFormat(text), "cloud");
        const auto read = readObject({"two points", "cloud", text}, Limits{});
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_EQ(slicing::elementCounts(read->object)[0], 2U);
    }
    const auto ordered = readObject({"two points", "cloud", "# w x y z\nCLOUD\n4 1 2 3\n-4 -1 -2 -3\n"}, Limits{});
    ASSERT_TRUE(ordered) << ordered.error().message;
    const auto& cloud = std::get<std::shared_ptr<const geometry::PointCloud>>(ordered->object);
    EXPECT_EQ(cloud->points[0], glm::dvec4(1, 2, 3, 4));
    const auto wrong = readObject({"two points", "points", "CLOUD\n1 0 0 0\n"}, Limits{});
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().code, ErrorCode::bad_polytope);
}

TEST(Load, AFileWithoutCellsIsASurface) {
    const std::string triangle = "1 0 0 0\n0 1 0 0\n0 0 1 0\n3 0 1 2\n";
    for (const char* header :
         {"4OFF\n3 1 3 0\n", "4OFF\n3 1 3\n", "4off 3 1 3\n", "4OFF\n3 1 3 # as Geomview does\n"}) {
        const std::string text = header + triangle;
        ASSERT_EQ(detectTextFormat(text), "off");
        const auto read = readObject({"triangle", "off", text}, Limits{});
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_TRUE(read->warnings.empty());
        EXPECT_TRUE(std::holds_alternative<slicing::SurfacePtr>(read->object));
        EXPECT_EQ(slicing::elementCounts(read->object), (std::array<std::size_t, 4>{3, 3, 1, 0}));
        EXPECT_EQ(slicing::infoOf(read->object).name, "triangle");
    }
    // The fourth count may be on a line of its own.
    std::string pentachoron = kPentachoron;
    pentachoron.replace(pentachoron.find("5 10 7 5"), 8, "5 10 10\n5");
    const auto solid = readObject({"p", "off", pentachoron}, Limits{});
    ASSERT_TRUE(solid) << solid.error().message;
    EXPECT_TRUE(std::holds_alternative<slicing::PolytopePtr>(solid->object));
}

TEST(Load, WarnsOfFaultsOfASurface) {
    const auto read =
        readObject({"s", "off", "4OFF\n5 1 7\n1 0 0 0\n9 9 9 9\n0 1 0 0\n0 0 1 0\n8 8 8 8\n3 0 2 3\n"}, Limits{});
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->warnings, (std::vector<std::string>{"2 vertices lie on no 2-face and were left out",
                                                        "the file states 7 edges, but its 2-faces have 3"}));
    EXPECT_EQ(slicing::infoOf(read->object).circumradius, 1);
    const auto far = readObject({"s", "off", "4OFF\n3 1 3\n1000 0 0 1\n1000 1 0 0\n1000 0 1 0\n3 0 1 2\n"}, Limits{});
    ASSERT_TRUE(far) << far.error().message;
    ASSERT_EQ(far->warnings.size(), 1U);
    EXPECT_NE(far->warnings[0].find("far from the origin"), std::string::npos) << far->warnings[0];
    EXPECT_LT(glm::distance(slicing::vertexInFile(far->object, 0), glm::dvec4(1000, 0, 0, 1)), 1e-9);
}

TEST(Load, WarnsOfABoxOfAFormulaThatIsFarFromZero) {
    LoadObject load{"far", std::string(kFormula), "y - x + w"};
    load.box = fields::Box{{1e6, -1, 0, -3e7}, {1e6 + 30, 1, 1e-6, -3e7 + 1000}};
    const auto far = readObject(load, Limits{});
    ASSERT_TRUE(far) << far.error().message;
    ASSERT_EQ(far->warnings.size(), 2U);
    EXPECT_NE(far->warnings[0].find("along x: x is rounded to multiples of 0.0625"), std::string::npos)
        << far->warnings[0];
    EXPECT_NE(far->warnings[1].find("along w: w is rounded to multiples of 2,"), std::string::npos) << far->warnings[1];
    load.box = fields::Box{{1e3, -1e9, 0, 0}, {1e3 + 1, 1e9, 1e-9, 1e30}};
    const auto exact = readObject(load, Limits{});
    ASSERT_TRUE(exact) << exact.error().message;
    EXPECT_TRUE(exact->warnings.empty());
}

TEST(Load, RefusesInvalidSurfaces) {
    Session session;
    const std::string vertices = "4OFF\n3 1 3\n1 0 0 0\n0 1 0 0\n0 0 1 0\n";
    const auto refused = [&](const std::string& text, const std::string& says) {
        expectRefused(session, LoadObject{"s", "off", text}, ErrorCode::bad_polytope, says);
    };
    refused(vertices + "3 0 1 3\n", "line 6: 2-face 0 refers to vertex 3, but the last is vertex 2");
    refused(vertices + "3 0 1 1\n", "line 6: 2-face 0 lists a vertex twice");
    refused(vertices + "2 0 1\n", "line 6: 2-face 0 has 2 vertices; 3 to 3 are allowed");
    refused(vertices + "3 0 1 2\n3 2 1 0\n", "line 7: '3' follows the last 2-face");
    refused("4OFF\n1 0 0\n1 0 0 0\n", "the file lists neither 2-faces nor cells");
    refused("4OFF\n3 1 3\n0 0 0 0\n0 0 0 0\n0 0 0 0\n3 0 1 2\n", "all vertices are at the origin");
    expectRefused(session, LoadObject{"s", "off", vertices + "3 0 1 2\n"}, ErrorCode::too_large,
                  "at most 2 are allowed", Limits{.maxVertices = 2});
}

// An exported surface is read as a surface again, with the coordinates of the original file.
TEST(Load, ReadsASurfaceBack) {
    LoadObject load{"s", "off", "4OFF\n4 2 5\n0.1 0 0 0\n0 1 0 0.3\n0 0 1 -2\n1 1 1 1\n3 0 1 2\n3 2 1 3\n"};
    load.center = {geometry::Centering::OriginChoice::object};
    const auto first = readObject(load, Limits{});
    ASSERT_TRUE(first) << first.error().message;
    const auto& surface = *std::get<slicing::SurfacePtr>(first->object);
    load.data = slicing::write4Off(first->object, surface.vertices);
    const auto again = readObject(load, Limits{});
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_TRUE(again->warnings.empty());
    const auto& copy = *std::get<slicing::SurfacePtr>(again->object);
    EXPECT_EQ(copy.faces, surface.faces);
    EXPECT_EQ(copy.edges, surface.edges);
    for (std::size_t v = 0; v < 4; ++v) {
        for (int axis = 0; axis < 4; ++axis)
            EXPECT_NEAR(slicing::vertexInFile(again->object, v)[axis], slicing::vertexInFile(first->object, v)[axis],
                        1e-12);
    }
}

TEST(Load, MayBeReadAhead) {
    Session session;
    Result<std::monostate> done = std::monostate{};
    const Command load = LoadObject{"mine", "points", "0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n.1 .1 .1 .1\n"};
    ObjectLoader reader(Limits{}, support::cache(), ObjectLoader::LoadingMode::deferred, readObject);
    EXPECT_EQ(ordersOf(session, load, reader, done), 1);
    EXPECT_TRUE(done);
    EXPECT_EQ(reader.warnings().size(), 1U);
    EXPECT_EQ(infoOf(session.current).name, "mine");
    EXPECT_EQ(slicing::elementCounts(session.current.object)[3], 5U);

    ObjectLoader refuser(Limits{}, support::cache(), ObjectLoader::LoadingMode::deferred, readObject);
    EXPECT_EQ(ordersOf(session, LoadObject{"other", "points", "1 2 3\n"}, refuser, done), 1);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::bad_polytope);
}

TEST(Load, PolytopesAreBuiltAheadOnlyWhereTheyAreNotBuiltYet) {
    Session session;
    Result<std::monostate> done = std::monostate{};
    const Command unusual = CommandLine{"polytope 17,19-duoprism"};
    ObjectLoader first(Limits{}, support::cache(), ObjectLoader::LoadingMode::deferred, readObject);
    EXPECT_EQ(ordersOf(session, unusual, first, done), 1);
    EXPECT_TRUE(done);
    EXPECT_EQ(infoOf(session.current).name, "17,19-duoprism");
    Session other;
    ObjectLoader second(Limits{}, support::cache(), ObjectLoader::LoadingMode::deferred, readObject);
    EXPECT_EQ(ordersOf(other, unusual, second, done), 0);
    EXPECT_EQ(other.current.object, session.current.object);

    ObjectLoader turner(Limits{}, support::cache(), ObjectLoader::LoadingMode::deferred, readObject);
    EXPECT_EQ(ordersOf(session, KeyPress{"y", false, false}, turner, done), 0);
    ObjectLoader walker(Limits{}, support::cache(), ObjectLoader::LoadingMode::deferred, readObject);
    EXPECT_LE(ordersOf(session, KeyPress{"N", false, false}, walker, done), 1);
    EXPECT_TRUE(done);

    // Elements of this polytope coincide, which is found only when the polytope is built.
    ObjectLoader builder(Limits{}, support::cache(), ObjectLoader::LoadingMode::deferred, readObject);
    EXPECT_EQ(ordersOf(session, CommandLine{"polytope x3o3o5/2x"}, builder, done), 1);
    EXPECT_FALSE(done);
}

TEST(Load, FilesThatWouldBeRefusedAreNotRead) {
    Session session;
    must(session, LoadObject{"a", "off", kPentachoron});
    const FileReader reader = [](const LoadObject&, const Limits&) -> Result<ObjectWithWarnings> {
        return Error{ErrorCode::internal, "the test does not read"};
    };
    ObjectLoader loader(Limits{}, support::cache(), ObjectLoader::LoadingMode::deferred, reader);
    const Limits full{.maxLoaded = 1};
    LoadObject load{"b", "off", kPentachoron};
    ComputedOutcome outcome;
    EXPECT_FALSE(needsLoading(session, load, full, loader, outcome)) << "no room";
    load.append = true;
    EXPECT_FALSE(needsLoading(session, load, full, loader, outcome)) << "no field to append to";
    load.append = false;
    load.format = "docx";
    EXPECT_FALSE(needsLoading(session, load, Limits{}, loader, outcome)) << "no such format";
    load = {"a", "off", kPentachoron};
    EXPECT_TRUE(needsLoading(session, load, full, loader, outcome)) << "it replaces the loaded object";
    EXPECT_TRUE(loader.pendingNeedsFile());
}

TEST(Load, IsLimited) {
    Session session;
    const Limits limits{.maxLoaded = 2};
    must(session, LoadObject{"a", "off", kPentachoron}, limits);
    must(session, LoadObject{"b", "off", kPentachoron}, limits);
    expectRefused(session, LoadObject{"c", "off", kPentachoron}, ErrorCode::too_many, "at most 2 loaded objects",
                  limits);
    must(session, LoadObject{"b", "off", kPentachoron}, limits);
}

TEST(Load, ASecondFunctionColorsTheSurfaces) {
    Session session;
    LoadObject load{"colored", "formula", "x^2 + y^2 < a; a=1"};
    load.secondFormula = "a*x*y";
    must(session, load);
    EXPECT_EQ(session.current.look.coloring, scene::Coloring::value);
    EXPECT_EQ(slicing::fieldIn(session.current.object)->second->formula, "a*x*y");
    line(session, "color growth");
    load.data = "x^2 + y^2 < a; a=1.5";
    must(session, load);
    EXPECT_EQ(session.current.look.coloring, scene::Coloring::growth) << "the field before was colored, too";
    line(session, "set pace=2");
    EXPECT_EQ(slicing::fieldIn(session.current.object)->second, slicing::fieldIn(session.current.source)->second);
    press(session, "uuu");
    EXPECT_EQ(session.current.look.coloring, scene::Coloring::value);
    press(session, "u");
    EXPECT_EQ(session.current.look.coloring, scene::Coloring::cell);
    line(session, "formula x - b; b=2 colored by b*y");
    EXPECT_EQ(slicing::fieldIn(session.current.object)->second->formula, "b*y");
    EXPECT_EQ(session.current.look.coloring, scene::Coloring::value);
    expectRefused(session, CommandLine{"formula x colored by y*"}, ErrorCode::bad_expression,
                  "values: 'y*', position 3");
    load = {"mine", "off", kPentachoron};
    load.secondFormula = "x";
    expectRefused(session, load, ErrorCode::bad_message, "only formulas and arrays take the formula of values");
    load = {"mine", "npy", ""};
    load.secondFormula = "x";
    load.append = true;
    const auto moments = checkLoad(load, {});
    ASSERT_TRUE(moments);
    EXPECT_NE(moments->message.find("moments have no formula of values"), std::string::npos) << moments->message;
}

// Returns the vertices of a 16-cell with the circumradius 1 and the given center, as the text of a file.
std::string crossAt(const glm::dvec4& center) {
    std::string text;
    for (int axis = 0; axis < 4; ++axis) {
        for (const double sign : {-1.0, 1.0}) {
            glm::dvec4 p = center;
            p[axis] += sign;
            for (int i = 0; i < 4; ++i) text += text::shortestDecimal(p[i]) + (i < 3 ? ' ' : '\n');
        }
    }
    return text;
}

TEST(Load, ObjectsFarFromTheOriginTurnAboutTheirCenter) {
    for (const char* format : {"points", "cloud"}) {
        for (const glm::dvec4& center : {glm::dvec4(10, 10, 0, 0), glm::dvec4(5e6, 0, 1, -5e6)}) {
            const auto far = readObject({"mine", format, crossAt(center)}, Limits{});
            ASSERT_TRUE(far) << far.error().message;
            const geometry::ObjectInfo& info = slicing::infoOf(far->object);
            EXPECT_EQ(info.originInFile, center);
            EXPECT_EQ(info.circumradius, 1);
            EXPECT_EQ(slicing::vertexInFile(far->object, 0), center - glm::dvec4(1, 0, 0, 0));
            ASSERT_EQ(far->warnings.size(), 1U);
            EXPECT_NE(far->warnings[0].find("far from the origin"), std::string::npos) << far->warnings[0];
            EXPECT_NE(far->warnings[0].find("center=origin"), std::string::npos) << far->warnings[0];
        }
        const auto near = readObject({"mine", format, crossAt({1, 1, 0, 0})}, Limits{});
        ASSERT_TRUE(near) << near.error().message;
        EXPECT_EQ(slicing::infoOf(near->object).originInFile, glm::dvec4(0));
        EXPECT_TRUE(near->warnings.empty());
    }
}

TEST(Load, ObjectsTurnAboutThePointThatIsAskedFor) {
    using OriginChoice = geometry::Centering::OriginChoice;
    const glm::dvec4 center(10, 10, 0, 0), place(1, 2, 3, 4);
    for (const auto& [wanted, origin] : {std::pair<geometry::Centering, glm::dvec4>{{OriginChoice::object}, center},
                                         {{OriginChoice::origin}, glm::dvec4(0)},
                                         {{OriginChoice::point, place}, place}}) {
        LoadObject load{"mine", "points", crossAt(center)};
        load.center = wanted;
        const auto read = readObject(load, Limits{});
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_EQ(slicing::infoOf(read->object).originInFile, origin);
        EXPECT_TRUE(read->warnings.empty());
    }
    Session session;
    LoadObject formula{"mine", std::string(kFormula), "x"};
    formula.center = {OriginChoice::origin};
    expectRefused(session, formula, ErrorCode::bad_message, "only polytopes, surfaces and points take a center");
}

// Settings are in the coordinates of the file: users set w and the focus point in them. The slices lie around the
// center of the object.
TEST(Load, SettingsAreInTheCoordinatesOfTheFile) {
    Session session;
    const glm::dvec4 center(10, -20, 5e6, 5e6);
    must(session, LoadObject{"mine", "points", crossAt(center)});
    const State first = session.current;
    EXPECT_EQ(first.focusW(), 0);
    EXPECT_NEAR(first.slices.spacing, 0.1, 1e-12);
    line(session, "set w=5000000.25");
    EXPECT_EQ(session.current.focusW(), 0.25);
    line(session, "set point=10.5,-20.5,5000000,4999999.5");
    EXPECT_EQ(session.current.look.focusPoint, glm::dvec3(0.5, -0.5, 0));
    EXPECT_EQ(session.current.focusW(), -0.5);
    expectRefused(session, CommandLine{"set w=0"}, ErrorCode::out_of_range, "w must be from 4999990 to 5000010, not 0");
    expectRefused(session, CommandLine{"set point=0,0,0,0"}, ErrorCode::out_of_range, "the point's y");
    line(session, "set offset=0.5");
    EXPECT_EQ(session.current.slices.offset, 0.5);
    press(session, "uuu");
    EXPECT_EQ(session.current, first);
    // The frame of reference moves the center, too.
    line(session, "set pace=2");
    EXPECT_EQ(infoOf(session.current).originInFile, glm::dvec4(10, -20, 5e6, 1e7));
    line(session, "polytope 24-cell");
    EXPECT_EQ(infoOf(session.current).originInFile, glm::dvec4(0));
}

TEST(Load, NamesAreTextOf64Characters) {
    const auto checked = [](const std::string& name) { return checkLoad({name, "points", ""}, {}); };
    std::string wide;
    for (int i = 0; i < 64; ++i) wide += "π";
    for (const std::string& good : {std::string("a b"), std::string(64, 'x'), wide}) EXPECT_FALSE(checked(good));
    for (const std::string& bad : {std::string(), std::string(65, 'x'), wide + "x", std::string("\xff"),
                                   std::string("a\0b", 3), std::string("\x7f")}) {
        const auto error = checked(bad);
        ASSERT_TRUE(error);
        EXPECT_EQ(error->code, ErrorCode::bad_message);
    }
}

TEST(Load, FilesHaveNamesThatLoadAccepts) {
    const std::string inCatalogue = "intersection of truncated tesseract and bitruncated 24-cell";
    ASSERT_TRUE(checkLoad({inCatalogue, "points", ""}, {}));
    std::string wide;
    for (int i = 0; i < 100; ++i) wide += "π";
    for (const std::string& file : {std::string("cube.off"), std::string("tesseract"), inCatalogue, std::string(),
                                    std::string("tab\tand\nline"), std::string(100, 'x'), wide, "x" + wide})
        EXPECT_FALSE(checkLoad({objectNameFor(file, {}), "points", ""}, {})) << file;
    EXPECT_EQ(objectNameFor("tesseract", {}), "tesseract (file)");
    EXPECT_EQ(objectNameFor(inCatalogue, {}), inCatalogue.substr(0, 57) + " (file)");
}

TEST(Load, ReadsByWhatItIsGivenAndOnlyWhatItMayRead) {
    std::string seen;
    const FileReader reader = [&](const LoadObject& load, const Limits& /*limits*/) -> Result<ObjectWithWarnings> {
        EXPECT_EQ(load.format, "points");
        seen = load.name + ": " + load.data;
        return Error{ErrorCode::too_large, "so"};
    };
    ObjectLoader loader(Limits{}, support::cache(), ObjectLoader::LoadingMode::immediate, reader);
    Session session;
    const auto done = apply(session, LoadObject{"mine", "points", "1 2 3"}, Limits{}, loader);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().message, "so");
    EXPECT_EQ(seen, "mine: 1 2 3");
    ObjectLoader other(Limits{}, support::cache(), ObjectLoader::LoadingMode::immediate, reader);
    EXPECT_FALSE(apply(session, LoadObject{"tesseract", "points", "4 5 6"}, Limits{}, other));
    EXPECT_EQ(seen, "mine: 1 2 3");
}

}  // namespace
}  // namespace oval4d::session
