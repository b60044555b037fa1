#include "wire/state_message.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "fields/array/array_function.hpp"
#include "fields/axis_units.hpp"
#include "fields/field.hpp"
#include "scene/color.hpp"
#include "scene/surface_look.hpp"
#include "session/setting_table.hpp"
#include "slicing/object.hpp"
#include "wire/json_writer.hpp"
#include "wire/message_members.hpp"

namespace oval4d::wire {

namespace {

void writeObject(JsonWriter& w, const slicing::Object& object, scene::ColorScheme scheme) {
    const geometry::ObjectInfo& info = slicing::infoOf(object);
    w.key("polytope");
    w.beginObject();
    w.member("name", std::string_view(info.name));
    writeCountMembers(w, countsOf(object));
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

void writeLastTurn(JsonWriter& w, const std::optional<geometry::RotationAngles>& turn) {
    w.key("last");
    if (!turn) return w.null();
    w.beginObject();
    w.key("planes");
    w.beginArray();
    for (const geometry::Plane plane : turn->planes()) w.value(geometry::planeName(plane));
    w.endArray();
    w.key("angles");
    w.beginArray();
    for (const geometry::Plane plane : turn->planes()) w.value(*(*turn)[plane]);
    w.endArray();
    w.endObject();
}

// Writes the member `quantity` with the name and the unit, as far as they are known. Writes nothing if both are
// unknown.
void writeQuantity(JsonWriter& w, const fields::Quantity& quantity) {
    if (!quantity.isKnown()) return;
    w.key("quantity");
    w.beginObject();
    if (!quantity.name.empty()) w.member("name", std::string_view(quantity.name));
    if (!quantity.unit.empty()) w.member("unit", std::string_view(quantity.unit));
    w.endObject();
}

// Writes the member `units` with the units of those axes whose units are known. Writes nothing if none is known.
void writeUnits(JsonWriter& w, const fields::AxisUnits& units) {
    if (std::ranges::all_of(units, &std::string::empty)) return;
    w.key("units");
    w.beginObject();
    for (std::size_t axis = 0; axis < units.size(); ++axis) {
        if (!units.at(axis).empty())
            w.member(std::string_view("xyzw").substr(axis, 1), std::string_view(units.at(axis)));
    }
    w.endObject();
}

void writeBox(JsonWriter& w, std::string_view name, const fields::Box& box) {
    w.key(name);
    w.beginArray();
    for (int axis = 0; axis < 4; ++axis) {
        w.beginArray();
        w.value(box.min[axis]);
        w.value(box.max[axis]);
        w.endArray();
    }
    w.endArray();
}

// Writes the member `region` if the field is a part of an array in the data folder. Writes the member `resolution` if
// the field is a level of a multiscale image.
void writePart(JsonWriter& w, const fields::Field& field) {
    if (!field.source) return;
    if (field.source->region) writeBox(w, "region", *field.source->region);
    const auto [level, levels, finer] = field.imageLevel;
    if (levels == 0) return;
    w.key("resolution");
    w.beginObject();
    w.member("level", std::uint64_t{level});
    w.member("levels", std::uint64_t{levels});
    if (finer > 0) w.member("refining", true);
    w.endObject();
}

// Writes the member `values`: the field's second function, if it has one, and the color scale of the coloring values.
// These are the values of the second function or, without one, of the field.
void writeValues(JsonWriter& w, const fields::Field& field, scene::ColorScheme scheme) {
    constexpr int kColors = 9;
    const scene::ValueColorScale scale = scene::valueColorScaleFor(field.coloringRange->typicalRange(), scheme);
    w.key("values");
    w.beginObject();
    if (field.second && field.second->array) {
        w.member("variable", std::string_view(field.second->variable));
        writeQuantity(w, field.second->quantity);
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
        w.value(std::uint64_t{scale.colorOf(scale.least + at * (scale.greatest - scale.least))});
    }
    w.endArray();
    w.endObject();
}

void writeField(JsonWriter& w, const fields::Field& field, const scene::Look& look, scene::ColorScheme scheme) {
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
        if (!field.array->statisticsAreExact()) w.member("estimated", true);
        writePart(w, field);
        writeUnits(w, field.units);
        writeQuantity(w, field.quantity);
    } else {
        w.member("formula", std::string_view(field.formula));
    }
    if (field.second || scene::colorsByValue(look)) writeValues(w, field, scheme);
    writeBox(w, "box", field.box);
    w.endObject();
}

// Writes the coordinate that all points of the focus slice have in common, along an axis of the field's box. Writes
// nothing if there is no such coordinate.
void writeCommonCoordinate(JsonWriter& w, const session::State& state) {
    const fields::Field* const field = slicing::fieldIn(state.object);
    const auto common = field == nullptr ? std::nullopt : fields::constantSliceCoordinate(*field, state.orientation);
    if (!common) return;
    const auto axis = static_cast<std::size_t>(common->axis);
    w.key("coordinate");
    w.beginObject();
    w.member("axis", std::string_view("xyzw").substr(axis, 1));
    w.member("value", common->coordinateAt(state.focusW()));
    if (!field->units.at(axis).empty()) w.member("unit", std::string_view(field->units.at(axis)));
    w.endObject();
}

void writeSettings(JsonWriter& w, const session::State& state) {
    std::string_view object;  // the name of the JSON object that is being written; empty for none
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

// Writes the `state` message to `out`. Omits the serial number of the object if `serial` is empty.
void writeState(std::string& out, const session::State& state, const slicing::SliceAndHullNames& section,
                std::uint64_t revision, std::optional<std::uint64_t> serial, std::optional<double> id,
                slicing::Quality quality, scene::ColorScheme viewer) {
    const scene::ColorScheme scheme = scene::schemeForBackground(state.look.background, viewer);
    JsonWriter w(out);
    beginMessage(w, "state", id);
    w.member("revision", revision);
    if (serial) w.member("object_serial", *serial);
    if (quality == slicing::Quality::draft) w.member("draft", true);
    writeObject(w, state.object, scheme);
    if (const fields::Field* const field = slicing::fieldIn(state.object)) writeField(w, *field, state.look, scheme);
    writeMatrix(w, state.orientation.matrix());
    w.key("section");
    w.beginObject();
    w.member("w", state.focusPointInFile().w);
    w.member("name", section.slice);
    w.member("vertices", section.vertices);
    writeCommonCoordinate(w, state);
    w.endObject();
    w.member("turning", state.turning);
    w.member("playing", state.playing);
    w.member("moving", state.isMoving());
    writeSettings(w, state);
    writeLastTurn(w, state.lastTurn);
    w.endObject();
}

constexpr std::size_t kTypicalBytes = 1024;

}  // namespace

void stateMessage(const session::State& state, const slicing::SliceAndHullNames& section, std::uint64_t revision,
                  std::optional<double> id, std::string& out, slicing::Quality quality, scene::ColorScheme viewer) {
    writeState(out, state, section, revision, slicing::infoOf(state.source).serial, id, quality, viewer);
}

std::string stateMessage(const session::State& state, const slicing::SliceAndHullNames& section, std::uint64_t revision,
                         std::optional<double> id, slicing::Quality quality, scene::ColorScheme viewer) {
    std::string out;
    out.reserve(kTypicalBytes);
    stateMessage(state, section, revision, id, out, quality, viewer);
    return out;
}

std::string stateMessageOutsideSessions(const session::State& state, const slicing::SliceAndHullNames& section) {
    std::string out;
    out.reserve(kTypicalBytes);
    writeState(out, state, section, 0, {}, {}, slicing::Quality::full, scene::ColorScheme::dark);
    return out;
}

}  // namespace oval4d::wire
