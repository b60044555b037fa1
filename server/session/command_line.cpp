#include "session/command_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "protocol/cpp/suggest.hpp"
#include "session/expression.hpp"
#include "session/kinds.hpp"
#include "session/session.hpp"

namespace oval4d::session {

namespace {

using protocol::Command;
using protocol::Error;
using protocol::ErrorCode;
using protocol::inQuotes;
using protocol::Result;
using protocol::Set;
using Words = std::vector<std::string_view>;

// One row of the table of settings: its name, and the member of Set that it fills.
using Member = std::variant<std::optional<double> Set::*, std::optional<int> Set::*, std::optional<bool> Set::*,
                            std::optional<std::string> Set::*, std::optional<scene::View> Set::*,
                            std::optional<scene::Colouring> Set::*, std::optional<KindList> Set::*>;
struct Setting {
    std::string_view name;
    Member member;
};
const auto kSettings = std::to_array<Setting>({{"polytope", &Set::polytope},
                                               {"alpha", &Set::alpha},
                                               {"beta", &Set::beta},
                                               {"step", &Set::step},
                                               {"slices", &Set::count},
                                               {"spacing", &Set::spacing},
                                               {"focus", &Set::focus},
                                               {"view", &Set::view},
                                               {"turning", &Set::turning},
                                               {"faces", &Set::faces},
                                               {"bars", &Set::bars},
                                               {"balls", &Set::balls},
                                               {"coordinates", &Set::coordinates},
                                               {"azimuth", &Set::azimuth},
                                               {"elevation", &Set::elevation},
                                               {"zoom", &Set::zoom},
                                               {"color", &Set::colouring},
                                               {"hidden", &Set::hidden},
                                               {"faded", &Set::faded}});

std::vector<std::string_view> names() {
    std::vector<std::string_view> all;
    for (const Setting& setting : kSettings) all.push_back(setting.name);
    return all;
}

Error bad(ErrorCode code, std::string message) { return {code, std::move(message)}; }

// Reads a value for the member that `set` and `name` stand for.
struct ValueReader {
    Set& set;
    std::string_view name, text;

    Result<std::monostate> operator()(std::optional<double> Set::* member) const {
        const auto value = evaluate(text);
        if (!value) return bad(value.error().code, std::string(name) + ": " + value.error().message);
        set.*member = *value;
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<int> Set::* member) const {
        const auto value = evaluate(text);
        if (!value) return bad(value.error().code, std::string(name) + ": " + value.error().message);
        constexpr double kMost = 1'000'000'000;
        if (*value != std::trunc(*value) || std::abs(*value) > kMost) {
            return bad(ErrorCode::out_of_range, std::string(name) + " must be a whole number, not " + inQuotes(text));
        }
        set.*member = static_cast<int>(*value);
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<bool> Set::* member) const {
        const bool yes = text == "on" || text == "true" || text == "yes" || text == "1";
        const bool no = text == "off" || text == "false" || text == "no" || text == "0";
        if (!yes && !no)
            return bad(ErrorCode::bad_expression, std::string(name) + " must be on or off, not " + inQuotes(text));
        set.*member = yes;
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<std::string> Set::* member) const {
        if (text.empty()) return bad(ErrorCode::bad_expression, std::string(name) + " must be a name");
        set.*member = std::string(text);
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<scene::View> Set::* member) const {
        if (text != "oval" && text != "single") {
            return bad(ErrorCode::bad_expression, std::string(name) + " must be oval or single, not " + inQuotes(text));
        }
        set.*member = text == "single" ? scene::View::single : scene::View::oval;
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<scene::Colouring> Set::* member) const {
        set.*member = protocol::colouringNamed(text);
        if (set.*member) return std::monostate{};
        return bad(ErrorCode::bad_expression,
                   std::string(name) + " must be cell, kind, w or plain, not " + inQuotes(text));
    }
    Result<std::monostate> operator()(std::optional<KindList> Set::* member) const {
        auto kinds = readKinds(text);
        if (!kinds) return bad(kinds.error().code, std::string(name) + ": " + kinds.error().message);
        set.*member = std::move(*kinds);
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
    if (auto done = putSetting(name, value, set); !done) return done.error();
    return Command{set};
}

Result<Command> polytopeLine(std::string_view rest, const Words& /*words*/, const State& /*state*/) {
    if (rest.empty()) return bad(ErrorCode::unknown_polytope, "polytope needs a name, such as polytope 24-cell");
    return oneSetting("polytope", rest);  // a name may have blanks
}

Result<Command> setLine(std::string_view rest, const Words& words, const State& /*state*/) {
    if (words.empty()) return bad(ErrorCode::unknown_command, "set needs name=value; the names are " + settingNames());
    // A polytope's name may have blanks; set alone it is the rest of the line.
    if (rest.starts_with("polytope=") && rest.find('=') == rest.rfind('='))
        return oneSetting("polytope", rest.substr(std::string_view("polytope=").size()));
    Set set;
    for (const std::string_view word : words) {
        const std::size_t equals = word.find('=');
        if (equals == std::string_view::npos) {
            return bad(ErrorCode::bad_expression,
                       inQuotes(word) + " has no '='; write set name=value, without blanks, such as set slices=31");
        }
        if (auto done = putSetting(word.substr(0, equals), word.substr(equals + 1), set); !done) return done.error();
    }
    return Command{set};
}

Result<Command> rotateLine(std::string_view /*rest*/, const Words& words, const State& state) {
    if (words.empty())
        return bad(ErrorCode::bad_expression, "rotate needs planes and angles, such as rotate xw,yz pi/8 pi/5");
    // Without angles: by those of the keys.
    const std::string alpha = protocol::shortest(state.alpha);
    const std::string beta = protocol::shortest(state.beta);
    Words angles(words.begin() + 1, words.end());
    if (angles.empty()) {
        angles.emplace_back(alpha);
        if (words[0].find(',') != std::string_view::npos) angles.emplace_back(beta);
    }
    const auto turn = makeTurn(words[0], angles);
    if (!turn) return turn.error();
    return Command{protocol::Rotate{*turn}};
}

Result<Command> keyLine(std::string_view rest, const Words& words, const State& /*state*/) {
    constexpr std::string_view kCtrl = "ctrl-";
    if (words.size() != 1) return bad(ErrorCode::unknown_key, "key needs one key, such as key y, key Y or key ctrl-r");
    protocol::Key key{std::string(rest), false, false};
    if (rest == "space") key.key = " ";
    if ((rest.starts_with(kCtrl) || rest.starts_with("Ctrl-")) && rest.size() > kCtrl.size()) {
        key.key = rest.substr(kCtrl.size());
        key.ctrl = true;
    }
    return Command{key};
}

// hide, fade or show, with numbers or one name of kinds of cells.
template <scene::Kinds (*change)(scene::Kinds, const KindList&)>
Result<Command> kindsLine(std::string_view rest, const Words& /*words*/, const State& state) {
    Set set;
    scene::Kinds kinds;
    if (change != reveal || !rest.empty()) {
        const auto named = findKinds(rest, *state.polytope);
        if (!named) return named.error();
        kinds = change(state.look.kinds, *named);
    }
    set.hidden = std::move(kinds.hidden);
    set.faded = std::move(kinds.faded);
    return Command{set};
}

template <typename C>
Result<Command> plain(std::string_view rest, const Words& /*words*/, const State& /*state*/) {
    if (!rest.empty()) return bad(ErrorCode::bad_expression, "nothing may follow here, not " + inQuotes(rest));
    return Command{C{}};
}

struct Verb {
    std::string_view name;
    Result<Command> (*read)(std::string_view rest, const Words& words, const State& state);
};
constexpr auto kVerbs = std::to_array<Verb>(
    {{"polytope", polytopeLine},
     {"set", setLine},
     {"rotate", rotateLine},
     {"view", [](std::string_view rest, const Words&, const State&) { return oneSetting("view", rest); }},
     {"focus", [](std::string_view rest, const Words&, const State&) { return oneSetting("focus", rest); }},
     {"color", [](std::string_view rest, const Words&, const State&) { return oneSetting("color", rest); }},
     {"hide", kindsLine<hide>},
     {"fade", kindsLine<fade>},
     {"show", kindsLine<reveal>},
     {"key", keyLine},
     {"reset", plain<protocol::Reset>},
     {"undo", plain<protocol::Undo>},
     {"redo", plain<protocol::Redo>}});

}  // namespace

std::string settingNames() { return protocol::listed(names()); }

Result<std::monostate> putSetting(std::string_view name, std::string_view value, Set& set) {
    for (const Setting& setting : kSettings) {
        if (setting.name == name) return std::visit(ValueReader{set, name, value}, setting.member);
    }
    return bad(ErrorCode::unknown_command, "no setting is called " + inQuotes(name) +
                                               protocol::didYouMean(name, names()) + "; the settings are " +
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
    if (line.empty()) return bad(ErrorCode::unknown_command, "a command is expected: " + protocol::listed(verbs));

    const std::size_t end = line.find_first_of(" \t");
    const std::string_view name = line.substr(0, end);
    std::string_view rest = end == std::string_view::npos ? std::string_view{} : line.substr(end);
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    for (const Verb& verb : kVerbs) {
        if (verb.name == name) return verb.read(rest, split(rest), state);
    }
    return bad(ErrorCode::unknown_command, "no command is called " + inQuotes(name) +
                                               protocol::didYouMean(name, verbs) + "; the commands are " +
                                               protocol::listed(verbs));
}

}  // namespace oval4d::session
