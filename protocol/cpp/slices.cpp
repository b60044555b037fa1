#include "protocol/cpp/slices.hpp"

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

}  // namespace

template <typename W>
void SlicesWriter::writeMessage(W&& w, Kept<Setting>& kept, const Polytope& polytope, const SliceSet& slices,
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
    w.written(kept.of(setting, [&](std::string& out) { writeSetting(W(out), setting); }));
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
    writeSlices(w, polytope, slices, scene);
    w.endObject();
}

void SlicesWriter::write(const Polytope& polytope, const SliceSet& slices, const Scene& scene, std::uint64_t revision,
                         std::optional<double> id, Encoding encoding, std::string& out) {
    if (encoding == Encoding::cbor) {
        writeMessage(CborWriter(out), cborSetting_, polytope, slices, scene, revision, id);
    } else {
        writeMessage(JsonWriter(out), jsonSetting_, polytope, slices, scene, revision, id);
    }
}

}  // namespace oval4d::protocol
