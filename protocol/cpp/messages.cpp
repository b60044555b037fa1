// Messages to the client, but for slices.

#include <array>

#include <nlohmann/json.hpp>

#include "geometry/catalogue.hpp"
#include "geometry/kinds.hpp"
#include "protocol/cpp/codec.hpp"
#include "protocol/cpp/embedded.hpp"
#include "protocol/cpp/writer.hpp"

namespace oval4d::protocol {

namespace {

void begin(JsonWriter& w, std::string_view type, std::optional<double> id) {
    w.beginObject();
    w.member("type", type);
    if (id) w.member("id", *id);
}

// Numbers of vertices, edges, 2-faces and cells.
using Counts = std::array<std::uint64_t, 4>;

Counts countsOf(const geometry::Polytope& polytope) {
    return {polytope.vertices.size(), polytope.edges.size(), polytope.faces.size(), polytope.cells.size()};
}

void writeCounts(JsonWriter& w, const Counts& counts) {
    w.member("vertices", counts[0]);
    w.member("edges", counts[1]);
    w.member("faces", counts[2]);
    w.member("cells", counts[3]);
}

void writePolytope(JsonWriter& w, const geometry::Polytope& polytope) {
    w.key("polytope");
    w.beginObject();
    w.member("name", std::string_view(polytope.name));
    writeCounts(w, countsOf(polytope));
    w.key("kinds");
    w.beginArray();
    for (std::size_t i = 0; i < polytope.kinds.size(); ++i) {
        w.beginObject();
        w.member("name", std::string_view(polytope.kinds[i].name));
        w.member("cells", std::uint64_t{polytope.kinds[i].cells});
        w.member("color", scene::kindColour(i, polytope.kinds.size()));
        w.endObject();
    }
    w.endArray();
    w.endObject();
}

void writeMatrix(JsonWriter& w, const glm::dmat4& matrix) {
    w.key("orientation");
    w.beginArray();
    for (int row = 0; row < 4; ++row) {
        w.beginArray();
        for (int column = 0; column < 4; ++column) w.value(matrix[column][row]);
        w.endArray();
    }
    w.endArray();
}

void writeLast(JsonWriter& w, const std::optional<geometry::Turn>& turn) {
    w.key("last");
    if (!turn) return w.null();
    w.beginObject();
    w.key("planes");
    w.beginArray();
    w.value(geometry::name(turn->plane));
    if (turn->beta) w.value(geometry::name(geometry::perpendicular(turn->plane)));
    w.endArray();
    w.key("angles");
    w.beginArray();
    w.value(turn->alpha);
    if (turn->beta) w.value(*turn->beta);
    w.endArray();
    w.endObject();
}

}  // namespace

void stateMessage(const session::State& state, std::uint64_t revision, std::optional<double> id, std::string& out) {
    JsonWriter w(out);
    begin(w, "state", id);
    w.member("revision", revision);
    writePolytope(w, *state.polytope);
    writeMatrix(w, state.orientation.matrix());
    w.member("alpha", state.alpha);
    w.member("beta", state.beta);
    w.member("step", state.step);
    w.key("slices");
    w.beginObject();
    w.member("count", state.slices.count);
    w.member("spacing", state.slices.spacing);
    w.member("focus", state.slices.focus);
    w.endObject();
    w.member("view", state.look.view == scene::View::single ? "single" : "oval");
    w.member("turning", state.turning);
    w.key("shown");
    w.beginObject();
    w.member("faces", state.look.parts.faces);
    w.member("bars", state.look.parts.bars);
    w.member("balls", state.look.parts.balls);
    w.member("coordinates", state.look.parts.coordinates);
    w.endObject();
    w.key("camera");
    w.beginObject();
    w.member("azimuth", state.look.orbit.azimuth);
    w.member("elevation", state.look.orbit.elevation);
    w.member("zoom", state.look.orbit.zoom);
    w.endObject();
    w.member("color", wireName(state.look.colouring));
    w.key("hidden");
    w.numbers(state.look.kinds.hidden);
    w.key("faded");
    w.numbers(state.look.kinds.faded);
    writeLast(w, state.last);
    w.endObject();
}

std::string stateMessage(const session::State& state, std::uint64_t revision, std::optional<double> id) {
    constexpr std::size_t kUsual = 1024;
    std::string out;
    out.reserve(kUsual);
    stateMessage(state, revision, id, out);
    return out;
}

std::string errorMessage(const Error& error, std::optional<double> id) {
    std::string out;
    {
        JsonWriter w(out);
        begin(w, "error", id);
        w.member("code", wireName(error.code));
        w.member("message", std::string_view(error.message));
        w.endObject();
    }
    return out;
}

std::string doneMessage(std::optional<double> id, std::uint64_t revision, const std::vector<std::string>& warnings) {
    std::string out;
    {
        JsonWriter w(out);
        begin(w, "done", id);
        w.member("revision", revision);
        if (!warnings.empty()) {
            w.key("warnings");
            w.beginArray();
            for (const std::string& warning : warnings) w.value(std::string_view(warning));
            w.endArray();
        }
        w.endObject();
    }
    return out;
}

std::string welcomeMessage(std::string_view session, std::string_view token, std::string_view limits,
                           std::optional<double> id) {
    std::string out;
    {
        JsonWriter w(out);
        begin(w, "welcome", id);
        w.member("session", session);
        w.member("token", token);
        w.member("protocol", 1);
        w.member("server", "oval4d " OVAL4D_VERSION);
        w.key("limits");
        w.written(limits);
        w.endObject();
    }
    return out;
}

std::string catalogueMessage(std::optional<double> id, std::span<const session::PolytopePtr> loaded) {
    std::string out;
    {
        JsonWriter w(out);
        begin(w, "catalogue", id);
        w.key("polytopes");
        w.beginArray();
        for (const geometry::CatalogueEntry& entry : geometry::catalogue()) {
            w.beginObject();
            w.member("name", std::string_view(entry.name));
            w.member("family", std::string_view(entry.family));
            w.key("aliases");
            w.beginArray();
            for (const std::string& alias : entry.aliases) w.value(std::string_view(alias));
            w.endArray();
            w.member("diagram", std::string_view(entry.diagram));
            w.member("schlaefli", std::string_view(entry.schlaefli));
            writeCounts(w, {entry.vertices, entry.edges, entry.faces, entry.cells});
            w.member("symmetry_order", entry.symmetryOrder);
            w.endObject();
        }
        for (const session::PolytopePtr& polytope : loaded) {
            w.beginObject();
            w.member("name", std::string_view(polytope->name));
            w.member("family", std::string_view("loaded"));
            w.key("aliases");
            w.beginArray();
            w.endArray();
            w.member("diagram", std::string_view());
            w.member("schlaefli", std::string_view());
            writeCounts(w, countsOf(*polytope));
            w.endObject();
        }
        w.endArray();
        w.endObject();
    }
    return out;
}

std::string keymapMessage(std::optional<double> id) {
    static const nlohmann::ordered_json table = nlohmann::ordered_json::parse(embedded("keymap.json"));
    static const std::string groups = table.at("groups").dump();
    static const std::string keys = table.at("keys").dump();
    std::string out;
    {
        JsonWriter w(out);
        begin(w, "keymap", id);
        w.key("groups");
        w.written(groups);
        w.key("keys");
        w.written(keys);
        w.endObject();
    }
    return out;
}

}  // namespace oval4d::protocol
