#include "wire/parse.hpp"

#include <algorithm>
#include <array>
#include <boost/describe/members.hpp>
#include <boost/describe/modifiers.hpp>
#include <boost/mp11/algorithm.hpp>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "image/png_text.hpp"
#include "session/expression.hpp"
#include "session/load.hpp"
#include "session/setting_table.hpp"
#include "text/message_text.hpp"
#include "wire/json_parser.hpp"
#include "wire/schema.hpp"

namespace oval4d::wire {

namespace {

using nlohmann::json;

// An exception for a message with a fault that a JSON schema cannot describe.
struct InvalidRequest {
    std::string message;
    ErrorCode code = ErrorCode::bad_message;
};

template <typename T>
void readIfPresent(const json& object, std::string_view name, std::optional<T>& into) {
    if (const auto member = object.find(name); member != object.end()) into = member->get<T>();
}

geometry::RotationAngles turnFromJson(const json& object, const std::string& where) {
    const json& planes = object.at("planes");
    const json& angles = object.at("angles");
    if (planes.size() != angles.size()) {
        throw InvalidRequest{where + "/angles must hold one angle for each plane: " + std::to_string(planes.size()) +
                             ", not " + std::to_string(angles.size())};
    }
    geometry::RotationAngles turn;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const auto& name = planes[i].get_ref<const std::string&>();
        std::optional<double>& angle = turn[*geometry::planeNamed(name)];
        if (angle) throw InvalidRequest{where + "/planes must be different planes; " + name + " stands twice"};
        angle = angles[i].get<double>();
    }
    return turn;
}

std::optional<scene::Viewport> viewportOf(const json& message) {
    if (!message.contains("width") && !message.contains("height")) return {};
    scene::Viewport viewport;
    viewport.width = message.value("width", viewport.width);
    viewport.height = message.value("height", viewport.height);
    return viewport;
}

// Returns the value called `name` in a table of choices. Throws std::logic_error for a name that the schema allows but
// the table lacks, which is a bug in this program.
template <typename Choices>
auto choiceOf(const json& name, const Choices& choices) {
    const auto value = text::valueNamed(choices, name.get_ref<const std::string&>());
    if (!value) throw std::logic_error("a schema allows a name that this program does not know: " + name.dump());
    return *value;
}

template <typename Choices, typename Value>
void readChoice(const json& message, const char* member, const Choices& choices, Value& into) {
    if (const auto name = message.find(member); name != message.end()) into = choiceOf(*name, choices);
}

// Reads the value of a member or of a setting. The schema has already checked its type.
template <typename Value>
void readValue(const json& value, Value& into) {
    into = value.get<Value>();
}
template <text::HasChoices Enum>
void readValue(const json& name, Enum& into) {
    into = choiceOf(name, choicesOf(Enum{}));
}
template <glm::length_t length>
void readValue(const json& coordinates, glm::vec<length, double>& into) {
    for (int axis = 0; axis < length; ++axis) into[axis] = coordinates[axis].get<double>();
}
void readValue(const json& points, std::vector<slicing::FogControlPoint>& into) {
    for (const json& point : points) {
        into.push_back({point.at("value"), point.at("opacity")});
        readIfPresent(point, "color", into.back().color);
    }
}
void readValue(const json& element, std::optional<slicing::Element>& into) {
    if (!element.is_null())
        into = slicing::Element{choiceOf(element.at("element"), slicing::kElementKinds), element.at("number")};
}
template <typename Value>
void readValue(const json& value, std::optional<Value>& into) {
    readValue(value, into.emplace());
}

// Returns the body of a valid message. Members of the body that the message lacks keep their defaults.
template <typename T>
T parseMembers(const json& message) {
    T body;
    using Members = boost::describe::describe_members<T, boost::describe::mod_public>;
    boost::mp11::mp_for_each<Members>([&](auto member) {
        if (const auto value = message.find(member.name); value != message.end())
            readValue(*value, body.*member.pointer);
    });
    return body;
}

template <>
Hello parseMembers(const json& message) {
    Hello hello;
    readChoice(message, "stream", kStreams, hello.stream);
    readChoice(message, "encoding", kEncodings, hello.encoding);
    hello.viewport = viewportOf(message);
    readChoice(message, "scheme", scene::kSchemes, hello.scheme);
    readIfPresent(message, "token", hello.token);
    return hello;
}

fields::Box boxOf(const json& ranges) {
    fields::Box box;
    for (int axis = 0; axis < 4; ++axis) {
        box.min[axis] = ranges[axis][0].get<double>();
        box.max[axis] = ranges[axis][1].get<double>();
    }
    return box;
}

/// Returns the command that makes a field from its formula. `field` is the member `field` of a `state` message, and
/// `name` the name of the field. Returns an empty optional if the field is an array.
std::optional<session::LoadObject> formulaOf(const json& field, const std::string& name) {
    if (!field.contains("formula")) return {};
    session::LoadObject load{name, std::string(session::kFormula), field["formula"]};
    load.box = boxOf(field.at("box"));
    if (const auto values = field.find("values"); values != field.end())
        load.secondFormula = values->value("formula", "");
    return load;
}

/// Returns the value of a setting in a `set` message, or nullptr if the message lacks the setting.
const json* settingValueIn(const json& message, const session::SettingName& name) {
    const json* object = &message;
    if (!name.object.empty()) {
        const auto found = message.find(name.object);
        if (found == message.end()) return nullptr;
        object = &*found;
    }
    const auto member = object->find(name.member);
    return member == object->end() ? nullptr : &*member;
}

template <>
session::ChangeSettings parseMembers(const json& message) {
    session::ChangeSettings set;
    set.continues = message.value("continues", false);
    if (const auto polytope = message.find("polytope"); polytope != message.end()) {
        set.object = polytope->is_object() ? polytope->at("name").get<std::string>() : polytope->get<std::string>();
        if (const auto field = message.find("field"); field != message.end())
            set.formula = formulaOf(*field, *set.object);
    }
    if (const auto rows = message.find("orientation"); rows != message.end()) {
        set.orientation.emplace();
        for (int row = 0; row < 4; ++row) {
            for (int column = 0; column < 4; ++column)
                (*set.orientation)[column][row] = (*rows)[row][column].get<double>();
        }
    }
    session::forEachSetting([&](const auto& setting) {
        if (const json* const value = settingValueIn(message, setting.name))
            readValue(*value, setting.ofSet(set).emplace());
    });
    if (const auto last = message.find("last"); last != message.end() && !last->is_null())
        set.lastTurn = turnFromJson(*last, "set: /last");
    return set;
}

template <>
session::Rotate parseMembers(const json& message) {
    return {turnFromJson(message, "rotate: "), message.value("continues", false)};
}

geometry::Centering centerOf(const json& center) {
    using OriginChoice = geometry::Centering::OriginChoice;
    if (center.is_array()) {
        geometry::Centering result{OriginChoice::point};
        for (int axis = 0; axis < 4; ++axis) result.place[axis] = center[axis].get<double>();
        return result;
    }
    const std::string& name = center.get_ref<const std::string&>();
    if (name != "object" && name != "origin") {
        throw InvalidRequest{"load: /center must be \"object\", \"origin\" or an array x, y, z, w, not " +
                             text::inQuotes(name)};
    }
    return {name == "object" ? OriginChoice::object : OriginChoice::origin};
}

template <>
session::LoadObject parseMembers(const json& message) {
    if (!message.contains("data") && !message.contains("path"))
        throw InvalidRequest{"load: /data is missing: the text of a file, or else /path, a name in the data folder"};
    if (message.contains("data") && message.contains("path"))
        throw InvalidRequest{"load: give either /data or /path, not both"};
    if (message.contains("data") && !message.contains("format")) throw InvalidRequest{"load: /format is missing"};
    // parseBody() sets the member `data` later.
    session::LoadObject load{message.at("name"), {}, {}, message.value("continues", false)};
    for (const auto& [name, member] : session::kLoadTexts) {
        if (const auto text = message.find(name); text != message.end()) text->get_to(load.*member);
    }
    load.dataName = message.value("path", "");
    load.append = message.value("append", false);
    if (const auto box = message.find("box"); box != message.end()) load.box = boxOf(*box);
    if (const auto region = message.find("region"); region != message.end()) load.region = boxOf(*region);
    if (const auto center = message.find("center"); center != message.end()) load.center = centerOf(*center);
    return load;
}

/// Returns the numbers in `value`: a JSON array of numbers, or a text with expressions, separated by commas. Throws
/// InvalidRequest if an expression is wrong; the error message calls the value `where`.
std::vector<double> parseNumberList(const json& value, const std::string& where) {
    if (value.is_array()) return value.get<std::vector<double>>();
    auto list = session::evaluateList(value.get_ref<const std::string&>());
    if (!list) throw InvalidRequest{where + ": " + list.error().message, list.error().code};
    return std::move(*list);
}

exports::ExportRequest exportRequestOf(const json& message) {
    if (!message.contains("format")) throw InvalidRequest{"get: a file must have a /format, such as \"stl\""};
    const std::string& format = message.at("format").get_ref<const std::string&>();
    const exports::Format* const known = exports::formatNamed(format);
    if (known == nullptr) {
        throw InvalidRequest{"get: /format must be " + text::commaSeparated(exports::formatNames()) + ", not " +
                             text::inQuotes(format)};
    }
    exports::ExportRequest request = exports::defaultRequestFor(*known);
    exports::forEachOption(request, [&]<typename Value>(std::string_view name, Value& into) {
        const auto value = message.find(name);
        if (value == message.end()) return;
        if constexpr (std::is_same_v<Value, std::vector<double>>) {
            into = parseNumberList(*value, "get: /" + std::string(name));
        } else {
            readValue(*value, into);
        }
    });
    if (!message.contains("of") && request.choosesSlices()) request.contents = exports::ExportContentsKind::oval;
    return request;
}

template <>
Get parseMembers(const json& message) {
    if (message.contains("width") != message.contains("height"))
        throw InvalidRequest{"get: give /width and /height together, or neither"};
    Get get;
    readChoice(message, "what", kGetTargets, get.what);
    get.viewport = viewportOf(message);
    readChoice(message, "background", scene::kBackgrounds, get.background);
    if (const auto highlight = message.find("highlight"); highlight != message.end())
        readValue(*highlight, get.highlight);
    const bool hasX = message.contains("x"), hasY = message.contains("y");
    if (const auto point = message.find("point"); get.what == GetTarget::at && point != message.end()) {
        if (hasX || hasY) throw InvalidRequest{"get: give either /point, or /x and /y"};
        readValue(*point, get.fieldPoint);
    } else if (get.what == GetTarget::at) {
        if (!hasX || !hasY)
            throw InvalidRequest{"get: the element at a point needs /x and /y, in pixels from the upper left corner"};
        get.point = {message.at("x").get<double>(), message.at("y").get<double>()};
    }
    if (get.what == GetTarget::file) get.file = exportRequestOf(message);
    return get;
}

using RequestBody = decltype(Request::body);

// A message type, and the function that parses valid messages of this type. The function may move strings out of the
// message.
struct RequestTypeRow {
    std::string_view name;
    RequestBody (*parse)(json& message);
};
template <typename T>
RequestBody parseBody(json& message) {
    if constexpr (std::is_same_v<T, session::LoadObject>) {
        auto load = parseMembers<session::LoadObject>(message);
        // Move the text of the file, because it may have many megabytes.
        if (const auto data = message.find("data"); data != message.end())
            load.data = std::move(data->get_ref<std::string&>());
        return session::Command{std::move(load)};
    } else if constexpr (boost::mp11::mp_contains<session::Command, T>::value) {
        return session::Command{parseMembers<T>(message)};
    } else {
        return parseMembers<T>(message);
    }
}
template <typename... T>
constexpr auto requestTypesOf(std::type_identity<std::variant<T...>> /*bodies*/) {
    return std::to_array<RequestTypeRow>({{T::kMessageType, parseBody<T>}...});
}
// mp_flatten replaces the variant session::Command in RequestBody by its alternatives, the types of commands.
constexpr auto kRequestTypes = requestTypesOf(std::type_identity<boost::mp11::mp_flatten<RequestBody>>{});

// A handler of JSON parser events that records the type and the id of a message, and builds no value.
class TypeAndIdListener : public nlohmann::json_sax<json> {
  public:
    explicit TypeAndIdListener(RequestTypeAndId& seen) : seen_(seen) {}

    bool null() override { return true; }
    bool boolean(bool /*value*/) override { return true; }
    bool number_integer(number_integer_t value) override { return number(static_cast<double>(value)); }
    bool number_unsigned(number_unsigned_t value) override { return number(static_cast<double>(value)); }
    bool number_float(number_float_t value, const string_t& /*text*/) override { return number(value); }
    bool string(string_t& value) override {
        if (depth_ == 1 && key_ == "type") seen_.type = value;
        return true;
    }
    bool binary(binary_t& /*value*/) override { return true; }
    bool start_object(std::size_t /*size*/) override { return enterContainer(); }
    bool start_array(std::size_t /*size*/) override { return enterContainer(); }
    bool end_object() override { return leave(); }
    bool end_array() override { return leave(); }
    bool key(string_t& name) override {
        if (depth_ == 1) key_ = name;
        return true;
    }
    bool parse_error(std::size_t /*position*/, const std::string& /*token*/,
                     const nlohmann::detail::exception& /*error*/) override {
        return false;
    }

  private:
    bool number(double value) {
        if (depth_ == 1 && key_ == "id") seen_.id = value;
        return true;
    }
    bool enterContainer() {
        ++depth_;
        return true;
    }
    bool leave() {
        --depth_;
        return true;
    }

    RequestTypeAndId& seen_;
    std::string key_;
    std::size_t depth_ = 0;
};

std::variant<Request, BadRequest> requestOf(ParsedJson&& read) {
    const json& message = read.value;
    const bool object = message.is_object() && (read.fault.empty() || read.repaired);
    std::optional<double> id;
    if (object) {
        if (const auto member = message.find("id"); member != message.end() && member->is_number())
            id = member->get<double>();
    }
    const auto refuse = [&](ErrorCode code, std::string text) {
        return BadRequest{id, {code, std::move(text)}, read.notJson};
    };

    if (!read.fault.empty() && !read.repaired) return refuse(ErrorCode::bad_json, std::move(read.fault));
    if (!object) return refuse(ErrorCode::bad_message, "a message must be a JSON object such as {\"type\":\"undo\"}");
    const auto type = message.find("type");
    if (type == message.end() || !type->is_string()) {
        return refuse(ErrorCode::bad_message,
                      "a message must have a member \"type\", one of " + text::commaSeparated(requestTypes()));
    }
    const std::string& name = type->get_ref<const std::string&>();
    const auto known = std::ranges::find(kRequestTypes, name, &RequestTypeRow::name);
    if (known == kRequestTypes.end()) {
        return refuse(ErrorCode::unknown_type, "no message has the type " + text::inQuotes(name) +
                                                   text::didYouMean(name, requestTypes()) +
                                                   "; allowed types: " + text::commaSeparated(requestTypes()));
    }
    if (std::optional<Error> error = validationError(name, message)) {
        if (read.repaired) error->message += " (" + read.fault + ")";
        return refuse(error->code, std::move(error->message));
    }
    if (read.repaired) return refuse(ErrorCode::bad_json, std::move(read.fault));
    try {
        return Request{id, known->parse(read.value)};
    } catch (const InvalidRequest& invalid) {
        return refuse(invalid.code, invalid.message);
    }
}

}  // namespace

std::span<const std::string_view> requestTypes() {
    static const auto names = [] {
        std::array<std::string_view, kRequestTypes.size()> all;
        std::ranges::transform(kRequestTypes, all.begin(), &RequestTypeRow::name);
        return all;
    }();
    return names;
}

std::variant<Request, BadRequest> parseRequest(std::string_view text, int maxDepth) {
    return requestOf(parseJson(text, maxDepth));
}

RequestTypeAndId peekRequest(std::string_view beginning) {
    RequestTypeAndId seen;
    TypeAndIdListener listener(seen);
    json::sax_parse(beginning.begin(), beginning.end(), &listener);
    return seen;
}

Result<session::ChangeSettings> setCommandFromState(std::string_view text) {
    constexpr int kDepth = 8;
    ParsedJson read = parseJson(text, kDepth);
    // If the text is not JSON, the value contains only what precedes the fault. The type may then be missing.
    if (read.value.is_object() && (read.fault.empty() || read.repaired)) {
        const auto type = read.value.find("type");
        if (type == read.value.end() || *type != "state") {
            return Error{ErrorCode::bad_message, "a state must be a JSON object with \"type\":\"state\""};
        }
        *type = "set";
    }
    auto request = requestOf(std::move(read));
    if (auto* bad = std::get_if<BadRequest>(&request)) return std::move(bad->error);
    return std::get<session::ChangeSettings>(std::get<session::Command>(std::get<Request>(request).body));
}

Result<session::ChangeSettings> setCommandFromFile(std::string_view file, std::size_t maxMessage) {
    const auto message = image::isPng(file) ? image::stateTextIn(file) : file;
    if (!message)
        return Error{ErrorCode::bad_message,
                     "the picture contains no state: oval4d has not made it, or another program "
                     "has saved it without the state"};
    if (message->size() > maxMessage)
        return Error{ErrorCode::too_large, "the state has " + std::to_string(message->size()) + " bytes; at most " +
                                               std::to_string(maxMessage) + " are allowed (--max-message)"};
    return setCommandFromState(*message);
}

bool mayContainState(std::string_view file) {
    const std::size_t first = file.find_first_not_of(" \t\r\n");
    return image::isPng(file) || (first != std::string_view::npos && file[first] == '{');
}

}  // namespace oval4d::wire
