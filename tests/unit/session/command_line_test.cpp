#include <cmath>
#include <numbers>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "scene/look.hpp"
#include "session/load.hpp"
#include "session/object_loader.hpp"
#include "session/query.hpp"
#include "session/setting_text.hpp"
#include "session/settings.hpp"
#include "text/choice.hpp"
#include "text/message_text.hpp"
#include "unit/session/setting_values.hpp"
#include "unit/session/support.hpp"

namespace oval4d::session {
namespace {

using std::numbers::pi;

TEST(CommandLine, DoesWhatTheMethodPageShows) {
    Session session;
    line(session, ":polytope 24-cell");
    EXPECT_EQ(infoOf(session.current).name, "24-cell");
    line(session, "set slices=31");
    EXPECT_EQ(session.current.slices.count, 31);
    line(session, ":set alpha=pi/12 faces=off  view=single");
    EXPECT_DOUBLE_EQ(session.current.alpha, pi / 12);
    EXPECT_FALSE(session.current.look.parts.faces);
    EXPECT_EQ(session.current.look.view, scene::View::single);
    line(session, "rotate xw,yz pi/8 pi/sqrt(3)-pi/8");
    EXPECT_EQ(session.current.lastTurn,
              (geometry::RotationAngles{geometry::Plane::xw, pi / 8, pi / std::sqrt(3) - pi / 8}));
    line(session, " : rotate zw 0.1");
    EXPECT_EQ(session.current.lastTurn, (geometry::RotationAngles{geometry::Plane::zw, 0.1, {}}));
    line(session, "rotate xw,yz");
    EXPECT_EQ(session.current.lastTurn, (geometry::RotationAngles{geometry::Plane::xw, pi / 12, session.current.beta}))
        << "by the keys' angles";
    line(session, "view oval");
    EXPECT_EQ(session.current.look.view, scene::View::oval);
    for (const char* row : {"view row", "set view=row", "view strip"}) {
        line(session, "view oval");
        line(session, row);
        EXPECT_EQ(session.current.look.view, scene::View::strip) << row;
    }
    line(session, "focus 3");
    EXPECT_EQ(session.current.slices.focus, 3);
    line(session, "undo");
    EXPECT_EQ(session.current.slices.focus, 0);
    line(session, "redo");
    EXPECT_EQ(session.current.slices.focus, 3);
    line(session, "reset");
    EXPECT_EQ(session.current.orientation, geometry::Rotation{});
    line(session, "key y");
    EXPECT_EQ(session.current.lastTurn->planes(), (std::vector{geometry::Plane::xy, geometry::Plane::zw}));
    line(session, "key space");
    EXPECT_TRUE(session.current.turning);
    line(session, "key u");
    line(session, "key Ctrl-r");
    EXPECT_TRUE(session.current.turning);
    line(session, "set polytope=hyper cube");
    EXPECT_EQ(infoOf(session.current).name, "8-cell") << "blanks in names do not matter";
}

TEST(CommandLine, EverySettingCanBeSet) {
    std::set<std::string> tested;
    for (const SettingValue& setting : settingValues()) {
        SCOPED_TRACE(setting.name);
        EXPECT_TRUE(setting.isIn(sessionWith(setting).current));
        tested.insert(setting.name);
    }
    std::set<std::string> settings;
    std::istringstream names(settingNames());
    for (std::string name; std::getline(names >> std::ws, name, ',');) settings.insert(name);
    EXPECT_EQ(tested, settings);
}

TEST(Query, KeepsEverySetting) {
    for (const SettingValue& setting : settingValues()) {
        if (setting.name == "turning" || setting.name == "playing") continue;  // an address does not contain motion
        SCOPED_TRACE(setting.name);
        Session session;
        line(session, setting.object);
        line(session, "rotate xw,yz 0.3 -1.2");
        line(session, "rotate xy 2");
        line(session, "set " + setting.name + "=" + setting.value);
        ObjectLoader loader(Limits{}, support::cache());
        const auto query = queryFromState(session.current, loader);
        ASSERT_TRUE(query) << query.error().message;
        const auto read = parseQuery(queryText(*query));
        ASSERT_EQ(read, *query) << queryText(*query);
        const auto back = stateFromQuery(*read);
        ASSERT_TRUE(back) << queryText(*query) << back.error().message;
        EXPECT_TRUE(setting.isIn(*back)) << queryText(*query);
        EXPECT_EQ(settingTexts(settingsOf(*back)), settingTexts(settingsOf(session.current)));
        EXPECT_LT((back->orientation * session.current.orientation.inverse()).largerAngle(), 1e-7);
    }
}

TEST(Query, ContainsOnlyWhatDiffersFromANewObject) {
    Session session;
    line(session, "polytope two warm spots");
    line(session, "set fog=0:0.25:ff8800,1:0 slices=11");
    ObjectLoader loader(Limits{}, support::cache());
    const auto query = queryFromState(session.current, loader);
    ASSERT_TRUE(query);
    const std::string spacing = text::shortestDecimal(session.current.slices.spacing);
    EXPECT_EQ(queryText(*query), "polytope=two%20warm%20spots&slices=11&spacing=" + spacing + "&fog=0:0.25:ff8800,1:0");
}

TEST(Query, IgnoresBlanksAroundValues) {
    const auto shown = stateFromQuery({{"rotate", "xw, yz: 30\u00a0°, 0.2 rad"},
                                       {"view", "single "},
                                       {"highlight", "cell: 3"},
                                       {"hidden", " none "}});
    ASSERT_TRUE(shown) << shown.error().message;
    EXPECT_EQ(shown->look.view, scene::View::single);
    EXPECT_EQ(shown->look.highlight, (slicing::Element{slicing::ElementKind::cell, 3}));
    EXPECT_EQ(shown->orientation.matrix(), stateFromQuery({{"rotate", "xw,yz:30°,0.2"}})->orientation.matrix());
}

TEST(Query, SuggestsTheNamesOfItsContext) {
    const auto refused = [](const char* name, std::span<const std::string_view> others) {
        ObjectLoader loader(Limits{}, support::cache());
        return session::stateFromQuery({{name, "1"}}, {}, loader, initialState(), others).error().message;
    };
    const auto says = [&](const char* name, std::span<const std::string_view> others, std::string_view text) {
        const std::string message = refused(name, others);
        EXPECT_NE(message.find(text), std::string::npos) << message;
    };
    says("rotat", {}, "did you mean 'rotate'?");
    says("Rotate", {}, "did you mean 'rotate'?");
    says("formulla", kFileParameters, "did you mean 'formula'?");
    says("widht", kPictureParameters, "did you mean 'width'?");
    says("lable", kFileParameters, "did you mean 'label'?");
    says("height", kFileParameters, "height is a parameter of pictures");
    says("fit", kPictureParameters, "fit is a parameter of files");
    says("zzz", kFileParameters, "values, box, of, body, size, label, at, fit");
}

TEST(Query, CannotContainAnObjectFromAFile) {
    Session session;
    must(session, LoadObject{"mine", "points", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n0 0 0 0\n"});
    ObjectLoader loader(Limits{}, support::cache());
    const auto query = queryFromState(session.current, loader);
    ASSERT_FALSE(query);
    EXPECT_EQ(query.error().code, ErrorCode::unknown_polytope);
    EXPECT_NE(query.error().message.find("'mine'"), std::string::npos) << query.error().message;
}

TEST(Query, OpensInASessionAsOneStep) {
    Session session;
    line(session, "set slices=11");
    must(session, ShowLinkedView{"token=x&polytope=24-cell&rotate=xw:0.1+pi/8&width=7"});
    EXPECT_EQ(infoOf(session.current).name, "24-cell");
    EXPECT_EQ(session.current.slices.count, 11) << "what the query does not contain stays";
    EXPECT_EQ(session.revision, 2);
    must(session, ShowLinkedView{"polytope=24-cell&rotate=xw:0.1+pi/8"});
    EXPECT_EQ(session.revision, 2) << "the view is shown already: an address does not turn further";
    must(session, ShowLinkedView{"formula=x^2%2By^2<w&values=x"});
    EXPECT_TRUE(session.loaded.contains("formula")) << "it can be shown again by its name";
    line(session, "undo");
    line(session, "undo");
    EXPECT_EQ(infoOf(session.current).name, "5-cell");
    must(session, ShowLinkedView{"rotate=xw:1"});
    must(session, ShowLinkedView{"field=two+warm+spots"});
    EXPECT_EQ(infoOf(session.current).name, "two warm spots");
    EXPECT_EQ(session.current.orientation.matrix(), initialState().orientation.matrix())
        << "an object of an address is not turned";
    expectRefused(session, ShowLinkedView{"slices=12"}, ErrorCode::out_of_range, "odd");
    expectRefused(session, ShowLinkedView{"slices=%1"}, ErrorCode::bad_expression, "hexadecimal");
    expectRefused(session, ShowLinkedView{"sices=11"}, ErrorCode::unknown_command, "did you mean 'slices'?");
}

TEST(CommandLine, SettingsOfOneLineAreCombined) {
    Session session;
    press(session, "2");
    line(session,
         "set polytope=16-cell alpha=0.1 beta=-0.2 step=0.01 slices=11 spacing=0.2 focus=-2 view=single turning=on "
         "faces=off "
         "bars=off balls=off coordinates=off azimuth=0.3 elevation=-0.1 zoom=2 color=w hidden=0 faded=none "
         "highlight=vertex:3 point=0.1,1/4,-pi/10,0.5");
    const State& now = session.current;
    EXPECT_EQ(infoOf(now).name, "16-cell");
    EXPECT_EQ(now.alpha, 0.1);
    EXPECT_EQ(now.beta, -0.2);
    EXPECT_EQ(now.step, 0.01);
    EXPECT_EQ(now.slices, (HyperplaneSettings{11, 0.2, -2})) << "the focus counts more than w of the point";
    EXPECT_TRUE(now.turning);
    EXPECT_EQ(now.look, (scene::Look{scene::View::single,
                                     {false, false, false, false},
                                     {0.3, -0.1, 2},
                                     scene::Coloring::w,
                                     {{0}, {}},
                                     {},
                                     slicing::Element{slicing::ElementKind::vertex, 3},
                                     {0.1, 0.25, -std::numbers::pi / 10}}));
}

TEST(CommandLine, FogIsATransferFunctionOrOff) {
    Session session;
    const ErrorCode expression = ErrorCode::bad_expression, range = ErrorCode::out_of_range;
    const auto refused = [&](const char* text, ErrorCode code, const char* says) {
        SCOPED_TRACE(text);
        expectRefused(session, CommandLine{text}, code, says);
    };
    refused("fog 0:1,1:0", range, "not a field");
    line(session, "formula x^2+y^2 < w");
    const auto fog = [&] { return session.current.look.field.fog; };
    EXPECT_TRUE(fog().empty());
    line(session, "fog -1/2:0.5,0:1:ff8000,pi:0");
    EXPECT_EQ(fog(), (std::vector<slicing::FogControlPoint>{{-0.5, 0.5}, {0, 1, 0xff8000}, {pi, 0}}));
    line(session, "set fog=0:0,8:1:00000A levels=1");
    EXPECT_EQ(fog(), (std::vector<slicing::FogControlPoint>{{0, 0}, {8, 1, 10}}));
    for (const char* text : {"fog", "fog 1", "fog on", "fog 0:0,1", "fog 0:1:red,1:0", "fog 0:1:fff,1:0",
                             "fog 0:1:-fffff,1:0", "fog 0:1:1234567,1:0", "fog 0:1:ff8000:0,1:0", "fog 0:1,"})
        refused(text, expression, "value:opacity");
    refused("fog x:1,2:0", expression, "fog: 'x'");
    refused("fog 0:,1:0", expression, "a number is expected");
    for (const char* text : {"fog 0:1", "fog 0:1,0:0", "fog 1:0,0:1", "fog 0:1.1,1:0", "fog 0:-0.1,1:0",
                             "fog 0:0,1e31:1", "fog 0:0,1:0,2:0,3:0,4:0,5:0,6:0,7:0,8:0"})
        refused(text, range, "2 to 8 points in the order of their values");
    EXPECT_EQ(fog().size(), 2U);
    line(session, "fog off");
    EXPECT_TRUE(fog().empty());
    line(session, "undo");
    EXPECT_EQ(fog().size(), 2U);
    line(session, "formula x^2 < w");
    EXPECT_TRUE(fog().empty()) << "another field has its own values";
}

TEST(CommandLine, ActsOnTheHighlightedElement) {
    Session session;
    line(session, "polytope cuboctahedral prism");
    line(session, "highlight cell 5");
    const std::uint32_t type = slicing::typesOfCells(session.current.object)[5];
    line(session, "hide");
    EXPECT_EQ(session.current.look.cellTypes.hidden, std::vector{type});
    line(session, "fade");
    EXPECT_EQ(session.current.look.cellTypes.faded, std::vector{type});
    line(session, "show");
    EXPECT_TRUE(session.current.look.cellTypes.faded.empty());
    press(session, "zc");
    ASSERT_TRUE(session.current.ongoingTurnToward);
    const glm::dvec4 direction =
        slicing::elementDirectionOf(session.current.object, {slicing::ElementKind::cell, 5}, {0, 0, 0, 1});
    EXPECT_GT(glm::normalize(session.current.ongoingTurnToward->goal(direction)).w, 1 - 1e-9);
    line(session, "highlight cell: 4");
    EXPECT_EQ(session.current.look.highlight, (slicing::Element{slicing::ElementKind::cell, 4}));
    line(session, "highlight none");
    expectRefused(session, CommandLine{"hide"}, ErrorCode::bad_expression, "kind");
}

TEST(CommandLine, IgnoresBlanksWithinValues) {
    const auto turned = [](const std::string& text) {
        Session session;
        line(session, text);
        return session.current.orientation.matrix();
    };
    const glm::dmat4 expected = turned("rotate xw 30°");
    for (const char* text : {"rotate xw 30 °", "rotate xw 30\u00a0°", "rotate\u00a0xw 30 deg"})
        EXPECT_EQ(turned(text), expected) << text;
    EXPECT_EQ(turned("rotate xw, yz 30 ° 0.2 rad"), turned("rotate xw,yz 30° 0.2"));
    Session session;
    line(session, "set azimuth=30 ° highlight=cell: 3  view= single");
    EXPECT_DOUBLE_EQ(session.current.look.orbit.azimuth, std::numbers::pi / 6);
    EXPECT_EQ(session.current.look.highlight, (slicing::Element{slicing::ElementKind::cell, 3}));
    EXPECT_EQ(session.current.look.view, scene::View::single);
}

TEST(CommandLine, MistakesAreExplainedAndChangeNothing) {
    Session session;
    press(session, "r");
    const auto refused = [&](const char* text, ErrorCode code, const char* says) {
        SCOPED_TRACE(text);
        expectRefused(session, CommandLine{text}, code, says);
    };
    refused("", ErrorCode::unknown_command, "polytope, set, rotate");
    refused(":", ErrorCode::unknown_command, "polytope, set, rotate");
    refused("rotat xw 1", ErrorCode::unknown_command, "did you mean 'rotate'?");
    refused("quit", ErrorCode::unknown_command, "no command is called 'quit'");
    refused("polytope", ErrorCode::unknown_polytope, "needs a name");
    refused("polytope 25-cell", ErrorCode::unknown_polytope,
            "no polytope is called '25-cell'; did you mean '24-cell'?");
    refused("polytope tesserakt", ErrorCode::unknown_polytope, "did you mean 'tesseract'?");
    refused("polytope dual of tesserakt", ErrorCode::unknown_polytope,
            "'tesserakt' is not the name of a polytope; did you mean 'tesseract'?");
    refused("polytope rectification of 1001,3-duoprism", ErrorCode::too_large, "at most 1000 are allowed");
    refused("polytope truncation of great 120-cell", ErrorCode::unknown_polytope, "the great 120-cell is not convex");
    expectRefused(session, CommandLine{"polytope q"}, ErrorCode::unknown_polytope, "no polytope is called 'q'");
    const auto longName = apply(session, CommandLine{"polytope " + std::string(300, 'q')}, Limits{});
    ASSERT_FALSE(longName);
    EXPECT_EQ(longName.error().message.find("did you mean"), std::string::npos) << longName.error().message;
    refused("set", ErrorCode::unknown_command, "the names are polytope, pace");
    refused("set slcies=3", ErrorCode::unknown_command, "did you mean 'slices'?");
    refused("set slices 31", ErrorCode::bad_expression, "has no '='");
    refused("set slices=30", ErrorCode::out_of_range, "must be odd and from 1 to 201, not 30");
    refused("set slices=203", ErrorCode::out_of_range, "from 1 to 201");
    refused("set slices=-1", ErrorCode::out_of_range, "from 1 to 201");
    refused("set slices=2.5", ErrorCode::out_of_range, "whole number");
    refused("set slices=1e12", ErrorCode::out_of_range, "whole number");
    refused("set spacing=0", ErrorCode::out_of_range, "the spacing must be from");
    refused("set spacing=-1", ErrorCode::out_of_range, "the spacing must be from");
    refused("set alpha=7", ErrorCode::out_of_range, "did you mean 7°?");
    refused("set alpha=2.1*pi", ErrorCode::out_of_range,
            "alpha must be from −6.28319 to 6.28319 radians (−360° to 360°), not 6.59734 radians (378°)");
    refused("set alpha=", ErrorCode::bad_expression, "a number is expected");
    refused("set alpha=pi/", ErrorCode::bad_expression, "alpha: 'pi/', position 4");
    refused("set step=0", ErrorCode::out_of_range, "the step must be from");
    refused("set zoom=0", ErrorCode::out_of_range, "zoom must be from");
    refused("set faces=maybe", ErrorCode::bad_expression, "faces must be on or off, not 'maybe'");
    const std::string views = text::joinedWithOr(text::namesOf(scene::kViews));
    refused("set view=oblong", ErrorCode::bad_expression, ("view must be " + views).c_str());
    refused("view", ErrorCode::bad_expression, views.c_str());
    refused("set point=0,0,0", ErrorCode::bad_expression, "four numbers");
    refused("set point=0,0,0,0,0", ErrorCode::bad_expression, "four numbers");
    refused("set point=", ErrorCode::bad_expression, "four numbers");
    refused("set point=0,,0,0", ErrorCode::bad_expression, "a number is expected");
    refused("set point=0,0,0,", ErrorCode::bad_expression, "a number is expected");
    refused("set point=0,1e9,0,0", ErrorCode::out_of_range, "the point's y must be from");
    refused("set alpha=0.1 beta=99", ErrorCode::out_of_range, "did you mean 99°?");
    refused("focus 1e8", ErrorCode::out_of_range, "the focus must be from −1000000 to 1000000, not 100000000");
    refused("focus -1e8", ErrorCode::out_of_range, "to 1000000, not −100000000");
    refused("set slices=-3", ErrorCode::out_of_range, "not −3");
    refused("rotate xw −30", ErrorCode::out_of_range, "did you mean −30°?");
    refused("set azimuth=−30", ErrorCode::out_of_range, "did you mean −30°?");
    refused("rotate", ErrorCode::bad_expression, "needs planes and angles");
    refused("rotate xw 1 2", ErrorCode::bad_expression, "one plane needs one angle, not 2; write xw pi/8 or");
    refused("rotate xw,xw 1 2", ErrorCode::bad_expression, "the plane xw is named twice");
    refused("rotate xw, 1", ErrorCode::bad_expression, "no plane is called '1'");
    refused("rotate xw, ", ErrorCode::bad_expression, "no plane is called ''");
    refused("rotate xw,yw,zw", ErrorCode::bad_expression, "3 planes need 3 angles, not 2");
    refused("rotate xw 1e7rad", ErrorCode::out_of_range, "an angle must be from");
    refused("key", ErrorCode::unknown_key, "needs one key");
    refused("key q", ErrorCode::unknown_key, "'q' has no meaning");
    refused("reset all", ErrorCode::bad_expression, "takes no arguments");
}

TEST(Query, DescribesAState) {
    const auto state = stateFromQuery({{"spacing", "0.05"},
                                       {"rotate", "xw,yz:pi/8,0.2"},
                                       {"slices", "11"},
                                       {"polytope", "tesseract"},
                                       {"rotate", "xy:1"},
                                       {"view", "single"},
                                       {"coordinates", "off"}},
                                      {});
    ASSERT_TRUE(state) << state.error().message;
    Session session;
    line(session, "polytope 8-cell");
    line(session, "rotate xw,yz pi/8 0.2");
    line(session, "rotate xy 1");
    line(session, "set slices=11 spacing=0.05 view=single coordinates=off");
    expectNear(*state, session.current, 1e-15);
    EXPECT_EQ(state->slices.spacing, 0.05) << "whatever the order";
    const auto nothing = stateFromQuery({}, {});
    ASSERT_TRUE(nothing);
    EXPECT_EQ(*nothing, initialState());
}

TEST(Query, MistakesAreExplained) {
    const auto refused = [](const QueryParameters& query, ErrorCode code, const char* says) {
        const auto state = stateFromQuery(query, {});
        ASSERT_FALSE(state);
        EXPECT_EQ(state.error().code, code);
        EXPECT_NE(state.error().message.find(says), std::string::npos) << state.error().message;
    };
    refused({{"polytop", "5-cell"}}, ErrorCode::unknown_command, "did you mean 'polytope'?");
    refused({{"polytop", "5-cell"}}, ErrorCode::unknown_command, ", rotate");
    refused({{"rotate", "xw"}}, ErrorCode::bad_expression, "write xw:pi/8");
    refused({{"rotate", "xw:1e9rad"}}, ErrorCode::out_of_range, "an angle must be from");
    refused({{"polytope", "6-cell"}}, ErrorCode::unknown_polytope, "did you mean");
    refused({{"field", "tigr"}}, ErrorCode::unknown_polytope, "did you mean 'tiger'?");
    refused({{"field", "tiger"}, {"formula", "x"}}, ErrorCode::bad_expression, "at the same time");
    refused({{"slices", "4"}}, ErrorCode::out_of_range, "odd");
}

}  // namespace
}  // namespace oval4d::session
