// Messages to the server: JSON text into the structs of request.hpp.

#include <string>
#include <utility>

#include "protocol/cpp/codec.hpp"
#include "protocol/cpp/json_text.hpp"
#include "protocol/cpp/schema.hpp"
#include "protocol/cpp/suggest.hpp"

namespace oval4d::protocol {

namespace {

using nlohmann::json;

// What a schema cannot say.
struct Misuse {
    std::string message;
};

template <typename T>
void take(const json& object, const char* name, std::optional<T>& into) {
    if (const auto member = object.find(name); member != object.end()) into = member->get<T>();
}

geometry::Turn turnOf(const json& object, const std::string& where) {
    const json& planes = object.at("planes");
    const json& angles = object.at("angles");
    if (planes.size() != angles.size()) {
        throw Misuse{where + "/angles must hold one angle for each plane: " + std::to_string(planes.size()) + ", not " +
                     std::to_string(angles.size())};
    }
    geometry::Turn turn{*geometry::planeNamed(planes[0].get_ref<const std::string&>()), angles[0].get<double>(), {}};
    if (angles.size() == 2) turn.beta = angles[1].get<double>();
    return turn;
}

std::optional<scene::Viewport> viewportOf(const json& message) {
    if (!message.contains("width") && !message.contains("height")) return {};
    scene::Viewport viewport;
    viewport.width = message.value("width", viewport.width);
    viewport.height = message.value("height", viewport.height);
    return viewport;
}

Hello helloOf(const json& message) {
    Hello hello;
    const std::string stream = message.value("stream", "none");
    hello.stream = stream == "geometry" ? Stream::geometry : stream == "frames" ? Stream::frames : Stream::none;
    hello.encoding = message.value("encoding", "json") == "cbor" ? Encoding::cbor : Encoding::json;
    hello.viewport = viewportOf(message).value_or(scene::Viewport{});
    take(message, "token", hello.token);
    return hello;
}

Set setOf(const json& message) {
    Set set;
    if (const auto polytope = message.find("polytope"); polytope != message.end()) {
        set.polytope = polytope->is_object() ? polytope->at("name").get<std::string>() : polytope->get<std::string>();
    }
    if (const auto rows = message.find("orientation"); rows != message.end()) {
        set.orientation.emplace();
        for (int row = 0; row < 4; ++row) {
            for (int column = 0; column < 4; ++column)
                (*set.orientation)[column][row] = (*rows)[row][column].get<double>();
        }
    }
    take(message, "alpha", set.alpha);
    take(message, "beta", set.beta);
    take(message, "step", set.step);
    take(message, "turning", set.turning);
    if (const auto slices = message.find("slices"); slices != message.end()) {
        take(*slices, "count", set.count);
        take(*slices, "spacing", set.spacing);
        take(*slices, "focus", set.focus);
    }
    if (const auto view = message.find("view"); view != message.end()) {
        set.view = *view == "single" ? scene::View::single : scene::View::oval;
    }
    if (const auto parts = message.find("shown"); parts != message.end()) {
        take(*parts, "faces", set.faces);
        take(*parts, "bars", set.bars);
        take(*parts, "balls", set.balls);
        take(*parts, "coordinates", set.coordinates);
    }
    if (const auto camera = message.find("camera"); camera != message.end()) {
        take(*camera, "azimuth", set.azimuth);
        take(*camera, "elevation", set.elevation);
        take(*camera, "zoom", set.zoom);
    }
    if (const auto colouring = message.find("color"); colouring != message.end())
        set.colouring = colouringNamed(colouring->get_ref<const std::string&>());
    take(message, "hidden", set.hidden);
    take(message, "faded", set.faded);
    if (const auto last = message.find("last"); last != message.end() && !last->is_null())
        set.last = turnOf(*last, "set: /last");
    return set;
}

// The schema has seen to it that the names are known.
template <typename Choices, typename Choice>
void choose(const json& message, const char* member, const Choices& choices, Choice& into) {
    if (const auto named = message.find(member); named != message.end())
        into = *exports::named(choices, named->template get_ref<const std::string&>());
}

exports::Wish wishOf(const json& message) {
    if (!message.contains("format")) throw Misuse{"get: a file must have a /format, such as \"stl\""};
    exports::Wish wish;
    choose(message, "format", exports::kFormats, wish.format);
    choose(message, "of", exports::kExtents, wish.of);
    choose(message, "body", exports::kBodies, wish.body);
    choose(message, "label", exports::kLabels, wish.label);
    wish.size = message.value("size", wish.size);
    return wish;
}

Get getOf(const json& message) {
    if (message.contains("width") != message.contains("height"))
        throw Misuse{"get: give /width and /height together, or neither"};
    const std::string& what = message.at("what").get_ref<const std::string&>();
    Get get;
    get.what = what == "slices"      ? What::slices
               : what == "frame"     ? What::frame
               : what == "file"      ? What::file
               : what == "catalogue" ? What::catalogue
               : what == "keymap"    ? What::keymap
                                     : What::state;
    get.viewport = viewportOf(message);
    if (get.what == What::file) get.file = wishOf(message);
    return get;
}

decltype(Request::body) bodyOf(const std::string& type, const json& message) {
    if (type == "key")
        return Command{Key{message.at("key"), message.value("shift", false), message.value("ctrl", false)}};
    if (type == "shown") return ShownRevision{message.at("revision")};
    if (type == "rotate") return Command{Rotate{turnOf(message, "rotate: ")}};
    if (type == "set") return Command{setOf(message)};
    if (type == "undo") return Command{Undo{}};
    if (type == "redo") return Command{Redo{}};
    if (type == "reset") return Command{Reset{}};
    if (type == "command") return Command{CommandLine{message.at("line")}};
    if (type == "load") return Command{Load{message.at("name"), message.at("format"), message.at("data")}};
    if (type == "get") return getOf(message);
    return helloOf(message);
}

std::variant<Request, BadRequest> requestOf(JsonText&& read) {
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
                      "a message must have a member \"type\", one of " + listed(requestTypes()));
    }
    const std::string& name = type->get_ref<const std::string&>();
    bool known = false;
    for (const std::string_view request : requestTypes()) known = known || request == name;
    if (!known) {
        return refuse(ErrorCode::unknown_type, "no message has the type " + inQuotes(name) +
                                                   didYouMean(name, requestTypes()) + "; allowed are " +
                                                   listed(requestTypes()));
    }
    if (std::optional<Error> error = misfit(name, message)) {
        if (read.repaired) error->message += " (" + read.fault + ")";
        return refuse(error->code, std::move(error->message));
    }
    if (read.repaired) return refuse(ErrorCode::bad_json, std::move(read.fault));
    try {
        return Request{id, bodyOf(name, message)};
    } catch (const Misuse& misuse) {
        return refuse(ErrorCode::bad_message, misuse.message);
    }
}

}  // namespace

std::variant<Request, BadRequest> parseRequest(std::string_view text, int maxDepth) {
    return requestOf(readJson(text, maxDepth));
}

Result<Set> setFromState(std::string_view text) {
    constexpr int kDepth = 8;
    JsonText read = readJson(text, kDepth);
    if (read.value.is_object()) {
        const auto type = read.value.find("type");
        if (type == read.value.end() || *type != "state") {
            return Error{ErrorCode::bad_message, "a state must be a JSON object with \"type\":\"state\""};
        }
        *type = "set";
    }
    auto request = requestOf(std::move(read));
    if (auto* bad = std::get_if<BadRequest>(&request)) return std::move(bad->error);
    return std::get<Set>(std::get<Command>(std::get<Request>(request).body));
}

}  // namespace oval4d::protocol
