#include "protocol/cpp/slices.hpp"

#include <algorithm>

#include "protocol/cpp/writer.hpp"

namespace oval4d::protocol {

namespace {

using geometry::Polytope;
using geometry::SliceSet;
using scene::Scene;

template <typename W>
void writeNumbers(W& w, std::string_view name, std::initializer_list<double> list) {
    w.key(name);
    w.beginArray();
    for (const double number : list) w.value(number);
    w.endArray();
}

template <typename W>
void writeVector(W& w, std::string_view name, const glm::dvec3& v) {
    w.key(name);
    w.vector(v);
}

template <typename W>
void writeCamera(W& w, const scene::Camera& camera) {
    w.key("camera");
    w.beginObject();
    writeNumbers(w, "eye", {camera.eye.x, camera.eye.y, camera.eye.z});
    writeNumbers(w, "target", {camera.target.x, camera.target.y, camera.target.z});
    writeNumbers(w, "up", {camera.up.x, camera.up.y, camera.up.z});
    w.member("fov", camera.fieldOfView);
    w.member("near", camera.near);
    w.member("far", camera.far);
    writeNumbers(w, "shift", {camera.shiftX, camera.shiftY});
    w.endObject();
}

template <typename W>
void writeColours(W& w, const scene::Style& style, const std::vector<scene::Colour>& cells) {
    w.key("colors");
    w.beginObject();
    w.member("background", style.background);
    w.member("text", style.text);
    w.member("focus", style.focusText);
    w.member("ball", style.ball);
    w.member("bar", style.bar);
    w.member("zero", style.zeroLine);
    w.key("axes");
    w.beginArray();
    for (const scene::Colour colour : {style.axisX, style.axisY, style.axisZ, style.axisW}) w.value(colour);
    w.endArray();
    w.key("cells");
    w.numbers(cells);
    w.endObject();
}

template <typename W>
void writeCoordinatesLayout(W& w, const scene::CoordinatesLayout& layout) {
    w.key("coordinates");
    w.beginObject();
    w.member("rows", layout.rows);
    w.member("per_row", layout.perRow);
    w.member("left", layout.left);
    w.member("zero", layout.zero);
    w.member("row_step", layout.rowStep);
    w.member("column_step", layout.columnStep);
    w.member("line_step", layout.lineStep);
    w.member("line_width", layout.lineWidth);
    w.member("amplitude", layout.amplitude);
    w.member("named", layout.named);
    w.member("columns", layout.density ? scene::Density::kColumns : 0);
    w.endObject();
}

template <typename W>
void writeSetting(W&& w, const SlicesWriter::Setting& setting) {
    const scene::Style& style = scene::style();
    w.member("view", setting.view == scene::View::single ? "single" : "oval");
    w.key("shown");
    w.beginObject();
    w.member("faces", setting.shown.faces);
    w.member("bars", setting.shown.bars);
    w.member("balls", setting.shown.balls);
    w.member("coordinates", setting.shown.coordinates);
    w.endObject();
    w.key("viewport");
    w.beginObject();
    w.member("width", setting.viewport.width);
    w.member("height", setting.viewport.height);
    w.endObject();
    writeCamera(w, setting.camera);
    w.member("scale", setting.scale);
    w.member("circumradius", setting.circumradius);
    w.member("ball", setting.ball);
    w.member("bar", setting.bar);
    w.member("opacity", setting.opacity);
    w.member("faded", scene::opacityOf(scene::Presence::faded));
    w.key("light");
    w.beginObject();
    writeNumbers(w, "direction", {style.light.x, style.light.y, style.light.z});
    w.member("ambient", style.ambient);
    w.member("diffuse", style.diffuse);
    w.member("specular", style.specular);
    w.member("shininess", style.shininess);
    w.endObject();
    w.key("axes");
    w.beginObject();
    w.member("x", setting.axes.x);
    w.member("y", setting.axes.y);
    w.member("length", setting.axes.length);
    w.endObject();
    writeCoordinatesLayout(w, setting.coordinates);
    w.member("text", style.textHeight);
}

template <typename T>
std::span<const T> part(const std::vector<T>& all, std::uint32_t begin, std::uint32_t end) {
    return std::span<const T>(all).subspan(begin, end - begin);
}

// The cell that gives each face its colour, where "of" does not say it.
template <typename W>
void writeTints(W& w, const Polytope& polytope, const scene::Presences& presences,
                std::span<const std::uint32_t> faceOf) {
    const auto cells = static_cast<std::uint32_t>(polytope.cellCount());
    if (std::all_of(faceOf.begin(), faceOf.end(), [cells](std::uint32_t of) { return of < cells; })) return;
    std::vector<std::uint32_t> tints(faceOf.begin(), faceOf.end());
    for (std::uint32_t& tint : tints) tint = scene::tintOf(polytope, presences, tint);
    w.key("tints");
    w.numbers(tints);
}

// How much is seen of each element, where not all of everything is.
template <typename W>
void writePresences(W& w, const scene::Presences& presences, const SliceSet& slices, std::size_t i) {
    if (presences.all()) return;
    const auto write = [&](std::string_view name, std::span<const std::uint32_t> of,
                           const std::vector<scene::Presence>& by) {
        std::vector<std::uint32_t> list;
        for (const std::uint32_t element : of) list.push_back(static_cast<std::uint32_t>(by[element]));
        w.key(name);
        w.numbers(list);
    };
    w.key("seen");
    w.beginObject();
    write("vertices", part(slices.vertexOf, slices.vertexBegin[i], slices.vertexBegin[i + 1]), presences.vertices);
    write("edges", part(slices.edgeOf, slices.edgeBegin[i], slices.edgeBegin[i + 1]), presences.edges);
    write("faces", part(slices.faceOf, slices.faceBegin[i], slices.faceBegin[i + 1]), presences.faces);
    w.endObject();
}

// What to draw instead of the faces of a slice that need not be convex.
struct Fill {
    std::vector<glm::dvec3> points;
    std::vector<Triple> triangles;
    std::vector<std::uint32_t> tints, seen;
};

template <typename W>
void writeFill(W& w, const Polytope& polytope, const Scene& scene, std::size_t i) {
    const geometry::Fill& from = scene.fill;
    if (from.empty() || from.patchBegin[i] == from.patchBegin[i + 1]) return;
    Fill fill;
    for (std::uint32_t p = from.patchBegin[i]; p < from.patchBegin[i + 1]; ++p) {
        const std::uint32_t of = from.patches[p].of;
        const scene::Presence presence = scene.presences.face(of);
        if (presence == scene::Presence::hidden) continue;
        const std::uint32_t tint = scene::tintOf(polytope, scene.presences, of);
        for (std::uint32_t k = from.pieceBegin[p]; k < from.pieceBegin[p + 1]; ++k) {
            const auto first = static_cast<std::uint32_t>(fill.points.size());
            const auto corners = part(from.corners, from.cornerBegin[k], from.cornerBegin[k + 1]);
            fill.points.insert(fill.points.end(), corners.begin(), corners.end());
            for (std::uint32_t c = 2; c < corners.size(); ++c) {
                fill.triangles.push_back({first, first + c - 1, first + c});
                fill.tints.push_back(tint);
                fill.seen.push_back(static_cast<std::uint32_t>(presence));
            }
        }
    }
    w.key("fill");
    w.beginObject();
    w.key("points");
    w.vectors(std::span<const glm::dvec3>(fill.points));
    w.key("triangles");
    w.triples(fill.triangles);
    w.key("tints");
    w.numbers(fill.tints);
    if (!scene.presences.all()) {
        w.key("seen");
        w.numbers(fill.seen);
    }
    w.endObject();
}

template <typename W>
void writeStand(W&& w, const scene::Stand& stand) {
    w.member("index", stand.index);
    w.member("w", stand.w);
    writeVector(w, "position", stand.position);
    w.member("label", std::string_view(stand.label));
    writeVector(w, "label_at", stand.labelAt);
    w.member("label_size", stand.labelSize);
    w.member("focus", stand.focus);
    w.member("drawn", stand.drawn);
}

template <typename W>
void writeSlice(W& w, std::string_view stand, const Polytope& polytope, const SliceSet& slices, std::size_t i,
                const Scene& scene) {
    const std::uint32_t v0 = slices.vertexBegin[i], v1 = slices.vertexBegin[i + 1];
    const std::uint32_t e0 = slices.edgeBegin[i], e1 = slices.edgeBegin[i + 1];
    const std::uint32_t f0 = slices.faceBegin[i], f1 = slices.faceBegin[i + 1];
    w.beginObject();
    w.written(stand);
    w.key("vertices");
    w.vectors(part(slices.vertices, v0, v1));
    w.key("edges");
    w.pairs(part(slices.edges, e0, e1));
    w.key("faces");
    w.lists(
        {part(slices.cornerBegin, f0, f1 + 1), part(slices.corners, slices.cornerBegin[f0], slices.cornerBegin[f1])});
    w.key("of");
    w.beginObject();
    w.key("vertices");
    w.numbers(part(slices.vertexOf, v0, v1));
    w.key("edges");
    w.numbers(part(slices.edgeOf, e0, e1));
    w.key("faces");
    w.numbers(part(slices.faceOf, f0, f1));
    w.endObject();
    writeTints(w, polytope, scene.presences, part(slices.faceOf, f0, f1));
    writePresences(w, scene.presences, slices, i);
    writeFill(w, polytope, scene, i);
    w.endObject();
}

}  // namespace

template <typename W>
void SlicesWriter::writeMessage(W&& w, Texts& texts, const Polytope& polytope, const SliceSet& slices,
                                const Scene& scene, std::uint64_t revision, std::optional<double> id) {
    w.beginObject();
    w.member("type", "slices");
    if (id) w.member("id", *id);
    w.member("revision", revision);
    w.key("scene");
    w.beginObject();
    const Setting setting{scene.look.view,   scene.look.parts,   scene.viewport,   scene.camera,
                          scene.scale,       scene.circumradius, scene.ballRadius, scene.barRadius,
                          scene.faceOpacity, scene.axes,         scene.coordinates};
    w.written(texts.setting.of(setting, [&](std::string& out) { writeSetting(W(out), setting); }));
    writeColours(w, scene::style(), scene.cellColours);
    w.endObject();
    if (scene.look.parts.coordinates) {
        w.key("coordinates");
        w.vectors(std::span<const glm::dvec4>(slices.turned));
        if (scene.coordinates.density) {
            w.key("density");
            w.picture(scene.density.tones(), scene::Density::kColumns);
        }
    }
    w.key("slices");
    w.beginArray();
    texts.stands.resize(scene.stands.size());
    for (std::size_t i = 0; i < scene.stands.size(); ++i) {
        const scene::Stand& stand = scene.stands[i];
        const auto text = texts.stands[i].of(stand, [&](std::string& out) { writeStand(W(out), stand); });
        writeSlice(w, text, polytope, slices, i, scene);
    }
    w.endArray();
    w.endObject();
}

void SlicesWriter::write(const Polytope& polytope, const SliceSet& slices, const Scene& scene, std::uint64_t revision,
                         std::optional<double> id, Encoding encoding, std::string& out) {
    if (encoding == Encoding::cbor) {
        writeMessage(CborWriter(out), cbor_, polytope, slices, scene, revision, id);
    } else {
        writeMessage(JsonWriter(out), json_, polytope, slices, scene, revision, id);
    }
}

}  // namespace oval4d::protocol
