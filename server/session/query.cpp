#include "session/query.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "fields/field.hpp"
#include "geometry/rotation.hpp"
#include "session/example_fields.hpp"
#include "session/expression.hpp"
#include "session/load.hpp"
#include "session/setting_text.hpp"
#include "session/settings.hpp"
#include "slicing/object.hpp"
#include "text/message_text.hpp"
#include "text/words.hpp"

namespace oval4d::session {

namespace {

// Returns the query parameters that say which object is shown. Error: `unknown_polytope` if an address cannot contain
// the object.
Result<QueryParameters> objectParameters(const slicing::Object& object) {
    const geometry::ObjectInfo& info = slicing::infoOf(object);
    const fields::Field* const field = slicing::fieldIn(object);
    const ExampleField* const example = exampleNamed(info.name);
    if (info.rebuildableFromName || (example != nullptr && example->field.get() == field))
        return QueryParameters{{"polytope", info.name}};
    if (field == nullptr || field->formula.empty() || (field->second && field->second->formula.empty())) {
        return Error{
            ErrorCode::unknown_polytope,
            "an address cannot contain " + text::inQuotes(info.name) +
                ", which was read from a file: share the session, or save a picture, which contains the state"};
    }
    std::vector<double> ends;
    for (int axis = 0; axis < 4; ++axis) {
        ends.push_back(field->box.min[axis]);
        ends.push_back(field->box.max[axis]);
    }
    QueryParameters parameters{{std::string(kFormula), field->formula}, {"box", numberListText(ends)}};
    if (field->second) parameters.emplace_back("values", field->second->formula);
    return parameters;
}

// Returns the rotation from the initial orientation as text, such as "xy,zw:0.1,0.2"; an empty string for no rotation.
std::string rotationText(const geometry::Rotation& orientation) {
    const geometry::RotationAngles smallestAngles = orientation.smallestAngles();
    std::string planes;
    std::vector<double> angles;
    for (const geometry::Plane plane : smallestAngles.planes()) {
        planes += (planes.empty() ? "" : ",") + std::string(geometry::planeName(plane));
        angles.push_back(*smallestAngles[plane]);
    }
    return planes.empty() ? "" : planes + ":" + numberListText(angles);
}

// Parses `Count` numbers or expressions, separated by commas. Error messages call the parameter `name` and describe its
// value with `form`.
template <std::size_t Count>
Result<std::array<double, Count>> parseNumbers(std::string_view name, std::string_view form, std::string_view text) {
    std::array<double, Count> numbers{};
    std::string_view rest = text;
    for (std::size_t i = 0; i < Count; ++i) {
        const std::size_t comma = rest.find(',');
        if ((comma == std::string_view::npos) != (i + 1 == Count)) {
            return Error{ErrorCode::bad_expression,
                         std::string(name) + " must be " + std::string(form) + ", not " + text::inQuotes(text)};
        }
        const auto value = evaluateNumber(rest.substr(0, comma));
        if (!value) return Error{value.error().code, std::string(name) + ": " + value.error().message};
        numbers.at(i) = *value;
        rest.remove_prefix(std::min(comma, rest.size() - 1) + 1);
    }
    return numbers;
}

// Returns the error for a name that stateFromQuery() does not accept. The name may be unknown, may be one of `others`
// (as in stateFromQuery()), or may be allowed only in the queries of pictures or of files.
Error unknownNameError(std::string_view name, std::span<const std::string_view> others) {
    const auto isIn = [&](std::span<const std::string_view> names) {
        return std::ranges::find(names, name) != names.end();
    };
    if (isIn(others)) return {ErrorCode::unknown_command, std::string(name) + " does not apply to this object"};
    const auto refused = [&](std::string_view use) {
        return Error{ErrorCode::unknown_command, std::string(name) + " is a parameter of " + std::string(use)};
    };
    if (isIn(kPictureParameters)) return refused("pictures, which are measured in pixels, and not of files");
    if (isIn(kFileParameters)) return refused("files, and not of pictures");
    std::vector<std::string_view> all{"rotate", "toward", kField, "formula", "values", "box"};
    all.insert(all.end(), others.begin(), others.end());
    return unknownSettingError(name, all);
}

}  // namespace

Result<fields::Box> parseBox(std::string_view text, std::string_view name) {
    const auto ends =
        parseNumbers<8>(name, "eight numbers, the ranges of x, y, z and w, such as -1,1,-1,1,-1,1,0,2", text);
    if (!ends) return ends.error();
    fields::Box box;
    for (std::size_t i = 0; i < ends->size(); ++i)
        (i % 2 == 0 ? box.min : box.max)[static_cast<int>(i / 2)] = ends->at(i);
    return box;
}

Result<geometry::Centering> parseCentering(std::string_view written) {
    const std::string_view text = text::trimmed(written);
    using OriginChoice = geometry::Centering::OriginChoice;
    if (text == "object") return geometry::Centering{OriginChoice::object};
    if (text == "origin") return geometry::Centering{OriginChoice::origin};
    const auto place = parseNumbers<4>("center", "object, origin or four numbers x,y,z,w, such as 0,0,0,2", text);
    if (!place) return place.error();
    return geometry::Centering{OriginChoice::point, {(*place)[0], (*place)[1], (*place)[2], (*place)[3]}};
}

Result<State> stateFromQuery(const QueryParameters& query, const Limits& limits, ObjectLoader& loader, State state,
                             std::span<const std::string_view> others) {
    // Apply all settings together, so that the order of a count and a spacing in the query does not matter.
    ChangeSettings set;
    std::vector<geometry::RotationAngles> turns;
    std::optional<TurnToward> toward;
    LoadObject field{std::string(kFormula), std::string(kFormula), {}};
    for (const auto& [name, written] : query) {
        const std::string value = text::withPlainBlanks(written);
        if (name == "rotate") {
            const auto turn = parseTurn(value);
            if (!turn) return turn.error();
            if (auto valid = checkTurn(*turn); !valid) return valid.error();
            turns.push_back(*turn);
        } else if (name == "formula") {
            field.data = value;
        } else if (name == "values") {
            field.secondFormula = value;
        } else if (name == "box") {
            const auto box = parseBox(value);
            if (!box) return box.error();
            field.box = *box;
        } else if (name == "toward") {
            const std::string_view element = value;
            const std::size_t colon = std::min(element.find(':'), element.size());
            const auto kind = parseElementKind(element.substr(0, colon));
            if (!kind) return kind.error();
            toward = TurnToward{*kind, {}, true};
            if (colon < element.size()) {
                const auto index = parseElementIndex(element.substr(colon + 1));
                if (!index) return index.error();
                toward->number = *index;
            }
        } else if (auto done = parseSetting(name == kField ? kPolytope : std::string_view(name), value, set); !done) {
            return done.error().code == ErrorCode::unknown_command ? unknownNameError(name, others) : done.error();
        }
    }
    const auto has = [&](std::string_view wanted) {
        return std::ranges::any_of(query, [&](const auto& pair) { return pair.first == wanted; });
    };
    for (const std::string_view name : {"box", "values"}) {
        if (has(name) && !has("formula"))
            return Error{ErrorCode::bad_expression, std::string(name) + " needs a formula"};
    }
    if (has("formula")) {
        if (set.object)
            return Error{ErrorCode::bad_expression, "a formula and another object cannot be shown at the same time"};
        auto made = readFormula(field);
        if (!made) return made.error();
        if (auto done = replaceObject(state, std::move(made->object), loader); !done) return done.error();
    }
    for (const geometry::RotationAngles& turn : turns) rotate(state, turn);
    if (auto done = applySet(state, set, {}, limits, loader); !done) return done.error();
    if (toward) {
        if (auto done = turnToward(state, *toward); !done) return done.error();
    }
    return state;
}

Result<QueryParameters> queryFromState(const State& state, ObjectLoader& loader) {
    auto query = objectParameters(state.source);
    if (!query) return query;
    if (const std::string rotation = rotationText(state.orientation); !rotation.empty())
        query->emplace_back("rotate", rotation);
    State fresh = initialState();
    if (auto done = replaceObject(fresh, state.source, loader); !done) return done.error();
    // If a query contains the number of slices or the frame of reference, stateFromQuery() adapts the spacing to it. So
    // such a query must contain the spacing, even if this is the initial one.
    const bool isSpaced = state.slices.count == fresh.slices.count && state.referenceFrame == fresh.referenceFrame;
    const QueryParameters initial = settingTexts(settingsOf(fresh));
    for (auto& setting : settingTexts(settingsOf(state))) {
        const bool isSamePoint = setting.first == "point" && state.look.focusPoint == fresh.look.focusPoint;
        const bool isInitial = isSamePoint || std::ranges::find(initial, setting) != initial.end();
        if (!isInitial || (setting.first == "spacing" && !isSpaced)) query->push_back(std::move(setting));
    }
    return query;
}

}  // namespace oval4d::session
