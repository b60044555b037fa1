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
#include "session/setting_table.hpp"
#include "text/message_text.hpp"
#include "text/words.hpp"

namespace oval4d::session {

namespace {

std::vector<std::string_view> collectSettingNames() {
    std::vector<std::string_view> all{kPolytope};
    forEachSetting([&](const auto& setting) { all.push_back(setting.name.text); });
    return all;
}

Error makeError(ErrorCode code, std::string message) { return {code, std::move(message)}; }

// A visitor that parses `text` as the value of the setting `name`, for each type of values.
struct SettingValueParser {
    std::string_view name, text;
    bool isAngle = false;  // whether the value is an angle, which may have a unit

    Result<std::monostate> operator()(std::optional<double>& into) const {
        const auto value = isAngle ? evaluateAngle(text) : evaluateNumber(text);
        if (!value) return makeError(value.error().code, std::string(name) + ": " + value.error().message);
        into = *value;
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<int>& into) const {
        const auto value = evaluateNumber(text);
        if (!value) return makeError(value.error().code, std::string(name) + ": " + value.error().message);
        constexpr double kMaxMagnitude = 1'000'000'000;
        if (*value != std::trunc(*value) || std::abs(*value) > kMaxMagnitude) {
            return makeError(ErrorCode::out_of_range,
                             std::string(name) + " must be a whole number, not " + text::inQuotes(text));
        }
        into = static_cast<int>(*value);
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<bool>& into) const {
        const bool yes = text == "on" || text == "true" || text == "yes" || text == "1";
        const bool no = text == "off" || text == "false" || text == "no" || text == "0";
        if (!yes && !no)
            return makeError(ErrorCode::bad_expression,
                             std::string(name) + " must be on or off, not " + text::inQuotes(text));
        into = yes;
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<glm::dvec4>& into) const {
        return readVector(4, "four numbers x,y,z,w without blanks, such as 0.1,0,-0.2,0", into);
    }
    Result<std::monostate> operator()(std::optional<glm::dvec3>& into) const {
        if (text == "none") {
            into = glm::dvec3(0);
            return std::monostate{};
        }
        return readVector(3, "none or a velocity x,y,z without blanks, such as 0.3,0,0", into);
    }
    template <typename Vector>
    Result<std::monostate> readVector(std::ptrdiff_t size, std::string_view form, std::optional<Vector>& into) const {
        if (std::ranges::count(text, ',') != size - 1) {
            return makeError(ErrorCode::bad_expression,
                             std::string(name) + " must be " + std::string(form) + ", not " + text::inQuotes(text));
        }
        const auto list = readNumbers();
        if (!list) return list.error();
        for (int axis = 0; axis < size; ++axis) into.emplace(into.value_or(Vector(0)))[axis] = (*list)[axis];
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<std::string>& into) const {
        if (text.empty()) return makeError(ErrorCode::bad_expression, std::string(name) + " must be a name");
        into = std::string(text);
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<std::vector<double>>& into) const {
        auto list = readNumbers();
        if (!list) return list.error();
        into = std::move(*list);
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<std::vector<slicing::FogControlPoint>>& into) const {
        std::vector<slicing::FogControlPoint>& points = into.emplace();
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
    Result<slicing::FogControlPoint> readFogPoint(std::string_view word) const {
        const std::size_t first = word.find(':');
        const std::size_t second = first == std::string_view::npos ? first : word.find(':', first + 1);
        const auto malformed = [&] {
            return makeError(
                ErrorCode::bad_expression,
                std::string(name) +
                    " must be off, or points value:opacity or value:opacity:RRGGBB without blanks, such as "
                    "0:0.8,1:0.2:ff8800,2:0, not " +
                    text::inQuotes(text));
        };
        if (first == std::string_view::npos) return malformed();
        slicing::FogControlPoint point;
        const std::string_view opacity =
            word.substr(first + 1, second == std::string_view::npos ? second : second - first - 1);
        for (const auto& [part, into] : {std::pair(word.substr(0, first), &point.value), {opacity, &point.opacity}}) {
            const auto value = evaluateNumber(part);
            if (!value) return makeError(value.error().code, std::string(name) + ": " + value.error().message);
            *into = *value;
        }
        if (second == std::string_view::npos) return point;
        constexpr std::size_t kDigits = 6;
        const std::string_view color = oval4d::text::trimmed(word.substr(second + 1));
        const auto [end, error] = std::from_chars(color.data(), color.data() + color.size(), point.color.emplace(), 16);
        if (error != std::errc{} || end != color.data() + color.size() || color.size() != kDigits) return malformed();
        return point;
    }
    Result<std::vector<double>> readNumbers() const {
        auto list = evaluateList(text);
        if (!list) return makeError(list.error().code, std::string(name) + ": " + list.error().message);
        return list;
    }
    template <oval4d::text::HasChoices Enum>
    Result<std::monostate> operator()(std::optional<Enum>& into) const {
        const auto& choices = choicesOf(Enum{});
        into = oval4d::text::valueNamed(choices, text);
        if (into) return std::monostate{};
        return makeError(ErrorCode::bad_expression, std::string(name) + " must be " +
                                                        oval4d::text::joinedWithOr(oval4d::text::namesOf(choices)) +
                                                        ", not " + oval4d::text::inQuotes(text));
    }
    Result<std::monostate> operator()(std::optional<std::optional<slicing::Element>>& into) const {
        if (text == "none") {
            into.emplace();
            return std::monostate{};
        }
        const std::size_t colon = text.find(':');
        if (colon == std::string_view::npos) {
            return makeError(
                ErrorCode::bad_expression,
                std::string(name) + " must be none or an element such as cell:17, not " + oval4d::text::inQuotes(text));
        }
        const auto kind = parseElementKind(text.substr(0, colon));
        if (!kind) return kind.error();
        const auto index = parseElementIndex(text.substr(colon + 1));
        if (!index) return index.error();
        into.emplace(slicing::Element{*kind, *index});
        return std::monostate{};
    }
    Result<std::monostate> operator()(std::optional<CellTypeList>& into) const {
        auto types = parseCellTypes(text);
        if (!types) return makeError(types.error().code, std::string(name) + ": " + types.error().message);
        into = std::move(*types);
        return std::monostate{};
    }
};

template <typename Range, typename Function>
std::string joinedByCommas(const Range& range, Function&& textOf) {
    std::string text;
    for (const auto& each : range) {
        if (!text.empty()) text += ',';
        text += textOf(each);
    }
    return text;
}

// A visitor that returns the text of a value, in the form that SettingValueParser reads.
struct SettingValueFormatter {
    bool isAngle = false;

    std::string operator()(double value) const { return text::shortestDecimal(value) + (isAngle ? "rad" : ""); }
    std::string operator()(int value) const { return std::to_string(value); }
    std::string operator()(bool value) const { return value ? "on" : "off"; }
    std::string operator()(const std::string& name) const { return name; }
    std::string operator()(const glm::dvec4& v) const { return numberListText(std::array{v.x, v.y, v.z, v.w}); }
    std::string operator()(const glm::dvec3& v) const { return numberListText(std::array{v.x, v.y, v.z}); }
    std::string operator()(const std::vector<double>& numbers) const { return numberListText(numbers); }
    std::string operator()(const std::vector<slicing::FogControlPoint>& points) const {
        return points.empty() ? "off" : joinedByCommas(points, fogPoint);
    }
    std::string operator()(const CellTypeList& types) const {
        return types.empty() ? "none" : joinedByCommas(types, [](std::uint32_t type) { return std::to_string(type); });
    }
    std::string operator()(const std::optional<slicing::Element>& element) const {
        if (!element) return "none";
        return (*this)(element->kind) + ':' + std::to_string(element->index);
    }
    template <text::HasChoices Enum>
    std::string operator()(Enum value) const {
        return std::string(text::nameOf(choicesOf(value), value));
    }

    static std::string fogPoint(const slicing::FogControlPoint& point) {
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

Result<std::monostate> parseSetting(std::string_view name, std::string_view written, ChangeSettings& set) {
    if (name == kPolytope) return SettingValueParser{name, written}(set.object);
    const std::string_view given = text::trimmed(written);
    // Users call the view `strip` "row", as its key does. "row" is no alias in kViews, because tables of stored
    // enumerators must not have aliases (see text::hasNoAliases()).
    const std::string_view value = name == "view" && given == "row" ? "strip" : given;
    std::optional<Result<std::monostate>> parsed;
    forEachSetting([&](const auto& setting) {
        if (setting.name.text == name) parsed = SettingValueParser{name, value, setting.isAngle()}(setting.ofSet(set));
    });
    if (parsed) return *parsed;
    return unknownSettingError(name);
}

Error unknownSettingError(std::string_view name, std::span<const std::string_view> others) {
    std::vector<std::string_view> all = collectSettingNames();
    all.insert(all.end(), others.begin(), others.end());
    return makeError(ErrorCode::unknown_command, "no setting is called " + text::inQuotes(name) +
                                                     text::didYouMean(name, all) + "; the settings are " +
                                                     text::commaSeparated(all));
}

QueryParameters settingTexts(const ChangeSettings& set) {
    QueryParameters texts;
    if (set.object) texts.emplace_back(kPolytope, *set.object);
    forEachSetting([&](const auto& setting) {
        if (const auto& value = setting.ofSet(set))
            texts.emplace_back(setting.name.text, SettingValueFormatter{setting.isAngle()}(*value));
    });
    return texts;
}

std::string settingNames() { return text::commaSeparated(collectSettingNames()); }

std::string numberListText(std::span<const double> numbers) { return joinedByCommas(numbers, text::shortestDecimal); }

Result<slicing::ElementKind> parseElementKind(std::string_view written) {
    const std::string_view text = text::trimmed(written);
    const auto kind = text::valueNamed(slicing::kElementKinds, text);
    if (kind) return *kind;
    return makeError(
        ErrorCode::bad_expression,
        "an element is " + text::joinedWithOr(text::namesOf(slicing::kElementKinds)) + ", not " + text::inQuotes(text));
}

Result<std::size_t> parseElementIndex(std::string_view written) {
    const std::string_view text = text::trimmed(written);
    std::uint32_t index = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (error == std::errc{} && end == text.data() + text.size()) return std::size_t{index};
    return makeError(ErrorCode::bad_expression,
                     "the number of an element must be a whole number from 0, not " + text::inQuotes(text));
}

}  // namespace oval4d::session
