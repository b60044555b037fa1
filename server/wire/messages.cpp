#include "wire/messages.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include <nlohmann/json.hpp>

#include "fields/array/array_function.hpp"
#include "fields/field.hpp"
#include "polytopes/catalogue/catalogue.hpp"
#include "protocol_data/embedded_files.hpp"
#include "scene/color.hpp"
#include "scene/surface_look.hpp"
#include "session/example_fields.hpp"
#include "session/setting_table.hpp"
#include "slicing/object.hpp"
#include "wire/json_writer.hpp"

namespace oval4d::wire {

namespace {

// Begins a message: writes its type, and its id if there is one.
void begin(JsonWriter& w, std::string_view type, std::optional<double> id) {
    w.beginObject();
    w.member("type", type);
    if (id) {
        w.key("id");
        w.id(*id);
    }
}

// The numbers of vertices, edges, 2-faces and cells.
using Counts = std::array<std::uint64_t, 4>;

Counts countsOf(const slicing::Object& object) {
    const auto [vertices, edges, faces, cells] = slicing::elementCounts(object);
    return {vertices, edges, faces, cells};
}

void writeCounts(JsonWriter& w, const Counts& counts) {
    w.member("vertices", counts[0]);
    w.member("edges", counts[1]);
    w.member("faces", counts[2]);
    w.member("cells", counts[3]);
}

// Writes a value as JSON.
template <typename Number>
void writeValue(JsonWriter& w, const Number& number) {
    w.value(number);
}
template <text::HasChoices Enum>
void writeValue(JsonWriter& w, const Enum& value) {
    w.value(text::nameOf(choicesOf(value), value));
}
template <glm::length_t length>
void writeValue(JsonWriter& w, const glm::vec<length, double>& coordinates) {
    w.beginArray();
    for (int axis = 0; axis < length; ++axis) w.value(coordinates[axis]);
    w.endArray();
}
void writeValue(JsonWriter& w, const std::vector<std::uint32_t>& numbers) { w.numbers(numbers); }
void writeValue(JsonWriter& w, const std::vector<double>& numbers) {
    w.beginArray();
    for (const double number : numbers) w.value(number);
    w.endArray();
}
void writeValue(JsonWriter& w, const std::vector<slicing::FogPoint>& points) {
    w.beginArray();
    for (const slicing::FogPoint& point : points) {
        w.beginObject();
        w.member("value", point.value);
        w.member("opacity", point.opacity);
        if (point.color) w.member("color", *point.color);
        w.endObject();
    }
    w.endArray();
}
void writeValue(JsonWriter& w, const std::optional<slicing::Element>& element) {
    if (!element) return w.null();
    w.beginObject();
    w.member("element", text::nameOf(slicing::kElementKinds, element->kind));
    w.member("number", std::uint64_t{element->index});
    w.endObject();
}

template <typename Value>
void writeMember(JsonWriter& w, std::string_view name, const Value& value) {
    w.key(name);
    writeValue(w, value);
}

void writeObject(JsonWriter& w, const slicing::Object& object, scene::Scheme scheme) {
    const geometry::ObjectInfo& info = slicing::infoOf(object);
    w.key("polytope");
    w.beginObject();
    w.member("name", std::string_view(info.name));
    writeCounts(w, countsOf(object));
    w.key("kinds");
    w.beginArray();
    for (std::size_t i = 0; i < info.cellTypes.size(); ++i) {
        w.beginObject();
        w.member("name", std::string_view(info.cellTypes[i].name));
        w.member("cells", std::uint64_t{info.cellTypes[i].cells});
        w.member("color", scene::cellTypeColor(i, info.cellTypes.size(), scheme));
        w.endObject();
    }
    w.endArray();
    if (info.originInFile != glm::dvec4(0)) writeMember(w, "center", info.originInFile);
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
    for (const geometry::Plane plane : turn->planes()) w.value(geometry::name(plane));
    w.endArray();
    w.key("angles");
    w.beginArray();
    for (const geometry::Plane plane : turn->planes()) w.value(*(*turn)[plane]);
    w.endArray();
    w.endObject();
}

// Writes the member `values`: the second function, if there is one, and the color scale of values.
void writeValues(JsonWriter& w, const fields::Field& field, scene::Scheme scheme) {
    constexpr int kColors = 9;
    const scene::ValueScale scale = scene::valueScaleFor(field.coloringRange->get(), scheme);
    w.key("values");
    w.beginObject();
    if (field.second && field.second->array) {
        w.member("variable", std::string_view(field.second->variable));
    } else if (field.second) {
        w.member("formula", std::string_view(field.second->formula));
    }
    w.key("range");
    w.beginArray();
    w.value(scale.least);
    w.value(scale.greatest);
    w.endArray();
    w.key("colors");
    w.beginArray();
    for (int i = 0; i < kColors; ++i) {
        const double at = static_cast<double>(i) / (kColors - 1);
        w.value(std::uint64_t{scale.color(scale.least + at * (scale.greatest - scale.least))});
    }
    w.endArray();
    w.endObject();
}

void writeField(JsonWriter& w, const fields::Field& field, const scene::Look& look, scene::Scheme scheme) {
    w.key("field");
    w.beginObject();
    if (field.array) {
        w.key("shape");
        w.beginArray();
        for (const std::size_t samples : field.array->shape()) w.value(std::uint64_t{samples});
        w.endArray();
        w.key("range");
        w.beginArray();
        w.value(double{field.array->statistics().min});
        w.value(double{field.array->statistics().max});
        w.endArray();
        if (!field.array->rangeIsExact()) w.member("estimated", true);
    } else {
        w.member("formula", std::string_view(field.formula));
    }
    if (field.second || scene::colorsByValue(look)) writeValues(w, field, scheme);
    w.key("box");
    w.beginArray();
    for (int axis = 0; axis < 4; ++axis) {
        w.beginArray();
        w.value(field.box.min[axis]);
        w.value(field.box.max[axis]);
        w.endArray();
    }
    w.endArray();
    w.endObject();
}

void writeSettings(JsonWriter& w, const session::State& state) {
    std::string_view object;  // the one that has been begun
    const auto continueIn = [&](std::string_view next) {
        if (next == object) return;
        if (!object.empty()) w.endObject();
        if (!next.empty()) {
            w.key(next);
            w.beginObject();
        }
        object = next;
    };
    session::forEachSetting([&]<typename Row>(const Row& setting) {
        if constexpr (Row::kIsInState) {
            if (setting.forFields && slicing::fieldIn(state.object) == nullptr) return;
            continueIn(setting.name.object);
            writeMember(w, setting.name.member, setting.ofState(state));
        }
    });
    continueIn({});
}

}  // namespace

void stateMessage(const session::State& state, const slicing::SectionNames& section, std::uint64_t revision,
                  std::optional<double> id, std::string& out, slicing::Quality quality, scene::Scheme viewer) {
    const scene::Scheme scheme = scene::schemeOn(state.look.background, viewer);
    JsonWriter w(out);
    begin(w, "state", id);
    w.member("revision", revision);
    if (quality == slicing::Quality::draft) w.member("draft", true);
    writeObject(w, state.object, scheme);
    if (const fields::Field* const field = slicing::fieldIn(state.object)) writeField(w, *field, state.look, scheme);
    writeMatrix(w, state.orientation.matrix());
    w.key("section");
    w.beginObject();
    w.member("w", state.focusPointInFile().w);
    w.member("name", section.slice);
    w.member("vertices", section.vertices);
    w.endObject();
    w.member("turning", state.turning);
    w.member("moving", state.moves());
    writeSettings(w, state);
    writeLast(w, state.lastTurn);
    w.endObject();
}

std::string stateMessage(const session::State& state, const slicing::SectionNames& section, std::uint64_t revision,
                         std::optional<double> id, slicing::Quality quality, scene::Scheme viewer) {
    constexpr std::size_t kTypicalBytes = 1024;
    std::string out;
    out.reserve(kTypicalBytes);
    stateMessage(state, section, revision, id, out, quality, viewer);
    return out;
}

std::string atMessage(const std::optional<scene::PickedElement>& picked, const std::optional<glm::dvec4>& point,
                      const scene::Scene& scene, const slicing::Object& object, std::uint64_t revision,
                      std::optional<double> id) {
    std::string out;
    const glm::dvec4& origin = slicing::infoOf(object).originInFile;
    {
        JsonWriter w(out);
        begin(w, "at", id);
        w.member("revision", revision);
        w.key("highlight");
        writeValue(w, picked ? std::optional(picked->element) : std::nullopt);
        if (picked) {
            w.member("in", text::nameOf(scene::kPictureAreas, picked->area));
            if (picked->area == scene::PictureArea::slice) {
                w.member("slice", scene.placements[picked->slice].index);
                w.member("w", origin.w + scene.placements[picked->slice].w);
            }
            slicing::ElementSources sources;
            slicing::findSourcesShowing(object, picked->element, sources);
            double least = std::numeric_limits<double>::max(), most = -least;
            for (const std::uint32_t v : sources.ownVertices) {
                least = std::min(least, scene.slices->rotatedVertices[v].w);
                most = std::max(most, scene.slices->rotatedVertices[v].w);
            }
            w.member("least_w", origin.w + least);
            w.member("most_w", origin.w + most);
            w.member("vertices", std::uint64_t{sources.ownVertices.size()});
            if (picked->element.kind == slicing::ElementKind::vertex)
                writeMember(w, "place", slicing::vertexInFile(object, picked->element.index));
            if (picked->element.kind == slicing::ElementKind::cell) {
                const std::uint32_t kind = slicing::typeOfCells(object)[picked->element.index];
                w.member("kind", std::uint64_t{kind});
                w.member("name", std::string_view(slicing::infoOf(object).cellTypes[kind].name));
            }
        }
        if (point) writeMember(w, "point", origin + *point);
        w.endObject();
    }
    return out;
}

std::string errorMessage(const Error& error, std::optional<double> id) {
    std::string out;
    {
        JsonWriter w(out);
        begin(w, "error", id);
        w.member("code", protocolName(error.code));
        w.member("message", std::string_view(error.message));
        w.endObject();
    }
    return out;
}

namespace {

template <typename Number>
void writePair(JsonWriter& w, std::string_view name, Number before, Number after) {
    w.key(name);
    w.beginArray();
    w.value(before);
    w.value(after);
    w.endArray();
}

}  // namespace

std::string criticalMessage(const slicing::CriticalSections& sections, double originW, std::uint64_t revision,
                            std::optional<double> id) {
    std::string out;
    {
        JsonWriter w(out);
        begin(w, "critical", id);
        w.member("revision", revision);
        w.member("least_w", originW + sections.least);
        w.member("most_w", originW + sections.greatest);
        w.member("tolerance", sections.tolerance);
        w.member("resolution", sections.resolution);
        w.key("sections");
        w.beginArray();
        for (const slicing::CriticalSection& section : sections.all) {
            w.beginObject();
            w.member("w", originW + section.w);
            w.member("change", text::nameOf(slicing::kSectionChanges, section.change));
            if (section.change == slicing::SectionChange::vertices) {
                w.member("vertices", std::uint64_t{section.vertices});
            } else {
                const auto& [components, cavities, euler] = section.before;
                w.member("level", std::uint64_t{section.level});
                writePair(w, "components", std::uint64_t{components}, std::uint64_t{section.after.components});
                writePair(w, "cavities", std::uint64_t{cavities}, std::uint64_t{section.after.cavities});
                writePair(w, "euler", std::int64_t{euler}, std::int64_t{section.after.euler});
            }
            w.endObject();
        }
        w.endArray();
        w.endObject();
    }
    return out;
}

std::string pongMessage(const WorkerLoad& load, std::optional<double> id) {
    std::string out;
    {
        JsonWriter w(out);
        begin(w, "pong", id);
        w.member("workers", std::uint64_t{load.workers});
        w.member("waiting", std::uint64_t{load.waiting});
        w.member("busy", load.busy);
        w.member("time", load.time);
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
        w.raw(limits);
        w.endObject();
    }
    return out;
}

std::string catalogueMessage(std::optional<double> id, std::span<const slicing::Object> loaded,
                             std::span<const std::string> data) {
    constexpr Counts kBox{16, 32, 24, 8};  // the elements of a field's domain
    std::string out;
    {
        JsonWriter w(out);
        begin(w, "catalogue", id);
        w.key("polytopes");
        w.beginArray();
        for (const polytopes::CatalogueEntry& entry : polytopes::catalogue()) {
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
        const auto add = [&](std::string_view name, std::string_view family, const Counts& counts,
                             const std::vector<std::string>& aliases = {}) {
            w.beginObject();
            w.member("name", name);
            w.member("family", family);
            w.key("aliases");
            w.beginArray();
            for (const std::string& alias : aliases) w.value(std::string_view(alias));
            w.endArray();
            w.member("diagram", std::string_view());
            w.member("schlaefli", std::string_view());
            writeCounts(w, counts);
            w.endObject();
        };
        for (const session::ExampleField& example : session::exampleFields()) {
            const auto hasName = [&](const slicing::Object& object) {
                return slicing::infoOf(object).name == example.name;
            };
            if (std::ranges::none_of(loaded, hasName)) add(example.name, "fields", kBox, example.aliases);
        }
        for (const slicing::Object& object : loaded) add(slicing::infoOf(object).name, "loaded", countsOf(object));
        for (const std::string& name : data) add(name, "data", kBox);
        w.endArray();
        w.endObject();
    }
    return out;
}

std::string addressMessage(std::string_view query, std::optional<double> id) {
    std::string out;
    {
        JsonWriter w(out);
        begin(w, "address", id);
        w.member("query", query);
        w.endObject();
    }
    return out;
}

std::string keymapMessage(std::optional<double> id) {
    static const nlohmann::ordered_json table =
        nlohmann::ordered_json::parse(protocol_data::embeddedFile("keymap.json"));
    static const std::string groups = table.at("groups").dump();
    static const std::string keys = table.at("keys").dump();
    std::string out;
    {
        JsonWriter w(out);
        begin(w, "keymap", id);
        w.key("groups");
        w.raw(groups);
        w.key("keys");
        w.raw(keys);
        w.endObject();
    }
    return out;
}

}  // namespace oval4d::wire
