#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "polytopes/catalogue/catalogue.hpp"
#include "protocol_data/embedded_files.hpp"
#include "session/example_fields.hpp"
#include "session/key_actions.hpp"
#include "session/keymap.hpp"
#include "session/setting_table.hpp"
#include "text/choice.hpp"
#include "unit/session/support.hpp"

namespace oval4d::session {
namespace {

using std::numbers::pi;

const std::vector<nlohmann::json>& rows() {
    static const auto table =
        nlohmann::json::parse(protocol_data::embeddedFile("keymap.json")).at("keys").get<std::vector<nlohmann::json>>();
    return table;
}

std::vector<KeyPress> strokesOf(const nlohmann::json& row) {
    const std::string keys = row.at("key");
    if (keys.size() != 2) return {{keys, false, row.value("ctrl", false)}};
    std::vector<KeyPress> strokes;
    for (const char c : keys) strokes.push_back({std::string(1, c), false, row.value("ctrl", false)});
    return strokes;
}

// Returns a session with a history and changed settings, in which every key has an effect.
Session busy() {
    Session session;
    line(session, "polytope 24-cell");
    press(session, "r5kKll");
    press(session, "2u");
    return session;
}

TEST(Keys, EveryRowOfTheTableHasAMeaning) {
    for (const auto& row : rows()) {
        SCOPED_TRACE(row.dump());
        Session session = busy();
        const std::uint64_t before = session.revision;
        bool refused = false;
        for (const KeyPress& key : strokesOf(row)) {
            const auto done = apply(session, key, {});
            refused = refused || !done;
            if (!done) {
                EXPECT_EQ(done.error().code, ErrorCode::unknown_key);
                EXPECT_NE(done.error().message.find("handled by the client"), std::string::npos);
            }
        }
        EXPECT_EQ(refused, row.value("client", false));
        EXPECT_EQ(session.revision, before + (refused ? 0 : 1)) << "the key changed nothing";
        if (row.contains("shift")) {
            KeyPress key = strokesOf(row).front();
            key.shift = true;
            EXPECT_TRUE(apply(session, key, {}));
        }
    }
}

TEST(Keys, EveryActionOfTheTableIsCarriedOutOrTheClients) {
    std::set<std::string_view> names;
    for (const KeyAction& action : keyActions()) {
        EXPECT_TRUE(names.insert(action.name).second) << action.name;
        EXPECT_NE(action.onState == nullptr, action.onSession == nullptr) << action.name;
    }
    for (const auto& part : scene::kParts) EXPECT_TRUE(names.contains(part.name)) << part.name;
    std::set<std::string_view> unused = names;
    for (const auto& row : rows()) {
        const std::string action = row.at("action");
        EXPECT_EQ(names.contains(action), !row.value("client", false)) << action;
        unused.erase(action);
    }
    // An action that the table of settings defines for a setting itself needs no key.
    forEachSetting([&](const auto& setting) { unused.erase(setting.name.text); });
    EXPECT_TRUE(unused.empty()) << "no key has the action " << *unused.begin();
}

TEST(Keys, ActionsOfEnumerationsShowEachValueInTurn) {
    ObjectLoader loader({}, support::cache());
    const auto valuesShownBy = [&](const std::string& name, auto valueOf) {
        const auto action = std::ranges::find(keyActions(), name, &KeyAction::name);
        State state = initialState();
        const LoadedObjects loaded;
        const Limits limits;
        ActionContext context{state, loaded, limits, loader, geometry::Plane::xy, false, false};
        const auto first = valueOf(state);
        std::size_t values = 0;
        do {
            EXPECT_TRUE(action->onState(context));
            ++values;
        } while (valueOf(state) != first && values < 100);
        return values;
    };
    EXPECT_EQ(valuesShownBy("color", [](const State& state) { return state.look.coloring; }), 7U);
    EXPECT_EQ(valuesShownBy("background", [](const State& state) { return state.look.background; }), 5U);
    EXPECT_EQ(valuesShownBy("projection", [](const State& state) { return state.look.projection.kind; }), 3U);
}

TEST(Keys, TheRowsOfTheTableAgree) {
    const auto groups = nlohmann::json::parse(protocol_data::embeddedFile("keymap.json")).at("groups");
    std::set<std::string> names, keys;
    for (const auto& row : rows()) {
        SCOPED_TRACE(row.dump());
        EXPECT_TRUE(names.insert(row.at("name").get<std::string>()).second) << "another row has the same name";
        const std::string key = row.at("key");
        EXPECT_TRUE(keys.insert((row.value("ctrl", false) ? "Ctrl-" : "") + key).second) << "another row has this key";
        const auto sameName = [&](const auto& group) { return group.at("name") == row.at("group"); };
        EXPECT_TRUE(std::ranges::any_of(groups, sameName)) << "there is no such group";
        for (const auto& [change, opposite] : {std::pair("increases", "decreases"), {"decreases", "increases"}}) {
            if (!row.contains(change)) continue;
            EXPECT_TRUE(row.value("repeats", false)) << "what steps through numbers is repeated while a button is held";
            const auto isPartner = [&, back = opposite, quantity = row.at(change)](const auto& other) {
                return other.value(back, nlohmann::json()) == quantity && other.at("group") == row.at("group");
            };
            EXPECT_EQ(std::ranges::count_if(rows(), isPartner), 1) << "one key of the group " << opposite << " it, too";
        }
    }
}

TEST(Keys, AKeyAndItsInverseRestoreTheState) {
    using Strokes = std::vector<KeyPress>;
    struct Undoes {
        Strokes key, inverse;
    };
    std::vector<Undoes> couples;
    const auto add = [&](const Strokes& key, const Strokes& inverse) {
        couples.push_back({key, inverse});
        couples.push_back({inverse, key});
    };
    for (const auto& row : rows()) {
        if (row.value("client", false)) continue;
        const Strokes key = strokesOf(row);
        const std::string action = row.at("action");
        if (row.contains("shift")) add(key, {KeyPress{key.front().key, true, false}});
        const auto isShown = [&](const auto& part) { return part.name == action; };
        const bool isPart = std::ranges::any_of(scene::kParts, isShown);
        if (isPart || action == "view" || text::valueNamed(scene::kViews, action)) add(key, key);
        for (const auto& other : rows()) {
            if (row.contains("increases") && other.value("decreases", nlohmann::json()) == row.at("increases"))
                add(key, strokesOf(other));
        }
    }
    EXPECT_GT(couples.size(), rows().size() / 2);
    add({KeyPress{"l"}}, {KeyPress{"h"}});
    add({KeyPress{"n"}}, {KeyPress{"N"}});
    for (const auto& [key, inverse] : couples) {
        SCOPED_TRACE(key.front().key + (key.size() > 1 ? key.back().key : "") +
                     (key.back().shift ? " with shift" : ""));
        Session session = busy();
        const auto pressAll = [&](const Strokes& strokes) {
            for (const KeyPress& stroke : strokes) must(session, stroke);
        };
        pressAll(key);             // without a highlight, a key chooses the first element, which has no inverse
        line(session, "focus 0");  // a new polytope has the focus 0
        const State before = session.current;
        pressAll(key);
        EXPECT_FALSE(session.current == before);
        pressAll(inverse);
        expectNear(session.current, before, 1e-12);
    }
}

TEST(Keys, AMillionDoNotDrift) {
    Session session;
    const Limits limits{.maxUndo = 2};
    for (int i = 0; i < 100'000; ++i) {
        for (const char* key : {"r", "2", "t", "y", "5"}) must(session, KeyPress{key, false, false}, limits);
        for (const char* key : {"5", "y", "t", "2", "r"}) must(session, KeyPress{key, true, false}, limits);
    }
    expectNear(session.current, Session{}.current, 1e-9);
    const glm::dmat4 m = session.current.orientation.matrix();
    const glm::dmat4 product = glm::transpose(m) * m;
    for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 4; ++r) EXPECT_NEAR(product[c][r], c == r ? 1 : 0, 1e-12);
    }
}

TEST(Keys, TurnInTheirPlanes) {
    using geometry::Plane;
    using geometry::RotationAngles;
    const auto lastAfter = [](const KeyPress& key) {
        Session session;
        line(session, "set alpha=0.25 beta=0.5");
        must(session, key);
        return session.current.lastTurn.value();
    };
    EXPECT_EQ(lastAfter({"2"}), (RotationAngles{Plane::xy, 0.25, {}}));
    EXPECT_EQ(lastAfter({"3"}), (RotationAngles{Plane::xz, 0.25, {}}));
    EXPECT_EQ(lastAfter({"4"}), (RotationAngles{Plane::xw, 0.25, {}}));
    EXPECT_EQ(lastAfter({"5"}), (RotationAngles{Plane::yz, 0.25, {}}));
    EXPECT_EQ(lastAfter({"6"}), (RotationAngles{Plane::yw, 0.25, {}}));
    EXPECT_EQ(lastAfter({"7"}), (RotationAngles{Plane::zw, 0.25, {}}));
    EXPECT_EQ(lastAfter({"r"}), (RotationAngles{Plane::xw, 0.25, 0.5}));
    EXPECT_EQ(lastAfter({"t"}), (RotationAngles{Plane::xz, 0.25, 0.5}));
    EXPECT_EQ(lastAfter({"y"}), (RotationAngles{Plane::xy, 0.25, 0.5}));
    EXPECT_EQ(lastAfter({"y", true, false}), (RotationAngles{Plane::xy, -0.25, -0.5}));
    EXPECT_EQ(lastAfter({"Y"}), (RotationAngles{Plane::xy, -0.25, -0.5}))
        << "an upper-case letter is Shift and the letter";
    EXPECT_EQ(lastAfter({"Y", true, false}), (RotationAngles{Plane::xy, -0.25, -0.5}));
}

TEST(Keys, ShiftCountsForLettersAndDigitsOnly) {
    Session session;
    must(session, KeyPress{"}", true, false});
    EXPECT_EQ(session.current.slices.count, 23);
    expectRefused(session, KeyPress{"L", false, false}, ErrorCode::unknown_key, "'L' has no meaning");
    expectRefused(session, KeyPress{"l", true, false}, ErrorCode::unknown_key, "has no meaning");
    expectRefused(session, KeyPress{"0", true, false}, ErrorCode::unknown_key, "has no meaning");
}

TEST(Keys, SpaceHasManyNames) {
    for (const char* name : {" ", "Space", "Spacebar"}) {
        Session session;
        press(session, "2");
        must(session, KeyPress{name, false, false});
        EXPECT_TRUE(session.current.turning);
    }
}

TEST(Keys, TwoGsGoToTheFirstSliceThatIsNotEmpty) {
    Session session;
    line(session, "polytope 8-cell");  // w is from −1 to 1, and the spacing is 0.2
    must(session, KeyPress{"g", false, false});
    EXPECT_EQ(session.current.slices.focus, 0);
    must(session, KeyPress{"g", false, false});
    EXPECT_EQ(session.current.slices.focus, -5);
    press(session, "G");
    EXPECT_EQ(session.current.slices.focus, 5) << "the hyperplane w = 1 holds a whole cell";
    line(session, "set spacing=0.3");
    press(session, "G");
    EXPECT_EQ(session.current.slices.focus, 3);
    press(session, "glgg");
    EXPECT_EQ(session.current.slices.focus, -3) << "any other key ends a sequence and acts by itself";
}

TEST(Keys, ARefusedActionEndsItsSequence) {
    Session session;
    must(session, LoadObject{"two points", "cloud", "0 0 0 -0.96\n0 0 0 0.97\n"});
    press(session, "z");
    expectRefused(session, KeyPress{"c"}, ErrorCode::out_of_range, "the two points has no cell");
    press(session, "f");
    EXPECT_FALSE(session.current.look.parts.faces) << "f acts by itself, and not as zf";
}

// The keys "gg" and "G" find the first and the last slice with points of a point cloud. A slice of a point cloud
// contains the points within half a spacing of its hyperplane.
TEST(Keys, TwoGsGoToTheFirstPointsOfACloud) {
    Session session;
    must(session, LoadObject{"two points", "cloud", "0 0 0 -0.96\n0 0 0 0.97\n"});
    line(session, "set spacing=0.1");
    press(session, "gg");
    EXPECT_EQ(session.current.slices.focus, -10);
    press(session, "G");
    EXPECT_EQ(session.current.slices.focus, 10);
    must(session, LoadObject{"one point", "cloud", "0 0 0 0.96\n"});
    line(session, "set spacing=0.1");
    press(session, "gg");
    EXPECT_EQ(session.current.slices.focus, 10);
    press(session, "G");
    EXPECT_EQ(session.current.slices.focus, 10) << "the slice below has no point";
}

TEST(Keys, MoveTheFocusPointByTheSpacingWithinItsBounds) {
    Session session;
    line(session, "polytope 8-cell");
    line(session, "set spacing=0.25 focus=1");
    press(session, "P");
    press(session, "gxgxgYgzgX");
    EXPECT_EQ(session.current.look.focusPoint, glm::dvec3(0.25, -0.25, 0.25));
    EXPECT_EQ(session.current.focusW(), 0.25);
    EXPECT_TRUE(session.current.playing) << "the focus slice goes on";
    press(session, "u");
    EXPECT_EQ(session.current.look.focusPoint, glm::dvec3(0.5, -0.25, 0.25)) << "each key is a step";
    for (int i = 0; i < 200; ++i) press(session, "gz");
    EXPECT_EQ(session.current.look.focusPoint.z, kMaxOffset * infoOf(session.current).circumradius);
    const auto revision = session.revision;
    press(session, "gz");
    EXPECT_EQ(session.revision, revision) << "a key that changes nothing is not a change";
}

TEST(Keys, AnglesStayWithinAFullTurn) {
    Session session;
    line(session, "set step=1");
    press(session, "kkkkkkkkkJJJJJJJJJ");
    EXPECT_EQ(session.current.alpha, 2 * pi);
    EXPECT_EQ(session.current.beta, -2 * pi);
    const auto revision = session.revision;
    press(session, "k");
    EXPECT_EQ(session.revision, revision) << "a key that changes nothing is not a change";
}

TEST(Keys, SlicesKeepTheirSpan) {
    Session session;
    const double span = session.current.slices.spacing * 20;
    press(session, "}");
    EXPECT_EQ(session.current.slices.count, 23);
    EXPECT_NEAR(session.current.slices.spacing * 22, span, 1e-14);
    for (int i = 0; i < 20; ++i) press(session, "{");
    EXPECT_EQ(session.current.slices.count, 1);
    for (int i = 0; i < 150; ++i) press(session, "}");
    EXPECT_EQ(session.current.slices.count, Limits{}.maxSlices);
    for (int i = 0; i < 1000; ++i) press(session, "[");
    EXPECT_GT(session.current.slices.spacing, 0);
}

TEST(Keys, StepThroughTheSameThicknessesInBothDirections) {
    Session session;
    const double& thickness = session.current.look.thickness;
    std::vector<double> steps;
    for (int i = 0; i < 8; ++i) {
        EXPECT_NEAR(thickness, std::pow(2, i / 4.0), 1e-14);
        steps.push_back(thickness);
        press(session, ">");
    }
    EXPECT_EQ(steps[4], 2);
    EXPECT_EQ(thickness, scene::Look::kThicknessRange.most);
    const auto revision = session.revision;
    press(session, ">");
    EXPECT_EQ(session.revision, revision) << "a key that changes nothing is not a change";
    for (int i = 7; i >= 0; --i) {
        press(session, "<");
        EXPECT_EQ(thickness, steps[i]);
    }
    press(session, "<<<<<<<<<<");
    EXPECT_EQ(thickness, scene::Look::kThicknessRange.least);
    line(session, "set thickness=1.1");
    press(session, ">");
    EXPECT_NEAR(thickness, std::sqrt(2), 1e-14);
    press(session, "<");
    EXPECT_EQ(thickness, steps[1]) << "the step that is nearest to 1.1";
}

TEST(Keys, WalkTheCatalogueRoundAndRound) {
    Session session;
    press(session, "r");
    const State before = session.current;
    for (const auto& entry : polytopes::catalogue()) {
        EXPECT_EQ(infoOf(session.current).name, entry.name);
        EXPECT_NEAR(session.current.slices.spacing / infoOf(session.current).circumradius, 0.1, 1e-12);
        press(session, "n");
    }
    for (const ExampleField& example : exampleFields()) {
        EXPECT_EQ(infoOf(session.current).name, example.name);
        EXPECT_NEAR(session.current.slices.spacing / slicing::initialSliceExtent(session.current.object), 0.1, 1e-12);
        press(session, "n");
    }
    expectNear(session.current, before, 1e-12);
    press(session, "N");
    EXPECT_EQ(infoOf(session.current).name, exampleFields().back().name);
}

TEST(Keys, UnknownOnesAreRefused) {
    Session session;
    expectRefused(session, KeyPress{"q", false, false}, ErrorCode::unknown_key, "'q' has no meaning");
    expectRefused(session, KeyPress{"y", false, true}, ErrorCode::unknown_key, "'Ctrl-y' has no meaning");
    expectRefused(session, KeyPress{"ArrowUp", false, false}, ErrorCode::unknown_key, "'ArrowUp'");
    expectRefused(session, KeyPress{"gg", false, false}, ErrorCode::unknown_key, "'gg'");
    expectRefused(session, KeyPress{"?", false, false}, ErrorCode::unknown_key, "handled by the client");
    press(session, "g");
    expectRefused(session, KeyPress{"q", false, false}, ErrorCode::unknown_key, "'q' has no meaning");
}

}  // namespace
}  // namespace oval4d::session
