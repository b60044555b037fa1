#include "wire/messages.hpp"

#include <algorithm>
#include <boost/describe/members.hpp>
#include <boost/describe/modifiers.hpp>
#include <boost/mp11/algorithm.hpp>
#include <limits>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "polytopes/catalogue/catalogue.hpp"
#include "protocol_data/embedded_files.hpp"
#include "session/example_fields.hpp"
#include "slicing/object.hpp"
#include "wire/json_writer.hpp"
#include "wire/message_members.hpp"

namespace oval4d::wire {

namespace {

// Returns a message with this type and this id. `writeMembers` writes all other members.
template <typename WriteMembers>
std::string makeMessage(std::string_view type, std::optional<double> id, const WriteMembers& writeMembers) {
    std::string out;
    {
        JsonWriter w(out);
        beginMessage(w, type, id);
        writeMembers(w);
        w.endObject();
    }
    return out;
}

// Writes a member of an answer. Omits empty optionals and empty lists.
template <typename Value>
void writeMemberIfPresent(JsonWriter& w, std::string_view name, const Value& value) {
    writeMember(w, name, value);
}
template <typename Value>
void writeMemberIfPresent(JsonWriter& w, std::string_view name, const std::optional<Value>& value) {
    if (value) writeMember(w, name, *value);
}
template <typename Value>
void writeMemberIfPresent(JsonWriter& w, std::string_view name, const std::vector<Value>& list) {
    if (!list.empty()) writeMember(w, name, list);
}

template <typename Number>
void writeBeforeAndAfter(JsonWriter& w, std::string_view name, Number before, Number after) {
    w.key(name);
    w.beginArray();
    w.value(before);
    w.value(after);
    w.endArray();
}

// Writes those members of an `at` message that describe an element. The parameters are the same as for pickMessage().
void writeElementMembers(JsonWriter& w, const slicing::Element& element, const scene::Scene& scene,
                         const slicing::Object& object, const slicing::Object& source) {
    const glm::dvec4& origin = slicing::infoOf(object).originInFile;
    slicing::PartsShowingElement parts;
    slicing::findPartsShowing(object, element, parts);
    double least = std::numeric_limits<double>::max(), most = -least;
    for (const std::uint32_t v : parts.ownVertices) {
        least = std::min(least, scene.slices->rotatedVertices[v].w);
        most = std::max(most, scene.slices->rotatedVertices[v].w);
    }
    w.member("least_w", origin.w + least);
    w.member("most_w", origin.w + most);
    w.member("vertices", std::uint64_t{parts.ownVertices.size()});
    if (element.kind == slicing::ElementKind::vertex) {
        writeMember(w, "place", slicing::vertexInFile(object, element.index));
        if (slicing::fieldIn(object) == nullptr)
            writeMember(w, "coordinates", origin + scene.slices->rotatedVertices[element.index]);
    }
    if (element.kind == slicing::ElementKind::face)
        w.member("name", std::string_view(slicing::nameOfFace(source, element.index)));
    if (element.kind == slicing::ElementKind::cell) {
        const std::uint32_t kind = slicing::typesOfCells(object)[element.index];
        w.member("kind", std::uint64_t{kind});
        w.member("name", std::string_view(slicing::infoOf(object).cellTypes[kind].name));
    }
}

// Writes the members of an `at` message that describe a point of a field.
void writeSampleMembers(JsonWriter& w, const slicing::FieldSample& sample) {
    writeMember(w, "place", sample.place);
    writeMemberIfPresent(w, "value", sample.value);
    writeMemberIfPresent(w, "second_value", sample.secondValue);
}

}  // namespace

std::string answerMessage(const Answer& answer, std::optional<double> id) {
    return std::visit(
        [&]<typename Described>(const Described& described) {
            return makeMessage(Described::kMessageType, id, [&](JsonWriter& w) {
                using Members = boost::describe::describe_members<Described, boost::describe::mod_public>;
                boost::mp11::mp_for_each<Members>(
                    [&](auto member) { writeMemberIfPresent(w, member.name, described.*member.pointer); });
            });
        },
        answer);
}

std::string pickMessage(const PictureAtPixel& at, const scene::Scene& scene, const slicing::Object& object,
                        const slicing::Object& source, std::uint64_t revision, std::optional<double> id) {
    const glm::dvec4& origin = slicing::infoOf(object).originInFile;
    const auto writePickedIn = [&](JsonWriter& w, scene::PickLocation in, std::size_t slice) {
        w.member("in", text::nameOf(scene::kPickedIn, in));
        if (in != scene::PickLocation::slice) return;
        w.member("slice", scene.placements[slice].index);
        w.member("w", origin.w + scene.placements[slice].w);
    };
    return makeMessage("at", id, [&](JsonWriter& w) {
        w.member("revision", revision);
        w.key("highlight");
        writeValue(w, at.element ? std::optional(at.element->element) : std::nullopt);
        if (at.element) {
            writePickedIn(w, at.element->in, at.element->slice);
            writeElementMembers(w, at.element->element, scene, object, source);
        } else if (at.level) {
            writePickedIn(w, at.level->in, at.level->slice);
            w.member("level", std::uint64_t{at.level->level});
            w.member("cap", at.level->cap);
            slicing::FieldSample sample = *at.sample;
            // On the surface, the exact value of the function is the level. The sampled value differs from it by small
            // errors.
            if (!at.level->cap) sample.value = scene.look.field.levels[at.level->level];
            writeSampleMembers(w, sample);
        }
        if (at.panelPoint) writeMember(w, "point", origin + *at.panelPoint);
    });
}

std::string sampleMessage(const slicing::FieldSample& sample, std::uint64_t revision, std::optional<double> id) {
    return makeMessage("at", id, [&](JsonWriter& w) {
        w.member("revision", revision);
        w.key("highlight");
        writeValue(w, std::optional<slicing::Element>());
        writeSampleMembers(w, sample);
    });
}

std::string errorMessage(const Error& error, std::optional<double> id) {
    return makeMessage("error", id, [&](JsonWriter& w) {
        w.member("code", protocolName(error.code));
        w.member("message", std::string_view(error.message));
    });
}

std::string criticalMessage(const slicing::CriticalSections& sections, double originW, std::uint64_t revision,
                            std::optional<double> id) {
    return makeMessage("critical", id, [&](JsonWriter& w) {
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
                w.member("level", std::uint64_t{section.levelIndex});
                writeBeforeAndAfter(w, "components", std::uint64_t{components},
                                    std::uint64_t{section.after.components});
                writeBeforeAndAfter(w, "cavities", std::uint64_t{cavities}, std::uint64_t{section.after.cavities});
                writeBeforeAndAfter(w, "euler", std::int64_t{euler}, std::int64_t{section.after.euler});
            }
            w.endObject();
        }
        w.endArray();
    });
}

std::string welcomeMessage(std::string_view session, std::string_view token, std::string_view limits,
                           std::optional<double> id) {
    return makeMessage("welcome", id, [&](JsonWriter& w) {
        w.member("session", session);
        w.member("token", token);
        w.member("protocol", 1);
        w.member("server", "oval4d " OVAL4D_VERSION);
        w.key("limits");
        w.raw(limits);
    });
}

std::string catalogueMessage(std::optional<double> id, std::span<const slicing::Object> loaded,
                             std::span<const std::string> data) {
    // The numbers of vertices, edges, 2-faces and cells of a field's domain, which is a 4-D box.
    constexpr ElementCounts kBox{16, 32, 24, 8};
    return makeMessage("catalogue", id, [&](JsonWriter& w) {
        w.key("polytopes");
        w.beginArray();
        for (const polytopes::CatalogueEntry& entry : polytopes::catalogue()) {
            w.beginObject();
            w.member("name", std::string_view(entry.name));
            w.member("family", std::string_view(entry.family));
            writeMember(w, "aliases", entry.aliases);
            w.member("diagram", std::string_view(entry.diagram));
            w.member("schlaefli", std::string_view(entry.schlaefli));
            writeCountMembers(w, {entry.vertices, entry.edges, entry.faces, entry.cells});
            w.member("symmetry_order", entry.symmetryOrder);
            w.endObject();
        }
        const auto add = [&](std::string_view name, std::string_view family, const ElementCounts& counts,
                             const std::vector<std::string>& aliases = {}) {
            w.beginObject();
            w.member("name", name);
            w.member("family", family);
            writeMember(w, "aliases", aliases);
            w.member("diagram", std::string_view());
            w.member("schlaefli", std::string_view());
            writeCountMembers(w, counts);
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
    });
}

std::string keymapMessage(std::optional<double> id) {
    static const nlohmann::ordered_json table =
        nlohmann::ordered_json::parse(protocol_data::embeddedFile("keymap.json"));
    static const std::string groups = table.at("groups").dump();
    static const std::string keys = table.at("keys").dump();
    return makeMessage("keymap", id, [&](JsonWriter& w) {
        w.key("groups");
        w.raw(groups);
        w.key("keys");
        w.raw(keys);
    });
}

}  // namespace oval4d::wire
