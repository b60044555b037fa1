#pragma once
// Writes members that occur in several types of messages.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "slicing/element.hpp"
#include "slicing/field_settings.hpp"
#include "slicing/object.hpp"
#include "text/choice.hpp"
#include "wire/json_writer.hpp"

namespace oval4d::wire {

/// Begins a message: writes its type, and its id if `id` is present.
inline void beginMessage(JsonWriter& w, std::string_view type, std::optional<double> id) {
    w.beginObject();
    w.member("type", type);
    if (id) {
        w.key("id");
        w.id(*id);
    }
}

/// The numbers of an object's vertices, edges, 2-faces and cells, in this order.
using ElementCounts = std::array<std::uint64_t, 4>;

inline ElementCounts countsOf(const slicing::Object& object) {
    const auto [vertices, edges, faces, cells] = slicing::elementCounts(object);
    return {vertices, edges, faces, cells};
}

inline void writeCountMembers(JsonWriter& w, const ElementCounts& counts) {
    w.member("vertices", counts[0]);
    w.member("edges", counts[1]);
    w.member("faces", counts[2]);
    w.member("cells", counts[3]);
}

/// Writes a value as JSON: the value of a setting, or of a member that occurs in several types of messages.
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
inline void writeValue(JsonWriter& w, const std::vector<std::uint32_t>& numbers) { w.numbers(numbers); }
inline void writeValue(JsonWriter& w, const std::vector<double>& numbers) {
    w.beginArray();
    for (const double number : numbers) w.value(number);
    w.endArray();
}
inline void writeValue(JsonWriter& w, const std::vector<std::string>& texts) {
    w.beginArray();
    for (const std::string& text : texts) w.value(std::string_view(text));
    w.endArray();
}
inline void writeValue(JsonWriter& w, const std::vector<slicing::FogControlPoint>& points) {
    w.beginArray();
    for (const slicing::FogControlPoint& point : points) {
        w.beginObject();
        w.member("value", point.value);
        w.member("opacity", point.opacity);
        if (point.color) w.member("color", *point.color);
        w.endObject();
    }
    w.endArray();
}
inline void writeValue(JsonWriter& w, const std::optional<slicing::Element>& element) {
    if (!element) return w.null();
    w.beginObject();
    w.member("element", text::nameOf(slicing::kElementKinds, element->kind));
    w.member("number", std::uint64_t{element->index});
    w.endObject();
}
inline void writeValue(JsonWriter& w, const slicing::PartsShowingElement& parts) {
    w.beginObject();
    w.key("vertices");
    w.numbers(parts.vertices);
    w.key("edges");
    w.numbers(parts.edges);
    w.key("own_vertices");
    w.numbers(parts.ownVertices);
    w.endObject();
}

/// Writes a member of a JSON object: its name and its value.
template <typename Value>
void writeMember(JsonWriter& w, std::string_view name, const Value& value) {
    w.key(name);
    writeValue(w, value);
}

}  // namespace oval4d::wire
