#include "session/command_line.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "session/cell_types.hpp"
#include "session/expression.hpp"
#include "session/load.hpp"
#include "session/session.hpp"
#include "text/message_text.hpp"

namespace oval4d::session {

namespace {

using Words = std::vector<std::string_view>;

// A pointer to a member of Set.
using Member =
    std::variant<std::optional<double> Set::*, std::optional<int> Set::*, std::optional<bool> Set::*,
                 std::optional<std::string> Set::*, std::optional<scene::View> Set::*,
                 std::optional<scene::Coloring> Set::*, std::optional<scene::ProjectionKind> Set::*,
                 std::optional<CellTypeList> Set::*, std::optional<std::optional<slicing::Element>> Set::*,
                 std::optional<glm::dvec4> Set::*, std::optional<glm::dvec3> Set::*,
                 std::optional<std::vector<double>> Set::*, std::optional<fields::Inside> Set::*,
                 std::optional<scene::CapStyle> Set::*, std::optional<std::vector<slicing::FogPoint>> Set::*>;
/// One setting: its name, and the member of Set that stores it.
struct Setting {
    std::string_view name;
    Member member;
};
const auto kSettings = std::to_array<Setting>({{"polytope", &Set::object},
                                               {"pace", &Set::pace},
                                               {"follow", &Set::follow},
                                               {"boost", &Set::boost},
                                               {"alpha", &Set::alpha},
                                               {"beta", &Set::beta},
                                               {"step", &Set::step},
                                               {"slices", &Set::count},
                                               {"spacing", &Set::spacing},
                                               {"focus", &Set::focus},
                                               {"offset", &Set::offset},
                                               {"w", &Set::focusW},
                                               {"point", &Set::focusPoint},
                                               {"view", &Set::view},
                                               {"turning", &Set::turning},
                                               {"azimuth", &Set::azimuth},
                                               {"elevation", &Set::elevation},
                                               {"zoom", &Set::zoom},
                                               {"color", &Set::coloring},
                                               {"projection", &Set::projection},
                                               {"eye", &Set::eye},
                                               {"levels", &Set::levels},
                                               {"inside", &Set::inside},
                                               {"caps", &Set::caps},
                                               {"fog", &Set::fog},
                                               {"hidden", &Set::hidden},
                                               {"faded", &Set::faded},
                                               {"highlight", &Set::highlight}});

std::vector<std::string_view> names() {
    std::vector<std::string_view> all;
    for (const Setting& setting : kSettings) all.push_back(setting.name);
    for (const scene::PartRow& part : scene::kParts) all.push_back(part.name);
    return all;
}

Error bad(ErrorCode code, std::string message) { return {code, std::move(message)}; }

// Parses `text` as the value of the setting `name`, and stores it in a member of `set`.
struct ValueReader {
    Set& set;
    std::string_view name, text;

    Result<std::monostate> operator()(std::optional<double> Set::* member) const {
        constexpr auto kAngles = std::to_array({&Set::alpha, &Set::beta, &Set::step, &Set::azimuth, &Set::elevation});
        const bool isAngle = std::ranges::find(kAngles, member) != kAngles.end();
        const auto value = isAngle ? evaluateAngle(text) : evaluate(text);
        if (!value) return bad(value.error().code, std::string(name) + ": " + value.error().message);
        set.*member = *value;
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<int> Set::* member) const {
        const auto value = evaluate(text);
        if (!value) return bad(value.error().code, std::string(name) + ": " + value.error().message);
        constexpr double kMaxMagnitude = 1'000'000'000;
        if (*value != std::trunc(*value) || std::abs(*value) > kMaxMagnitude) {
            return bad(ErrorCode::out_of_range,
                       std::string(name) + " must be a whole number, not " + text::inQuotes(text));
        }
        set.*member = static_cast<int>(*value);
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<bool> Set::* member) const { return readFlag(set.*member); }
    Result<std::monostate> readFlag(std::optional<bool>& into) const {
        const bool yes = text == "on" || text == "true" || text == "yes" || text == "1";
        const bool no = text == "off" || text == "false" || text == "no" || text == "0";
        if (!yes && !no)
            return bad(ErrorCode::bad_expression,
                       std::string(name) + " must be on or off, not " + text::inQuotes(text));
        into = yes;
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<glm::dvec4> Set::* member) const {
        return readVector(4, "four numbers x,y,z,w without blanks, such as 0.1,0,-0.2,0", set.*member);
    }
    Result<std::monostate> operator()(std::optional<glm::dvec3> Set::* member) const {
        if (text == "none") {
            set.*member = glm::dvec3(0);
            return std::monostate{};
        }
        return readVector(3, "none or a velocity x,y,z without blanks, such as 0.3,0,0", set.*member);
    }
    template <typename Vector>
    Result<std::monostate> readVector(std::ptrdiff_t size, std::string_view form, std::optional<Vector>& into) const {
        if (std::ranges::count(text, ',') != size - 1) {
            return bad(ErrorCode::bad_expression,
                       std::string(name) + " must be " + std::string(form) + ", not " + text::inQuotes(text));
        }
        const auto list = readNumbers();
        if (!list) return list.error();
        for (int axis = 0; axis < size; ++axis) into.emplace(into.value_or(Vector(0)))[axis] = (*list)[axis];
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<std::string> Set::* member) const {
        if (text.empty()) return bad(ErrorCode::bad_expression, std::string(name) + " must be a name");
        set.*member = std::string(text);
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<std::vector<double>> Set::* member) const {
        auto list = readNumbers();
        if (!list) return list.error();
        set.*member = std::move(*list);
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<std::vector<slicing::FogPoint>> Set::* member) const {
        std::vector<slicing::FogPoint>& points = (set.*member).emplace();
        if (text == "off") return std::monostate{};
        for (std::string_view rest = text;;) {
            const std::size_t comma = rest.find(',');
            auto point = readFogPoint(rest.substr(0, comma));
            if (!point) return point.error();
            points.push_back(*point);
            if (comma == std::string_view::npos) return std::monostate{};
            rest.remove_prefix(comma + 1);
        }
    }
    Result<slicing::FogPoint> readFogPoint(std::string_view word) const {
        const std::size_t first = word.find(':');
        const std::size_t second = first == std::string_view::npos ? first : word.find(':', first + 1);
        const auto malformed = [&] {
            return bad(ErrorCode::bad_expression,
                       std::string(name) +
                           " must be off, or points value:opacity or value:opacity:RRGGBB without blanks, such as "
                           "0:0.8,1:0.2:ff8800,2:0, not " +
                           text::inQuotes(text));
        };
        if (first == std::string_view::npos) return malformed();
        slicing::FogPoint point;
        const std::string_view opacity =
            word.substr(first + 1, second == std::string_view::npos ? second : second - first - 1);
        for (const auto& [part, into] : {std::pair(word.substr(0, first), &point.value), {opacity, &point.opacity}}) {
            const auto value = evaluate(part);
            if (!value) return bad(value.error().code, std::string(name) + ": " + value.error().message);
            *into = *value;
        }
        if (second == std::string_view::npos) return point;
        constexpr std::size_t kDigits = 6;
        const std::string_view color = word.substr(second + 1);
        const auto [end, error] = std::from_chars(color.data(), color.data() + color.size(), point.color.emplace(), 16);
        if (error != std::errc{} || end != color.data() + color.size() || color.size() != kDigits) return malformed();
        return point;
    }
    Result<std::vector<double>> readNumbers() const {
        std::vector<double> list;
        for (std::string_view rest = text;;) {
            const std::size_t comma = rest.find(',');
            const auto value = evaluate(rest.substr(0, comma));
            if (!value) return bad(value.error().code, std::string(name) + ": " + value.error().message);
            list.push_back(*value);
            if (comma == std::string_view::npos) return list;
            rest.remove_prefix(comma + 1);
        }
    }
    Result<std::monostate> operator()(std::optional<fields::Inside> Set::* member) const {
        return choose(fields::kInsides, set.*member);
    }
    Result<std::monostate> operator()(std::optional<scene::View> Set::* member) const {
        return choose(scene::kViews, set.*member);
    }
    Result<std::monostate> operator()(std::optional<scene::Coloring> Set::* member) const {
        return choose(scene::kColorings, set.*member);
    }
    Result<std::monostate> operator()(std::optional<scene::CapStyle> Set::* member) const {
        return choose(scene::kCapStyles, set.*member);
    }
    Result<std::monostate> operator()(std::optional<scene::ProjectionKind> Set::* member) const {
        return choose(scene::kProjectionKinds, set.*member);
    }
    template <typename Choices, typename Value>
    Result<std::monostate> choose(const Choices& choices, std::optional<Value>& into) const {
        into = oval4d::text::valueNamed(choices, text);
        if (into) return std::monostate{};
        return bad(ErrorCode::bad_expression, std::string(name) + " must be " +
                                                  oval4d::text::alternatives(oval4d::text::namesOf(choices)) +
                                                  ", not " + oval4d::text::inQuotes(text));
    }
    Result<std::monostate> operator()(std::optional<std::optional<slicing::Element>> Set::* member) const {
        if (text == "none") {
            (set.*member).emplace();
            return std::monostate{};
        }
        const std::size_t colon = text.find(':');
        if (colon == std::string_view::npos) {
            return bad(
                ErrorCode::bad_expression,
                std::string(name) + " must be none or an element such as cell:17, not " + oval4d::text::inQuotes(text));
        }
        const auto kind = parseElementKind(text.substr(0, colon));
        if (!kind) return kind.error();
        const auto index = parseElementIndex(text.substr(colon + 1));
        if (!index) return index.error();
        (set.*member).emplace(slicing::Element{*kind, *index});
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<CellTypeList> Set::* member) const {
        auto types = parseCellTypes(text);
        if (!types) return bad(types.error().code, std::string(name) + ": " + types.error().message);
        set.*member = std::move(*types);
        return std::monostate{};
    }
};

Words split(std::string_view line) {
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

Result<Command> oneSetting(std::string_view name, std::string_view value) {
    Set set;
    if (auto done = parseSetting(name, value, set); !done) return done.error();
    return Command{set};
}

Result<Command> polytopeLine(std::string_view rest, const Words& /*words*/, const State& /*state*/) {
    if (rest.empty()) return bad(ErrorCode::unknown_polytope, "polytope needs a name, such as polytope 24-cell");
    return oneSetting("polytope", rest);  // names may contain blanks
}

Result<Command> formulaLine(std::string_view rest, const Words& /*words*/, const State& /*state*/) {
    if (rest.empty())
        return bad(ErrorCode::bad_expression, "formula needs a function of x, y, z and w, such as formula x*y + z*w");
    // This separator is unambiguous, because a formula never contains two words in a row.
    constexpr std::string_view kColoredBy = " colored by ";
    const std::size_t end = rest.find(kColoredBy);
    LoadObject load{std::string(kFormula), std::string(kFormula), std::string(rest.substr(0, end))};
    if (end != std::string_view::npos) load.values = rest.substr(end + kColoredBy.size());
    return Command{std::move(load)};
}

Result<Command> setLine(std::string_view rest, const Words& words, const State& /*state*/) {
    if (words.empty()) return bad(ErrorCode::unknown_command, "set needs name=value; the names are " + settingNames());
    // A polytope's name may contain blanks. If it is the only setting on the line, the rest of the line is the name.
    if (rest.starts_with("polytope=") && rest.find('=') == rest.rfind('='))
        return oneSetting("polytope", rest.substr(std::string_view("polytope=").size()));
    Set set;
    for (const std::string_view word : words) {
        const std::size_t equals = word.find('=');
        if (equals == std::string_view::npos) {
            return bad(
                ErrorCode::bad_expression,
                text::inQuotes(word) + " has no '='; write set name=value, without blanks, such as set slices=31");
        }
        if (auto done = parseSetting(word.substr(0, equals), word.substr(equals + 1), set); !done) return done.error();
    }
    return Command{set};
}

Result<Command> rotateLine(std::string_view /*rest*/, const Words& words, const State& state) {
    if (words.empty())
        return bad(ErrorCode::bad_expression, "rotate needs planes and angles, such as rotate xw,yz pi/8 pi/5");
    // If no angles are given, use those of the rotation keys.
    const std::string alpha = text::shortestDecimal(state.alpha) + "rad";
    const std::string beta = text::shortestDecimal(state.beta) + "rad";
    Words angles(words.begin() + 1, words.end());
    if (angles.empty()) {
        angles.emplace_back(alpha);
        if (words[0].find(',') != std::string_view::npos) angles.emplace_back(beta);
    }
    const auto turn = makeTurn(words[0], angles, "xw pi/8 or xw,yz pi/8 pi/5");
    if (!turn) return turn.error();
    return Command{Rotate{*turn}};
}

Result<Command> towardLine(std::string_view rest, const Words& words, const State& /*state*/) {
    if (words.empty() || words.size() > 2) {
        return bad(ErrorCode::bad_expression, "toward needs " +
                                                  text::alternatives(text::namesOf(slicing::kElementKinds)) +
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

Result<Command> keyLine(std::string_view rest, const Words& words, const State& /*state*/) {
    constexpr std::string_view kCtrl = "ctrl-";
    if (words.size() != 1) return bad(ErrorCode::unknown_key, "key needs one key, such as key y, key Y or key ctrl-r");
    Key key{std::string(rest), false, false};
    if (rest == "space") key.key = " ";
    if ((rest.starts_with(kCtrl) || rest.starts_with("Ctrl-")) && rest.size() > kCtrl.size()) {
        key.key = rest.substr(kCtrl.size());
        key.ctrl = true;
    }
    return Command{key};
}

// "highlight cell 17" is short for "set highlight=cell:17".
Result<Command> highlightLine(std::string_view rest, const Words& words, const State& /*state*/) {
    if (words.size() != 2) return oneSetting("highlight", rest);
    return oneSetting("highlight", std::string(words[0]) + ':' + std::string(words[1]));
}

// "boost x 0.6" is short for "set boost=0.6,0,0".
Result<Command> boostLine(std::string_view rest, const Words& words, const State& /*state*/) {
    if (words.size() != 2) return oneSetting("boost", rest);
    const std::size_t axis = words[0].size() == 1 ? std::string_view("xyz").find(words[0]) : std::string_view::npos;
    if (axis == std::string_view::npos) {
        return bad(ErrorCode::bad_expression,
                   "boost needs an axis x, y or z and a velocity, such as boost x 0.6, or none, or a velocity such as "
                   "boost 0.6,0,0, not " +
                       text::inQuotes(rest));
    }
    std::string velocity;
    for (std::size_t i = 0; i < 3; ++i) {
        if (i > 0) velocity += ',';
        velocity += i == axis ? words[1] : "0";
    }
    return oneSetting("boost", velocity);
}

// Returns the cell types that the arguments of hide, fade and show select: numbers, or the name of a cell type; without
// arguments, that of the highlighted cell.
Result<CellTypeList> selectedCellTypes(std::string_view rest, const State& state) {
    const auto& lit = state.look.highlight;
    if (rest.empty() && lit && lit->kind == slicing::ElementKind::cell)
        return CellTypeList{slicing::typeOfCells(state.object)[lit->index]};
    return findCellTypes(rest, slicing::infoOf(state.object));
}

// Parses the arguments of hide, fade and show. `show` without arguments shows all cells.
template <scene::CellTypeFilter (*change)(scene::CellTypeFilter, const CellTypeList&)>
Result<Command> cellTypesLine(std::string_view rest, const Words& /*words*/, const State& state) {
    Set set;
    scene::CellTypeFilter filter;
    if (change != reveal || !rest.empty()) {
        const auto named = selectedCellTypes(rest, state);
        if (!named) return named.error();
        filter = change(state.look.cellTypes, *named);
    }
    set.hidden = std::move(filter.hidden);
    set.faded = std::move(filter.faded);
    return Command{set};
}

// Parses a command without arguments.
template <typename C>
Result<Command> noArguments(std::string_view rest, const Words& /*words*/, const State& /*state*/) {
    if (!rest.empty())
        return bad(ErrorCode::bad_expression, "this command takes no arguments; remove " + text::inQuotes(rest));
    return Command{C{}};
}

// A command of the ':' line: its name, and the function that parses the rest of the line.
struct Verb {
    std::string_view name;
    Result<Command> (*read)(std::string_view rest, const Words& words, const State& state);
};
constexpr auto kVerbs = std::to_array<Verb>(
    {{"polytope", polytopeLine},
     {"set", setLine},
     {"rotate", rotateLine},
     {"toward", towardLine},
     {"view", [](std::string_view rest, const Words&, const State&) { return oneSetting("view", rest); }},
     {"focus", [](std::string_view rest, const Words&, const State&) { return oneSetting("focus", rest); }},
     {"color", [](std::string_view rest, const Words&, const State&) { return oneSetting("color", rest); }},
     {"project", [](std::string_view rest, const Words&, const State&) { return oneSetting("projection", rest); }},
     {"highlight", highlightLine},
     {"hide", cellTypesLine<hide>},
     {"fade", cellTypesLine<fade>},
     {"show", cellTypesLine<reveal>},
     {"formula", formulaLine},
     {"fog", [](std::string_view rest, const Words&, const State&) { return oneSetting("fog", rest); }},
     {"follow", [](std::string_view rest, const Words&, const State&) { return oneSetting("follow", rest); }},
     {"boost", boostLine},
     {"key", keyLine},
     {"reset", noArguments<Reset>},
     {"undo", noArguments<Undo>},
     {"redo", noArguments<Redo>}});

}  // namespace

std::string settingNames() { return text::commaSeparated(names()); }

Result<slicing::ElementKind> parseElementKind(std::string_view text) {
    const auto kind = text::valueNamed(slicing::kElementKinds, text);
    if (kind) return *kind;
    return bad(ErrorCode::bad_expression, "an element is " + text::alternatives(text::namesOf(slicing::kElementKinds)) +
                                              ", not " + text::inQuotes(text));
}

Result<std::size_t> parseElementIndex(std::string_view text) {
    std::uint32_t index = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (error == std::errc{} && end == text.data() + text.size()) return std::size_t{index};
    return bad(ErrorCode::bad_expression,
               "the number of an element must be a whole number from 0, not " + text::inQuotes(text));
}

Result<std::monostate> parseSetting(std::string_view name, std::string_view value, Set& set) {
    for (const Setting& setting : kSettings) {
        if (setting.name == name) return std::visit(ValueReader{set, name, value}, setting.member);
    }
    for (std::size_t i = 0; i < scene::kParts.size(); ++i) {
        if (scene::kParts[i].name == name) return ValueReader{set, name, value}.readFlag(set.parts[i]);
    }
    return bad(ErrorCode::unknown_command, "no setting is called " + text::inQuotes(name) +
                                               text::didYouMean(name, names()) + "; the settings are " +
                                               settingNames());
}

Result<Command> parseCommandLine(std::string_view line, const State& state) {
    const auto trim = [&line] {
        const std::size_t first = line.find_first_not_of(" \t\r\n");
        line = first == std::string_view::npos ? std::string_view{}
                                               : line.substr(first, line.find_last_not_of(" \t\r\n") - first + 1);
    };
    trim();
    if (line.starts_with(':')) line.remove_prefix(1);
    trim();
    std::vector<std::string_view> verbs;
    for (const Verb& verb : kVerbs) verbs.push_back(verb.name);
    if (line.empty()) return bad(ErrorCode::unknown_command, "a command is expected: " + text::commaSeparated(verbs));

    const std::size_t end = line.find_first_of(" \t");
    const std::string_view name = line.substr(0, end);
    std::string_view rest = end == std::string_view::npos ? std::string_view{} : line.substr(end);
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    for (const Verb& verb : kVerbs) {
        if (verb.name == name) return verb.read(rest, split(rest), state);
    }
    return bad(ErrorCode::unknown_command, "no command is called " + text::inQuotes(name) +
                                               text::didYouMean(name, verbs) + "; the commands are " +
                                               text::commaSeparated(verbs));
}

}  // namespace oval4d::session
