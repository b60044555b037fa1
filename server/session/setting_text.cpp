#include "session/setting_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "session/cell_types.hpp"
#include "session/expression.hpp"
#include "text/message_text.hpp"

namespace oval4d::session {

namespace {

// A pointer to a member of Set.
using Member = std::variant<std::optional<double> Set::*, std::optional<int> Set::*, std::optional<bool> Set::*,
                            std::optional<std::string> Set::*, std::optional<scene::View> Set::*,
                            std::optional<scene::Coloring> Set::*, std::optional<scene::ProjectionKind> Set::*,
                            std::optional<CellTypeList> Set::*, std::optional<std::optional<slicing::Element>> Set::*,
                            std::optional<glm::dvec4> Set::*, std::optional<glm::dvec3> Set::*,
                            std::optional<std::vector<double>> Set::*, std::optional<fields::Inside> Set::*,
                            std::optional<scene::CapStyle> Set::*, std::optional<scene::Background> Set::*,
                            std::optional<std::vector<slicing::FogPoint>> Set::*>;
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
                                               {"background", &Set::background},
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

Error refusal(ErrorCode code, std::string message) { return {code, std::move(message)}; }

bool isAngle(std::optional<double> Set::* member) {
    constexpr auto kAngles = std::to_array({&Set::alpha, &Set::beta, &Set::step, &Set::azimuth, &Set::elevation});
    return std::ranges::find(kAngles, member) != kAngles.end();
}

// Parses `text` as the value of the setting `name`, and stores it in a member of `set`.
struct ValueReader {
    Set& set;
    std::string_view name, text;

    Result<std::monostate> operator()(std::optional<double> Set::* member) const {
        const auto value = isAngle(member) ? evaluateAngle(text) : evaluate(text);
        if (!value) return refusal(value.error().code, std::string(name) + ": " + value.error().message);
        set.*member = *value;
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<int> Set::* member) const {
        const auto value = evaluate(text);
        if (!value) return refusal(value.error().code, std::string(name) + ": " + value.error().message);
        constexpr double kMaxMagnitude = 1'000'000'000;
        if (*value != std::trunc(*value) || std::abs(*value) > kMaxMagnitude) {
            return refusal(ErrorCode::out_of_range,
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
            return refusal(ErrorCode::bad_expression,
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
            return refusal(ErrorCode::bad_expression,
                           std::string(name) + " must be " + std::string(form) + ", not " + text::inQuotes(text));
        }
        const auto list = readNumbers();
        if (!list) return list.error();
        for (int axis = 0; axis < size; ++axis) into.emplace(into.value_or(Vector(0)))[axis] = (*list)[axis];
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<std::string> Set::* member) const {
        if (text.empty()) return refusal(ErrorCode::bad_expression, std::string(name) + " must be a name");
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
            return refusal(ErrorCode::bad_expression,
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
            if (!value) return refusal(value.error().code, std::string(name) + ": " + value.error().message);
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
        auto list = evaluateList(text);
        if (!list) return refusal(list.error().code, std::string(name) + ": " + list.error().message);
        return list;
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
    Result<std::monostate> operator()(std::optional<scene::Background> Set::* member) const {
        return choose(scene::kBackgrounds, set.*member);
    }
    Result<std::monostate> operator()(std::optional<scene::ProjectionKind> Set::* member) const {
        return choose(scene::kProjectionKinds, set.*member);
    }
    template <typename Choices, typename Value>
    Result<std::monostate> choose(const Choices& choices, std::optional<Value>& into) const {
        into = oval4d::text::valueNamed(choices, text);
        if (into) return std::monostate{};
        return refusal(ErrorCode::bad_expression, std::string(name) + " must be " +
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
            return refusal(
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
        if (!types) return refusal(types.error().code, std::string(name) + ": " + types.error().message);
        set.*member = std::move(*types);
        return std::monostate{};
    }
};

template <typename Range, typename Function>
std::string joined(const Range& range, Function&& textOf) {
    std::string text;
    for (const auto& each : range) {
        if (!text.empty()) text += ',';
        text += textOf(each);
    }
    return text;
}

// Returns the text of a member of `set`, which must be present, as ValueReader reads it.
struct ValueWriter {
    const Set& set;

    std::string operator()(std::optional<double> Set::* member) const {
        return text::shortestDecimal(*(set.*member)) + (isAngle(member) ? "rad" : "");
    }
    std::string operator()(std::optional<int> Set::* member) const { return std::to_string(*(set.*member)); }
    std::string operator()(std::optional<bool> Set::* member) const { return flag(*(set.*member)); }
    std::string operator()(std::optional<std::string> Set::* member) const { return *(set.*member); }
    std::string operator()(std::optional<glm::dvec4> Set::* member) const {
        const glm::dvec4& v = *(set.*member);
        return numberList(std::array{v.x, v.y, v.z, v.w});
    }
    std::string operator()(std::optional<glm::dvec3> Set::* member) const {
        const glm::dvec3& v = *(set.*member);
        return numberList(std::array{v.x, v.y, v.z});
    }
    std::string operator()(std::optional<std::vector<double>> Set::* member) const {
        return numberList(*(set.*member));
    }
    std::string operator()(std::optional<std::vector<slicing::FogPoint>> Set::* member) const {
        const auto& points = *(set.*member);
        return points.empty() ? "off" : joined(points, fogPoint);
    }
    std::string operator()(std::optional<CellTypeList> Set::* member) const {
        const auto& types = *(set.*member);
        return types.empty() ? "none" : joined(types, [](std::uint32_t type) { return std::to_string(type); });
    }
    std::string operator()(std::optional<std::optional<slicing::Element>> Set::* member) const {
        const auto& element = *(set.*member);
        if (!element) return "none";
        return std::string(text::nameOf(slicing::kElementKinds, element->kind)) + ':' + std::to_string(element->index);
    }
    std::string operator()(std::optional<fields::Inside> Set::* member) const {
        return choice(fields::kInsides, set.*member);
    }
    std::string operator()(std::optional<scene::View> Set::* member) const {
        return choice(scene::kViews, set.*member);
    }
    std::string operator()(std::optional<scene::Coloring> Set::* member) const {
        return choice(scene::kColorings, set.*member);
    }
    std::string operator()(std::optional<scene::CapStyle> Set::* member) const {
        return choice(scene::kCapStyles, set.*member);
    }
    std::string operator()(std::optional<scene::Background> Set::* member) const {
        return choice(scene::kBackgrounds, set.*member);
    }
    std::string operator()(std::optional<scene::ProjectionKind> Set::* member) const {
        return choice(scene::kProjectionKinds, set.*member);
    }

    static std::string flag(bool value) { return value ? "on" : "off"; }
    template <typename Choices, typename Value>
    static std::string choice(const Choices& choices, const std::optional<Value>& value) {
        return std::string(text::nameOf(choices, *value));
    }
    static std::string fogPoint(const slicing::FogPoint& point) {
        std::string text = text::shortestDecimal(point.value) + ':' + text::shortestDecimal(point.opacity);
        if (!point.color) return text;
        constexpr std::string_view kDigits = "0123456789abcdef";
        text += ':';
        for (int shift = 20; shift >= 0; shift -= 4)
            text += kDigits[(*point.color >> static_cast<unsigned>(shift)) % 16];
        return text;
    }
};

}  // namespace

Result<std::monostate> parseSetting(std::string_view name, std::string_view value, Set& set) {
    for (const Setting& setting : kSettings) {
        if (setting.name == name) return std::visit(ValueReader{set, name, value}, setting.member);
    }
    for (std::size_t i = 0; i < scene::kParts.size(); ++i) {
        if (scene::kParts[i].name == name) return ValueReader{set, name, value}.readFlag(set.parts[i]);
    }
    return refusal(ErrorCode::unknown_command, "no setting is called " + text::inQuotes(name) +
                                                   text::didYouMean(name, names()) + "; the settings are " +
                                                   settingNames());
}

QueryParameters settingTexts(const Set& set) {
    QueryParameters texts;
    for (const Setting& setting : kSettings) {
        std::visit(
            [&](const auto& member) {
                if (set.*member) texts.emplace_back(setting.name, ValueWriter{set}(member));
            },
            setting.member);
    }
    for (std::size_t i = 0; i < scene::kParts.size(); ++i) {
        if (set.parts[i]) texts.emplace_back(scene::kParts[i].name, ValueWriter::flag(*set.parts[i]));
    }
    return texts;
}

std::string settingNames() { return text::commaSeparated(names()); }

std::string numberList(std::span<const double> numbers) { return joined(numbers, text::shortestDecimal); }

Result<slicing::ElementKind> parseElementKind(std::string_view text) {
    const auto kind = text::valueNamed(slicing::kElementKinds, text);
    if (kind) return *kind;
    return refusal(
        ErrorCode::bad_expression,
        "an element is " + text::alternatives(text::namesOf(slicing::kElementKinds)) + ", not " + text::inQuotes(text));
}

Result<std::size_t> parseElementIndex(std::string_view text) {
    std::uint32_t index = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (error == std::errc{} && end == text.data() + text.size()) return std::size_t{index};
    return refusal(ErrorCode::bad_expression,
                   "the number of an element must be a whole number from 0, not " + text::inQuotes(text));
}

}  // namespace oval4d::session
