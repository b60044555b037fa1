#include "session/command_line.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "fields/field.hpp"
#include "session/cell_types.hpp"
#include "session/expression.hpp"
#include "session/load.hpp"
#include "session/query.hpp"
#include "session/setting_text.hpp"
#include "text/message_text.hpp"
#include "text/words.hpp"

namespace oval4d::session {

namespace {

using Words = std::vector<std::string_view>;

Error errorWith(ErrorCode code, std::string message) { return {code, std::move(message)}; }

Words splitWords(std::string_view line) {
    Words words;
    while (true) {
        const std::size_t start = line.find_first_not_of(" \t");
        if (start == std::string_view::npos) return words;
        line.remove_prefix(start);
        const std::size_t end = line.find_first_of(" \t");
        words.push_back(line.substr(0, end));
        if (end == std::string_view::npos) return words;
        line.remove_prefix(end);
    }
}

// Joins words that are separated by blanks but belong together. A word is joined to the word before it if that word
// ends with a character in `separators`, if the word itself begins with such a character, or if it is the unit of a
// number. Examples are "highlight=cell: 3" and "30 °". All words must be views into the same string.
Words joinedWords(const Words& words, std::string_view separators) {
    Words joined;
    for (const std::string_view word : words) {
        const bool continues =
            !joined.empty() && (isAngleUnit(word) || separators.find(joined.back().back()) != separators.npos ||
                                separators.find(word.front()) != separators.npos);
        if (continues) {
            const char* const begin = joined.back().data();
            joined.back() = {begin, static_cast<std::size_t>(word.data() + word.size() - begin)};
        } else {
            joined.push_back(word);
        }
    }
    return joined;
}

Result<Command> makeSetCommand(std::string_view name, std::string_view value) {
    ChangeSettings set;
    if (auto done = parseSetting(name, value, set); !done) return done.error();
    return Command{set};
}

Result<Command> parsePolytopeCommand(std::string_view rest, const Words& /*words*/, const State& /*state*/) {
    if (rest.empty()) return errorWith(ErrorCode::unknown_polytope, "polytope needs a name, such as polytope 24-cell");
    return makeSetCommand("polytope", rest);  // names may contain blanks
}

Result<Command> parseFormulaCommand(std::string_view rest, const Words& /*words*/, const State& /*state*/) {
    if (rest.empty())
        return errorWith(ErrorCode::bad_expression,
                         "formula needs a function of x, y, z and w, such as formula x*y + z*w");
    // " colored by " separates two formulas. A formula cannot contain this text: the only words that may directly
    // follow another word in a formula are the units deg and rad.
    constexpr std::string_view kColoredBy = " colored by ";
    const std::size_t end = rest.find(kColoredBy);
    LoadObject load{std::string(kFormula), std::string(kFormula), std::string(rest.substr(0, end))};
    if (end != std::string_view::npos) load.secondFormula = rest.substr(end + kColoredBy.size());
    return Command{std::move(load)};
}

// Parses the command "region". The shown field must be an array in the server's data folder, or a region of one.
// "region 0,1,0,1,0,1,0,5" loads this region of the array: the ranges of x, y, z and w. "region all" loads the whole
// array.
Result<Command> parseRegionCommand(std::string_view rest, const Words& /*words*/, const State& state) {
    const fields::Field* const field = slicing::fieldIn(state.source);
    if (field == nullptr || !field->source) {
        return errorWith(ErrorCode::out_of_range,
                         text::inQuotes(slicing::infoOf(state.source).name) +
                             " is not a part of a larger array in the data folder of the server");
    }
    LoadObject load = loadCommandFor(field->name, *field->source);
    load.region.reset();
    if (rest != "all") {
        const auto region = parseBox(rest, "region");
        if (!region) return region.error();
        load.region = *region;
    }
    return Command{std::move(load)};
}

Result<Command> parseSetCommand(std::string_view rest, const Words& words, const State& /*state*/) {
    if (words.empty())
        return errorWith(ErrorCode::unknown_command, "set needs name=value; the names are " + settingNames());
    // The name of a polytope may contain blanks. If `polytope` is the only setting on the line, the name extends to the
    // end of the line.
    if (rest.starts_with("polytope=") && rest.find('=') == rest.rfind('='))
        return makeSetCommand("polytope", rest.substr(std::string_view("polytope=").size()));
    ChangeSettings set;
    for (const std::string_view word : joinedWords(words, ",:=")) {
        const std::size_t equals = word.find('=');
        if (equals == std::string_view::npos) {
            return errorWith(
                ErrorCode::bad_expression,
                text::inQuotes(word) + " has no '='; write set name=value, without blanks, such as set slices=31");
        }
        if (auto done = parseSetting(text::trimmed(word.substr(0, equals)), word.substr(equals + 1), set); !done)
            return done.error();
    }
    return Command{set};
}

Result<Command> parseRotateCommand(std::string_view /*rest*/, const Words& given, const State& state) {
    const Words words = joinedWords(given, ",");
    if (words.empty())
        return errorWith(ErrorCode::bad_expression, "rotate needs planes and angles, such as rotate xw,yz pi/8 pi/5");
    // If the line has no angles, use the angles alpha and beta of the rotation keys.
    const std::string alpha = text::shortestDecimal(state.alpha) + "rad";
    const std::string beta = text::shortestDecimal(state.beta) + "rad";
    Words angles(words.begin() + 1, words.end());
    if (angles.empty()) {
        angles.emplace_back(alpha);
        if (words[0].find(',') != std::string_view::npos) angles.emplace_back(beta);
    }
    const auto turn = parsePlanesAndAngles(words[0], angles, "xw pi/8 or xw,yz pi/8 pi/5");
    if (!turn) return turn.error();
    return Command{Rotate{*turn}};
}

Result<Command> parseTowardCommand(std::string_view rest, const Words& words, const State& /*state*/) {
    if (words.empty() || words.size() > 2) {
        return errorWith(ErrorCode::bad_expression, "toward needs " +
                                                        text::joinedWithOr(text::namesOf(slicing::kElementKinds)) +
                                                        " and optionally a number, such as toward cell 3" +
                                                        (rest.empty() ? "" : ", not " + text::inQuotes(rest)));
    }
    const auto kind = parseElementKind(words[0]);
    if (!kind) return kind.error();
    if (words.size() == 1) return Command{TurnToward{*kind, {}}};
    const auto index = parseElementIndex(words[1]);
    if (!index) return index.error();
    return Command{TurnToward{*kind, *index}};
}

Result<Command> parseKeyCommand(std::string_view rest, const Words& words, const State& /*state*/) {
    constexpr std::string_view kCtrl = "ctrl-";
    if (words.size() != 1)
        return errorWith(ErrorCode::unknown_key, "key needs one key, such as key y, key Y or key ctrl-r");
    KeyPress key{std::string(rest), false, false};
    if (rest == "space") key.key = " ";
    if ((rest.starts_with(kCtrl) || rest.starts_with("Ctrl-")) && rest.size() > kCtrl.size()) {
        key.key = rest.substr(kCtrl.size());
        key.ctrl = true;
    }
    return Command{key};
}

// Parses "highlight cell 17", which means "set highlight=cell:17".
Result<Command> parseHighlightCommand(std::string_view rest, const Words& words, const State& /*state*/) {
    if (joinedWords(words, ":").size() != 2) return makeSetCommand("highlight", rest);
    return makeSetCommand("highlight", std::string(words[0]) + ':' + std::string(words[1]));
}

// Parses "boost x 0.6", which means "set boost=0.6,0,0".
Result<Command> parseBoostCommand(std::string_view rest, const Words& words, const State& /*state*/) {
    if (joinedWords(words, ",").size() != 2) return makeSetCommand("boost", rest);
    const std::size_t axis = words[0].size() == 1 ? std::string_view("xyz").find(words[0]) : std::string_view::npos;
    if (axis == std::string_view::npos) {
        return errorWith(
            ErrorCode::bad_expression,
            "boost needs an axis x, y or z and a velocity, such as boost x 0.6, or none, or a velocity such as "
            "boost 0.6,0,0, not " +
                text::inQuotes(rest));
    }
    std::string velocity;
    for (std::size_t i = 0; i < 3; ++i) {
        if (i > 0) velocity += ',';
        velocity += i == axis ? words[1] : "0";
    }
    return makeSetCommand("boost", velocity);
}

// Returns the cell types that the arguments of hide, fade and show select: numbers, or the name of a cell type. Without
// arguments, returns the type of the highlighted cell. Errors: the errors of findCellTypes(), also if there are no
// arguments and no cell is highlighted.
Result<CellTypeList> selectedCellTypes(std::string_view rest, const State& state) {
    const auto& lit = state.look.highlight;
    if (rest.empty() && lit && lit->kind == slicing::ElementKind::cell)
        return CellTypeList{slicing::typesOfCells(state.object)[lit->index]};
    return findCellTypes(rest, slicing::infoOf(state.object));
}

// Parses the arguments of hide, fade and show. `change` is the function of the command: hideCellTypes(),
// fadeCellTypes() or revealCellTypes(). Without arguments, show shows all cells.
template <scene::CellTypeFilter (*change)(scene::CellTypeFilter, const CellTypeList&)>
Result<Command> parseCellTypesCommand(std::string_view rest, const Words& /*words*/, const State& state) {
    ChangeSettings set;
    scene::CellTypeFilter filter;
    if (change != revealCellTypes || !rest.empty()) {
        const auto named = selectedCellTypes(rest, state);
        if (!named) return named.error();
        filter = change(state.look.cellTypes, *named);
    }
    set.hidden = std::move(filter.hidden);
    set.faded = std::move(filter.faded);
    return Command{set};
}

// Parses a command that takes no arguments.
template <typename C>
Result<Command> parseWithoutArguments(std::string_view rest, const Words& /*words*/, const State& /*state*/) {
    if (!rest.empty())
        return errorWith(ErrorCode::bad_expression, "this command takes no arguments; remove " + text::inQuotes(rest));
    return Command{C{}};
}

// Parses the command "play", which starts to move the focus to and fro. "play 2" also sets the speed, to twice the
// normal speed.
Result<Command> parsePlayCommand(std::string_view rest, const Words& /*words*/, const State& /*state*/) {
    ChangeSettings set;
    if (!rest.empty()) {
        if (auto done = parseSetting("speed", rest, set); !done) return done.error();
    }
    set.playing = true;
    return Command{std::move(set)};
}

Result<Command> parsePauseCommand(std::string_view rest, const Words& words, const State& state) {
    if (auto valid = parseWithoutArguments<ChangeSettings>(rest, words, state); !valid) return valid.error();
    ChangeSettings set;
    set.playing = false;
    return Command{std::move(set)};
}

// A command of the page's command line: its name, and the function that parses the rest of the line.
struct CommandLineVerb {
    std::string_view name;
    Result<Command> (*read)(std::string_view rest, const Words& words, const State& state);
};
constexpr auto kVerbs = std::to_array<CommandLineVerb>(
    {{"polytope", parsePolytopeCommand},
     {"set", parseSetCommand},
     {"rotate", parseRotateCommand},
     {"toward", parseTowardCommand},
     {"view", [](std::string_view rest, const Words&, const State&) { return makeSetCommand("view", rest); }},
     {"focus", [](std::string_view rest, const Words&, const State&) { return makeSetCommand("focus", rest); }},
     {"play", parsePlayCommand},
     {"pause", parsePauseCommand},
     {"color", [](std::string_view rest, const Words&, const State&) { return makeSetCommand("color", rest); }},
     {"project", [](std::string_view rest, const Words&, const State&) { return makeSetCommand("projection", rest); }},
     {"highlight", parseHighlightCommand},
     {"hide", parseCellTypesCommand<hideCellTypes>},
     {"fade", parseCellTypesCommand<fadeCellTypes>},
     {"show", parseCellTypesCommand<revealCellTypes>},
     {"formula", parseFormulaCommand},
     {"region", parseRegionCommand},
     {"fog", [](std::string_view rest, const Words&, const State&) { return makeSetCommand("fog", rest); }},
     {"follow", [](std::string_view rest, const Words&, const State&) { return makeSetCommand("follow", rest); }},
     {"boost", parseBoostCommand},
     {"key", parseKeyCommand},
     {"reset", parseWithoutArguments<ResetOrientationAndFocus>},
     {"undo", parseWithoutArguments<Undo>},
     {"redo", parseWithoutArguments<Redo>}});

}  // namespace

Result<Command> parseCommandLine(std::string_view written, const State& state) {
    const std::string plain = text::withPlainBlanks(written);
    std::string_view line = plain;
    const auto trim = [&line] {
        const std::size_t first = line.find_first_not_of(" \t\r\n");
        line = first == std::string_view::npos ? std::string_view{}
                                               : line.substr(first, line.find_last_not_of(" \t\r\n") - first + 1);
    };
    trim();
    if (line.starts_with(':')) line.remove_prefix(1);
    trim();
    std::vector<std::string_view> verbs;
    for (const CommandLineVerb& verb : kVerbs) verbs.push_back(verb.name);
    if (line.empty())
        return errorWith(ErrorCode::unknown_command, "a command is expected: " + text::commaSeparated(verbs));

    const std::size_t end = line.find_first_of(" \t");
    const std::string_view name = line.substr(0, end);
    std::string_view rest = end == std::string_view::npos ? std::string_view{} : line.substr(end);
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    for (const CommandLineVerb& verb : kVerbs) {
        if (verb.name == name) return verb.read(rest, splitWords(rest), state);
    }
    return errorWith(ErrorCode::unknown_command, "no command is called " + text::inQuotes(name) +
                                                     text::didYouMean(name, verbs) + "; the commands are " +
                                                     text::commaSeparated(verbs));
}

}  // namespace oval4d::session
