// Tests with random sequences of commands and motions: the revision counts the changes, and undo and redo lead back and
// forth.

#include <array>
#include <cstring>
#include <random>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "protocol_data/embedded_files.hpp"
#include "session/history.hpp"
#include "unit/session/support.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::session {
namespace {

using Random = std::mt19937;

template <typename List>
const auto& oneOf(const List& list, Random& random) {
    return list[std::uniform_int_distribution<std::size_t>(0, std::size(list) - 1)(random)];
}

bool happens(double probability, Random& random) { return std::bernoulli_distribution(probability)(random); }

// Returns whether states are equal apart from the camera. Different transformations of one object to the same frame of
// reference count as equal.
bool isSame(State a, const State& b) {
    a.look.orbit = b.look.orbit;
    if (a.source == b.source && a.referenceFrame == b.referenceFrame) a.object = b.object;
    return a == b;
}

// --- Commands

KeyPress randomKey(Random& random) {
    static const auto rows =
        nlohmann::json::parse(protocol_data::embeddedFile("keymap.json")).at("keys").get<std::vector<nlohmann::json>>();
    const nlohmann::json& row = oneOf(rows, random);
    const std::string keys = row.at("key");
    return {
        keys.size() == 2 && happens(0.5, random) ? keys.substr(1) : keys.substr(0, keys.size() == 2 ? 1 : keys.size()),
        happens(0.2, random), row.value("ctrl", false)};
}

constexpr std::array kLines{"polytope 24-cell",
                            "polytope 5-cell",
                            "polytope a",
                            "polytope b",
                            "polytope tiger",
                            "polytope nothing",
                            "formula x^2+y^2+z^2 < 0.1+w^2",
                            "formula x*y-w colored by z",
                            "formula x*",
                            "rotate xy 0",
                            "rotate xw,yz 0 0",
                            "rotate xw",
                            "rotate zw 2*pi",
                            "rotate xy,zw pi 2*pi",
                            "rotate xz pi/3",
                            "rotate yz 3000000",
                            "toward cell 0",
                            "toward vertex",
                            "toward cell 1000",
                            "set turning=on",
                            "set turning=off",
                            "play",
                            "play 2",
                            "pause",
                            "set speed=1/2",
                            "set alpha=0",
                            "set alpha=pi/3 beta=0",
                            "set alpha=2*pi beta=2*pi",
                            "set alpha=100",
                            "set azimuth=0.5",
                            "set azimuth=0 elevation=0 zoom=1",
                            "set zoom=2 focus=1",
                            "set zoom=1000",
                            "set slices=21",
                            "set slices=7",
                            "set slices=8",
                            "set w=0",
                            "set w=0.25",
                            "set point=0,0,0,0",
                            "set point=0.1,0,0,0.2",
                            "set pace=1",
                            "set pace=2",
                            "set boost=0.5,0,0",
                            "set boost=none",
                            "set follow=0.1,0,0",
                            "set follow=none",
                            "set levels=0.1",
                            "set levels=0.1,0.2",
                            "set fog=off",
                            "set color=cell",
                            "set color=w",
                            "set highlight=none",
                            "set highlight=cell:0",
                            "set hidden=0",
                            "set hidden=none faded=0",
                            "set faces=off",
                            "set faces=on",
                            "hide 0",
                            "show",
                            "fade 0",
                            "fade octahedron",
                            "view oval",
                            "view matrix",
                            "focus 0",
                            "focus 3",
                            "key space",
                            "key u",
                            "key ctrl-r",
                            "reset",
                            "undo",
                            "redo",
                            "nonsense"};

ChangeSettings randomSet(Random& random) {
    ChangeSettings set;
    set.continues = happens(0.5, random);
    if (happens(0.2, random)) set.object = oneOf(std::array{"5-cell", "16-cell", "a", "b", "run"}, random);
    if (happens(0.3, random)) {
        const double angle = oneOf(std::array{0.0, 0.5, 1.0}, random);
        set.orientation = geometry::Rotation(geometry::RotationAngles{geometry::Plane::xw, angle, {}}).matrix();
        if (happens(0.1, random)) (*set.orientation)[0][0] += 1;
    }
    if (happens(0.3, random)) set.turning = happens(0.5, random);
    if (happens(0.2, random)) set.focus = oneOf(std::array{-1, 0, 1, 2'000'000}, random);
    if (happens(0.2, random)) set.plain.valueOf<double>("azimuth") = oneOf(std::array{0.0, 0.5}, random);
    if (happens(0.2, random)) set.plain.valueOf<double>("zoom") = oneOf(std::array{1.0, 2.0}, random);
    if (happens(0.1, random)) set.pace = oneOf(std::array{1.0, 2.0}, random);
    if (happens(0.1, random)) set.hidden = std::vector<std::uint32_t>(happens(0.5, random) ? 1 : 0);
    if (happens(0.1, random)) set.highlight = slicing::Element{slicing::ElementKind::vertex, 1};
    if (happens(0.1, random)) set.highlight = std::optional<slicing::Element>();
    if (happens(0.1, random)) set.levels = std::vector{oneOf(std::array{0.0, 0.5}, random)};
    if (happens(0.2, random))
        set.lastTurn = geometry::RotationAngles{geometry::Plane::xy, happens(0.5, random) ? 0 : 0.1, {}};
    return set;
}

// Returns a NumPy file with 2 × 2 × 2 × `times` samples.
std::string numpyFile(std::size_t times, Random& random) {
    std::string header =
        "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2, 2, " + std::to_string(times) + "), }";
    constexpr std::size_t kAlignment = 64, kBeforeHeader = 10;
    header.resize((header.size() + 1 + kBeforeHeader + kAlignment - 1) / kAlignment * kAlignment - kBeforeHeader, ' ');
    header.back() = '\n';
    std::string file("\x93NUMPY\x01\x00", 8);
    file += {static_cast<char>(header.size()), 0};
    file += header;
    for (std::size_t i = 0; i < 8 * times; ++i) {
        const float value = std::uniform_real_distribution<float>(-1, 1)(random);
        std::array<char, sizeof value> bytes;
        std::memcpy(bytes.data(), &value, sizeof value);
        file.append(bytes.data(), bytes.size());
    }
    return file;
}

LoadObject randomLoad(Random& random) {
    const std::string name = oneOf(std::array{"a", "b", "c", "5-cell"}, random);
    const bool continues = happens(0.5, random);
    switch (std::uniform_int_distribution(0, 5)(random)) {
        case 0:
            return {name, "off", happens(0.2, random) ? "4OFF" : support::kPentachoron, continues};
        case 1:
            return {name, "points", "0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", continues};
        case 2:
            return {name, "cloud", "1 0 0 0\n0 1 0 0\n0 0 0.5 1\n", continues};
        case 3:
            return {name, "formula", oneOf(std::array{"x+y*w", "x^2+y^2-w", "x-0.1", "x-"}, random), continues};
        case 4:
            return {"run", "npy", numpyFile(2, random), continues};
        default:
            break;
    }
    LoadObject load{"run", "npy", numpyFile(1, random)};
    load.append = true;
    return load;
}

Command randomCommand(Random& random) {
    switch (std::discrete_distribution{{30, 25, 10, 10, 4, 4, 10, 10, 1}}(random)) {
        case 0:
            return randomKey(random);
        case 1:
            return CommandLine{oneOf(kLines, random)};
        case 2:
            return randomSet(random);
        case 3: {
            geometry::RotationAngles turn{
                oneOf(geometry::kPlanes, random), oneOf(std::array{0.0, 0.1, -0.1, 1.0, 2e6}, random), {}};
            while (happens(0.3, random)) turn[oneOf(geometry::kPlanes, random)] = oneOf(std::array{0.0, 0.1}, random);
            return Rotate{turn, happens(0.5, random)};
        }
        case 4:
            return TurnToward{oneOf(slicing::kElementKinds, random).value,
                              happens(0.5, random) ? std::nullopt : std::optional<std::size_t>(0),
                              happens(0.3, random)};
        case 5:
            return randomLoad(random);
        case 6:
            return Undo{};
        case 7:
            return Redo{};
        default:
            return ResetOrientationAndFocus{};
    }
}

std::string textOf(const Command& command) {
    if (const auto* key = std::get_if<KeyPress>(&command)) return "key " + key->key + (key->ctrl ? " with Ctrl" : "");
    if (const auto* line = std::get_if<CommandLine>(&command)) return ":" + line->line;
    const std::array names{"key", "rotate", "toward", "random", "set", "load", "undo", "redo", "reset", "line"};
    return names.at(command.index());
}

bool continues(const Command& command) {
    if (const auto* rotate = std::get_if<Rotate>(&command)) return rotate->continues;
    if (const auto* set = std::get_if<ChangeSettings>(&command)) return set->continues;
    if (const auto* load = std::get_if<LoadObject>(&command)) return load->continues;
    return false;
}

bool isAppend(const Command& command) {
    const auto* load = std::get_if<LoadObject>(&command);
    return load != nullptr && load->append;
}

// Returns whether a command undoes or redoes steps.
bool isUndoOrRedo(const Command& command) {
    if (const auto* key = std::get_if<KeyPress>(&command)) return key->key == "u" || (key->key == "r" && key->ctrl);
    if (const auto* line = std::get_if<CommandLine>(&command))
        return std::set<std::string>{"undo", "redo", "key u", "key ctrl-r"}.contains(line->line);
    return std::holds_alternative<Undo>(command) || std::holds_alternative<Redo>(command);
}

// --- Invariants

// Calls `move`, which is undo() or redo(), at most `atMost` times. Returns the number of successful calls. Each call
// must change the state but not the camera, and increase the revision by one. A call that fails must change nothing.
std::size_t moveThrough(Session& session, Result<std::monostate> (*move)(Session&), std::size_t atMost) {
    for (std::size_t moves = 0;; ++moves) {
        if (moves == atMost) return moves;
        const Session before = session;
        if (!move(session)) {
            EXPECT_EQ(session, before) << "an error changes nothing";
            return moves;
        }
        EXPECT_FALSE(isSame(session.current, before.current)) << "a step changes something";
        EXPECT_EQ(session.current.look.orbit, before.current.look.orbit);
        EXPECT_EQ(session.revision, before.revision + 1);
    }
}

constexpr std::size_t kAll = 1'000'000;

// Expects that undo and redo lead back and forth. `first` is the first state of the session, or null if the limits of
// the history may have removed it.
void expectHistory(const Session& session, const State* first) {
    for (const auto& [there, back] : {std::pair(&undo, &redo), std::pair(&redo, &undo)}) {
        Session moved = session;
        if (moveThrough(moved, there, 1) == 0) continue;
        EXPECT_TRUE(back(moved));
        EXPECT_EQ(moved.current, session.current) << "there and back";
        EXPECT_EQ(moved.revision, session.revision + 2);
    }
    Session moved = session;
    const std::size_t undos = moveThrough(moved, undo, kAll);
    const State& oldest = session.undoSteps.empty() ? session.current : session.undoSteps.front();
    EXPECT_TRUE(isSame(moved.current, oldest)) << "undo leads to the oldest step";
    EXPECT_TRUE(first == nullptr || isSame(moved.current, *first)) << "undo leads to the first state";
    EXPECT_EQ(moveThrough(moved, redo, undos), undos);
    EXPECT_EQ(moved.current, session.current) << "redo leads back";
    moveThrough(moved, redo, kAll);
    const State& newest = session.redoSteps.empty() ? session.current : session.redoSteps.front();
    EXPECT_TRUE(isSame(moved.current, newest)) << "redo leads to the newest step";
}

// Executes a command, and checks its effects on the session.
void execute(Session& session, const Command& command, const Limits& limits) {
    const Session before = session;
    const auto done = apply(session, command, limits);
    if (!done) {
        Session expected = before;
        if (session.pendingKey.empty()) expected.pendingKey.clear();  // a refused action ends a sequence of keys
        EXPECT_EQ(session, expected) << "an error changes nothing else: " << done.error().message;
        return;
    }
    const bool changed = session.current != before.current;
    EXPECT_EQ(session.revision, before.revision + (changed ? 1 : 0)) << "the revision counts the changes";
    EXPECT_LE(session.undoSteps.size(), limits.maxUndo);
    if (!changed) {
        EXPECT_EQ(session.undoSteps, before.undoSteps);
        EXPECT_EQ(session.redoSteps, before.redoSteps);
    }
    if (isUndoOrRedo(command) || isAppend(command)) return;
    State running = before.current;
    running.turning = running.turning && session.current.turning;
    running.playing = running.playing && session.current.playing;
    if (isSame(running, session.current)) {  // only the camera has moved, or a motion has stopped
        EXPECT_EQ(session.undoSteps, before.undoSteps);
        EXPECT_EQ(session.redoSteps, before.redoSteps);
        return;
    }
    EXPECT_TRUE(session.redoSteps.empty()) << "a change forgets what was undone";
    if (continues(command) || limits.maxUndo == 0 || limits.maxUndoBytes < Limits{}.maxUndoBytes) return;
    Session undone = session;
    ASSERT_TRUE(undo(undone));
    running.turning = before.current.turning;
    EXPECT_TRUE(isSame(undone.current, running)) << "undo returns to the state before the command";
}

void advanceAndCheck(Session& session, double seconds) {
    const Session before = session;
    advanceMotionBy(session, seconds);
    EXPECT_EQ(session.revision, before.revision + (session.current != before.current ? 1 : 0));
    EXPECT_EQ(session.undoSteps, before.undoSteps);
    EXPECT_EQ(session.redoSteps, before.redoSteps);
}

// Returns the commands from which random sequences are drawn. The list is short, so that states are likely to recur.
std::vector<Command> commandsToDraw(Random& random) {
    std::vector<Command> commands(happens(0.5, random) ? 6 : 60);
    for (Command& command : commands) command = randomCommand(random);
    for (std::size_t i = 0; i <= commands.size() / 6; ++i) {
        for (const KeyPress& key : {KeyPress{" "}, KeyPress{" "}, KeyPress{"u"}, KeyPress{"r", false, true}})
            commands.emplace_back(key);
    }
    return commands;
}

TEST(RandomHistory, TheRevisionCountsTheChangesAndUndoLeadsBack) {
    constexpr unsigned kSequences = 4000;
    for (unsigned seed = 0; seed < kSequences && !testing::Test::HasFailure(); ++seed) {
        SCOPED_TRACE("sequence " + std::to_string(seed));
        Random random(seed);
        Limits limits;
        limits.maxLoaded = 3;
        limits.maxUndo = oneOf(std::array<std::size_t, 6>{0, 1, 3, 1000, 1000, 1000}, random);
        if (happens(0.4, random)) limits.maxUndoBytes = oneOf(std::array<std::size_t, 2>{0, 2000}, random);
        const bool forgets = happens(0.2, random);
        const bool keepsAll = limits.maxUndo == 1000 && limits.maxUndoBytes == Limits{}.maxUndoBytes && !forgets;
        const std::vector<Command> commands = commandsToDraw(random);
        Session session;
        const State first = session.current;
        std::string log;
        for (int i = 0; i < 60 && !testing::Test::HasFailure(); ++i) {
            if (happens(0.15, random)) {
                const double seconds = oneOf(std::array{0.0, 1e-9, 1.0 / 60, 1.0 / 6, 1.0, 20.0}, random);
                log += "\nadvance " + std::to_string(seconds);
                advanceAndCheck(session, seconds);
            } else if (forgets && happens(0.05, random)) {
                log += "\nforget";
                forgetOlderUndoSteps(session);
            } else {
                const Command& command = oneOf(commands, random);
                const auto* key = std::get_if<KeyPress>(&command);
                const bool searches = key != nullptr && (key->key == ")" || key->key == "(");
                // The search takes too long.
                if (searches && slicing::fieldIn(session.current.object) != nullptr) continue;
                log += "\n" + textOf(command);
                execute(session, command, limits);
            }
            expectHistory(session, keepsAll ? &first : nullptr);
        }
        EXPECT_FALSE(testing::Test::HasFailure()) << log;
    }
}

}  // namespace
}  // namespace oval4d::session
